#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "surfaces/load_mesh.h"
#include "surfaces/meshes.h"
#include "surfaces/triangulate.h"

namespace mote {
namespace {

Mesh load(const std::string& name, const std::string& bytes)
{
    const TemporaryFolder folder;
    return load_mesh(folder.write(name, bytes));
}

/// Total area; tells shape and order of corners.
Vec3 area_of(const Mesh& mesh)
{
    Vec3 sum(0.0f);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) sum += glm::abs(area_normal(mesh, i));
    return 0.5f * sum;
}

TEST(LoadMesh, EveryFormatReadsWhatWasWritten)
{
    const Mesh box = test::box_mesh(Vec3(-1.0f, 0.0f, 0.5f), Vec3(1.0f, 3.0f, 1.0f));
    const std::pair<const char*, std::string> files[] = {
        {"a.obj", test::obj_text(box)},
        {"a.PLY", test::ply_bytes(box, false)},
        {"b.ply", test::ply_bytes(box, true)},
    };
    for (const auto& [name, bytes] : files) {
        const Mesh mesh = load(name, bytes);
        EXPECT_EQ(mesh.triangles.size(), 12u) << name;
        EXPECT_EQ(mesh.bounds.lo, Vec3(-1.0f, 0.0f, 0.5f)) << name;
        EXPECT_EQ(mesh.bounds.hi, Vec3(1.0f, 3.0f, 1.0f)) << name;
        EXPECT_EQ(area_of(mesh), Vec3(3.0f, 2.0f, 12.0f)) << name;
        EXPECT_TRUE(mesh.normals.empty()) << name;
        for (size_t i = 0; i < 12; ++i) {
            EXPECT_EQ(area_normal(mesh, i), area_normal(box, i)) << name;
        }
    }
}

TEST(LoadMesh, ObjPolygonsNegativeIndicesAndNormals)
{
    const Mesh mesh = load("a.obj",
                           "mtllib no.mtl\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvt 0 0\n"
                           "vn 0 0 2\nusemtl red\nf -4/1/-1 -3/1/1 3/1/1 4/1/1\n");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(area_of(mesh), Vec3(0.0f, 0.0f, 2.0f));
    ASSERT_EQ(mesh.normals.size(), 4u);
    EXPECT_EQ(mesh.normals[0], Vec3(0.0f, 0.0f, 1.0f));
}

TEST(LoadMesh, BigEndianPlyWithOtherElementsAndProperties)
{
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement face 1\nproperty list uchar uchar "
        "vertex_index\nproperty uchar flags\nelement vertex 3\nproperty double x\nproperty uchar "
        "red\nproperty double y\nproperty double z\nend_header\n";
    bytes += std::string("\x03\x00\x01\x02\x07", 5);
    const auto number = [&](bool is_one) {
        bytes += std::string(is_one ? "\x3f\xf0" : "\0\0", 2) + std::string(6, '\0');
    };
    for (int vertex = 0; vertex < 3; ++vertex) {
        number(vertex == 1);
        bytes += 'r';
        number(vertex == 2);
        number(false);
    }
    const Mesh mesh = load("a.ply", bytes);
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(area_normal(mesh, 0), Vec3(0.0f, 0.0f, 1.0f));
}

TEST(LoadMesh, TextureCoordinatesOfBothFormats)
{
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const Mesh obj =
        load("a.obj", corners + "vt 0.25 0.5\nvt 2 -1 7\nf 1/1 2/2 3/1\nf 1/2 2/2 3\n");
    ASSERT_EQ(obj.uvs.size(), obj.positions.size());
    EXPECT_EQ(uv_at(obj, 0, 0.0f, 0.0f), Vec2(0.25f, 0.5f));
    EXPECT_EQ(uv_at(obj, 0, 1.0f, 0.0f), Vec2(2.0f, -1.0f));
    EXPECT_EQ(uv_at(obj, 1, 0.0f, 0.0f), Vec2(2.0f, -1.0f));  // a seam: another vertex
    EXPECT_EQ(uv_at(obj, 1, 0.0f, 1.0f), Vec2(0.0f));
    for (const char* names : {"s t", "u v", "texture_u texture_v"}) {
        const std::string text = names;
        const size_t gap = text.find(' ');
        const Mesh ply = load(
            "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float " +
                text.substr(0, gap) + "\nproperty float z\nproperty float " + text.substr(gap + 1) +
                "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                "0 0 0.5 0 0.25\n1 0 nan 0 1\n0 1 -3 0 2\n3 0 1 2\n");
        ASSERT_EQ(ply.uvs.size(), 3u) << names;
        EXPECT_EQ(ply.uvs[0], Vec2(0.5f, 0.25f));
        EXPECT_EQ(ply.uvs[1], Vec2(0.0f)) << "not finite";
        EXPECT_EQ(ply.uvs[2], Vec2(-3.0f, 2.0f));
        EXPECT_EQ(ply.positions[2], Vec3(0.0f, 1.0f, 0.0f));
    }
}

TEST(LoadMesh, TrianglesThatCannotBeDrawnAreLeftOut)
{
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1e999 0 0\nv 2 0 0\nvn 0 0 0\n";
    const Mesh mesh = load("a.obj", vertices + "f 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 1 2\nf 1 2\n");
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.bounds.hi, Vec3(1.0f, 1.0f, 0.0f));

    Mesh counted;
    counted.positions = {Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f), Vec3(0.0f, 1.0f, 0.0f),
                         Vec3(std::nanf(""), 0.0f, 0.0f)};
    counted.normals = {Vec3(0.0f), Vec3(3.0f, 0.0f, 0.0f), Vec3(infinity), Vec3(0.0f, 1.0f, 0.0f)};
    counted.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 1, 2}};
    const MeshRepairs repairs = finish_mesh(counted, "here");
    EXPECT_EQ(repairs.non_finite, 1u);
    EXPECT_EQ(repairs.degenerate, 1u);
    EXPECT_EQ(repairs.bad_normals, 1u);
    EXPECT_EQ(counted.normals[1], Vec3(1.0f, 0.0f, 0.0f));
}

