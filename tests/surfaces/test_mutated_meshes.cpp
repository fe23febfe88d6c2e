#include <sys/resource.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/sanitizers.h"
#include "support/damage.h"
#include "support/png_bytes.h"
#include "support/temporary_folder.h"
#include "surfaces/gltf/gltf_scene.h"
#include "surfaces/gltf_text.h"
#include "surfaces/load_mesh.h"
#include "surfaces/meshes.h"

// Damaged files end in a mesh that is safe to render or in one Error that names the file; nothing
// crashes, hangs or asks for memory out of proportion to the file.
namespace mote {
namespace {

long peak_kilobytes()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

void expect_safe(const Mesh& mesh)
{
    for (const glm::uvec3& t : mesh.triangles) {
        for (int c = 0; c < 3; ++c) {
            ASSERT_LT(t[c], mesh.positions.size());
            ASSERT_TRUE(is_finite(mesh.positions[t[c]]));
        }
    }
    ASSERT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
    ASSERT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
    for (const Vec2& uv : mesh.uvs) ASSERT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y));
}

/// The meshes of a file, safe to render.
std::vector<Mesh> read_any(const std::string& path)
{
    std::vector<Mesh> meshes;
    if (path.ends_with(".gltf") || path.ends_with(".glb")) {
        GltfScene scene = load_gltf(path);
        for (GltfPart& part : scene.parts) meshes.push_back(std::move(part.mesh));
        for (size_t i = 0; i < scene.nodes.size(); ++i) {
            (void)world_from_node(scene, static_cast<int>(i), 1.5);
        }
    } else {
        meshes.push_back(path.ends_with("obj") ? read_obj(path) : read_ply_mesh(path));
        (void)finish_mesh(meshes.back(), path);
    }
    return meshes;
}

/// 500 damages of one file, 5000 in the long form.
void read_damaged(const char* name, const std::string& whole)
{
    const long before = peak_kilobytes();
    const uint32_t trials = std::getenv("MOTE_LONG_TESTS") ? 5000 : 500;
    const TemporaryFolder folder;
    uint32_t refused = 0;
    for (uint32_t trial = 0; trial < trials; ++trial) {
        const std::string path = folder.write(name, test::damage(whole, trial));
        try {
            for (const Mesh& mesh : read_any(path)) expect_safe(mesh);
        } catch (const Error& e) {
            ++refused;
            EXPECT_TRUE(std::string_view(e.what()).starts_with(path)) << e.what();
            EXPECT_EQ(std::string_view(e.what()).find('\n'), std::string::npos);
        }
    }
    EXPECT_GT(refused, trials / 10) << name;
    // The address sanitizer holds 256 MiB of freed memory back.
    const long held_back = is_instrumented ? 256 * 1024 : 0;
    EXPECT_LT(peak_kilobytes() - before, 100'000 + held_back);
}

const Mesh flat = test::box_mesh(Vec3(-1.0f), Vec3(1.0f), false, 3);
const Mesh smooth = test::sphere_mesh(1.0f, 6);

TEST(MutatedMeshes, Obj)
{
    read_damaged("f.obj", test::obj_text(flat));
}

TEST(MutatedMeshes, ObjWithNormals)
{
    read_damaged("s.obj", test::obj_text(smooth));
}

TEST(MutatedMeshes, AsciiPly)
{
    read_damaged("a.ply", test::ply_bytes(flat, false));
}

TEST(MutatedMeshes, BinaryPly)
{
    read_damaged("b.ply", test::ply_bytes(smooth, true));
}

/// A file with something of everything that is read.
test::GltfText rich_gltf()
{
    test::GltfText text;
    text.add_mesh(smooth, 0);
    text.add_mesh(test::quad_mesh(Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f), Vec3(0.0f, 1.0f, 0.0f)), 0);
    text.json["nodes"] = {{{"mesh", 0}, {"children", {1, 2}}},
                          {{"mesh", 1}, {"translation", {1, 2, 3}}},
                          {{"camera", 0}}};
    text.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    text.json["scenes"] = {{{"nodes", {0}}}};
    text.json["images"] = {
        {{"uri", "data:image/png;base64," + test::base64(test::text_of(test::rgba_png))}}};
    text.json["textures"] = {{{"source", 0}}};
    text.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
         {"alphaMode", "MASK"},
         {"emissiveFactor", {1, 1, 0}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}}};
    const int times = text.add_floats({1, 2}, "SCALAR", 1);
    const int moves = text.add_floats({0, 0, 0, 2, 0, 0}, "VEC3", 3);
    text.json["animations"] = {
        {{"samplers", {{{"input", times}, {"output", moves}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    return text;
}

TEST(MutatedMeshes, ObjWithTextureCoordinates)
{
    read_damaged("t.obj", test::obj_text(test::quad_mesh(Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f),
                                                         Vec3(0.0f, 1.0f, 0.0f))));
}

TEST(MutatedMeshes, Gltf)
{
    read_damaged("a.gltf", rich_gltf().gltf());
}

TEST(MutatedMeshes, Glb)
{
    read_damaged("a.glb", rich_gltf().glb());
}

}  // namespace
}  // namespace mote