/// All triangles run counterclockwise, seen from +z, and together have the polygon's area: they are
/// its inside, each point once.
void expect_inside(const Mesh& mesh, const std::vector<Vec2>& polygon, const char* what)
{
    double area = 0.0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 a(polygon[i]);
        const glm::dvec2 b(polygon[(i + 1) % polygon.size()]);
        area += 0.5 * (a.x * b.y - a.y * b.x);
    }
    double sum = 0.0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const float twice = area_normal(mesh, i).z;
        EXPECT_GE(twice, 0.0f) << what;
        sum += 0.5 * static_cast<double>(twice);
    }
    EXPECT_NEAR(sum, area, 1e-5 * area) << what;  // float vertices, some 100 triangles
    EXPECT_EQ(mesh.triangles.size(), polygon.size() - 2) << what;
}

TEST(LoadMesh, PolygonsThatAreNotConvexKeepTheirShape)
{
    const std::vector<Vec2> arrow = {{0, 0}, {4, 0}, {1, 1}, {0, 4}};
    const std::vector<Vec2> comb = {{0, 0}, {7, 0}, {7, 3}, {6, 1}, {5, 3},
                                    {4, 1}, {3, 3}, {2, 1}, {1, 3}, {0, 1}};
    // A square with a square hole, along an edge that runs there and back.
    const std::vector<Vec2> hole = {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0},
                                    {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}};
    std::vector<Vec2> spiral;
    for (const float inset : {0.0f, 0.4f}) {
        for (int i = 0; i <= 60; ++i) {
            const float turn = 0.3f * static_cast<float>(inset > 0.0f ? 60 - i : i);
            spiral.push_back((1.0f + turn - inset) * Vec2(std::cos(turn), std::sin(turn)));
        }
    }
    for (auto polygon : {arrow, comb, hole, spiral}) {
        for (size_t first = 0; first < polygon.size(); ++first) {
            std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
            Mesh mesh;
            std::vector<uint32_t> corners;
            for (const Vec2& p : polygon) {
                corners.push_back(static_cast<uint32_t>(mesh.positions.size()));
                mesh.positions.emplace_back(p, 0.5f * p.x);  // slanted
            }
            add_face(mesh, corners, "here");
            expect_inside(mesh, polygon, "turned");
        }
    }
    const Mesh obj = load("a.obj", "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nf 1 2 3 4\n");
    expect_inside(obj, arrow, "OBJ");
    const Mesh back = load("a.obj", "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nf 4 3 2 1\n");
    EXPECT_EQ(area_of(back), area_of(obj));
    EXPECT_LT(area_normal(back, 0).z, 0.0f);
    const Mesh ply = load("a.ply",
                          "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int "
                          "vertex_indices\nelement vertex 4\nproperty float x\nproperty float y\n"
                          "property float z\nend_header\n4 0 1 2 3\n0 0 0\n4 0 0\n1 1 0\n0 4 0\n");
    expect_inside(ply, arrow, "PLY, faces first");
}

/// The fan of former versions stays for what it is right for; larger shapes have a limit.
TEST(LoadMesh, ConvexPolygonsAreFansAndConcaveOnesHaveALimit)
{
    Mesh disk;
    std::vector<uint32_t> corners;
    const uint32_t count = static_cast<uint32_t>(max_concave_corners) + 2;
    for (uint32_t i = 0; i < count; ++i) {
        const double angle = 2.0 * 3.14159265358979 * i / count;
        disk.positions.emplace_back(1e6 * std::cos(angle), 1e6 * std::sin(angle), 0.0);
        corners.push_back(i);
    }
    disk.positions.back() = Vec3(0.0f);
    const std::vector<uint32_t> few = {0, 1000, 3000, 6000};
    add_face(disk, few, "here");
    ASSERT_EQ(disk.triangles.size(), 2u);
    EXPECT_EQ(disk.triangles[0], glm::uvec3(0u, 1000u, 3000u));
    EXPECT_EQ(disk.triangles[1], glm::uvec3(0u, 3000u, 6000u));
    expect_error([&] { add_face(disk, corners, "here"); }, ExitCode::Input,
                 {"here: a face of 10002 corners is not convex", "triangulate it"});
}

/// What OBJ's common readers take for 0.
TEST(LoadMesh, TextThatIsNoFiniteNumberIsNotZero)
{
    const Mesh mesh = load("a.obj",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 0 0 -inf\nvn nan nan nan\n"
                           "vn 0 0 3\nvt inf 0.5\nf 1/1/1 2/1/2 3/1/2\nf 1 2 4\nf 1 2 5\n");
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.normals[0], Vec3(0.0f)) << "flat";
    EXPECT_EQ(mesh.normals[1], Vec3(0.0f, 0.0f, 1.0f));
    EXPECT_EQ(mesh.uvs[0], Vec2(0.0f));
    const TemporaryFolder folder;
    const Mesh raw = read_obj(folder.write("a.obj",
                                           "v nan 0 0\nv 1 0 0\nv 0 1 0\nvn 0 nan 1\n"
                                           "f 1//1 2//1 3//1\n"));
    EXPECT_TRUE(std::isnan(raw.positions[0].x));
    EXPECT_TRUE(std::isnan(raw.normals[0].y));
}

/// Longer than wide beyond what rays that leave it can be traced for.
TEST(LoadMesh, TrianglesTooThinForRaysAreLeftOut)
{
    Mesh mesh;
    mesh.positions = {Vec3(0.0f), Vec3(1e7f, 0.0f, 0.0f), Vec3(5e6f, 1e-15f, 0.0f),
                      Vec3(5e6f, 1e-3f, 0.0f)};
    mesh.triangles.emplace_back(0u, 1u, 2u);
    mesh.triangles.emplace_back(0u, 1u, 3u);
    EXPECT_EQ(finish_mesh(mesh, "here").degenerate, 1u);
}

TEST(LoadMesh, ErrorsNameFilePlaceAndReason)
{
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const struct {
        const char* name;
        std::string bytes;
        const char* message;
    } cases[] = {
        {"a.obj", corners + "f 1 2 4\n", "a.obj:4:1: the face names vertex 4, but there are 3"},
        {"a.obj", corners + "f 1 2 0\n", "a.obj:4:1: the face names vertex 0"},
        {"a.obj", corners + "f 1 2 -4\n", "a.obj:4:1: the face names vertex -4"},
        {"a.obj", corners + "f 1//1 2//1 3//1\n", "a.obj:4:1: the face names normal 1"},
        {"a.obj", "v 0 0 0\nv 1 x 0\n", "a.obj:2:5: \"x\" is not a number"},
        {"a.obj", corners + "vt 0 0\nf 1/2 2/1 3/1\n",
         "a.obj:5:1: the face names texture point 2, but there are 1"},
        {"a.obj", "vt 0\n", "a.obj:1:5: two numbers are needed"},
        {"a.obj", "v 0 0\n", "a.obj:1:6: three numbers are needed"},
        {"a.obj", corners + "f 1 1 2\n", "holds no triangle that can be drawn"},
        {"a.obj", corners + "v 0 -1e13 2\nf 1 2 4\n",
         "a.obj: vertex (0, -1e+13, 2) lies beyond 1e+09 m"},
        {"a.obj", "", "holds no triangle"},
        {"a.fbx", "", "export it as .obj, .ply, .gltf or .glb"},
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
         "needs the properties x, y and z"},
        {"a.ply",
         "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
         "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 "
         "0 1\n",
         "triangle 0 uses vertex 1, but there are only 1"},
        {"a.ply",
         "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int "
         "vertex_indices\nend_header\n3 0 -1 1\n",
         "a face names vertex -1"},
        {"a.ply",
         "ply\nformat ascii 1.0\nelement face 2\nproperty list uchar int "
         "vertex_indices\nend_header\n3 0 0 0\n",
         "truncated: it ends after 1 of 2 rows"},
    };
    for (const auto& c : cases) {
        const std::string message = error_message([&] { (void)load(c.name, c.bytes); });
        EXPECT_NE(message.find(c.message), std::string::npos) << message;
    }
    EXPECT_NE(error_message([] { (void)load_mesh("/nowhere/a.obj"); }).find("/nowhere/a.obj: No"),
              std::string::npos);
}

}  // namespace
}  // namespace mote
