#include <sys/resource.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/rng.h"
#include "core/sampling.h"
#include "core/sanitizers.h"
#include "support/damage.h"
#include "support/png_bytes.h"
#include "support/temporary_folder.h"
#include "surfaces/gltf/gltf_scene.h"
#include "surfaces/gltf_text.h"
#include "surfaces/load_mesh.h"
#include "surfaces/meshes.h"
#include "surfaces/one_mesh.h"

// Damaged files end in a mesh that is safe to render or in one Error that names the file; nothing
// crashes, hangs or asks for memory out of proportion to the file. Rays are traced through what
// is left.
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

/// Rays from around the mesh to its triangles, and on from where they meet it: Embree asserts that
/// what it is asked is a ray.
void trace_rays(Mesh mesh, uint32_t trial)
{
    if (mesh.triangles.empty()) return;
    const Surfaces surfaces = test::make_surfaces(std::move(mesh), Trs{});
    const Mesh& traced = surfaces.mesh(0);
    const Vec3 centre = 0.5f * traced.bounds.lo + 0.5f * traced.bounds.hi;
    const float radius = glm::length(traced.bounds.hi - traced.bounds.lo);
    Rng rng(trial, 0, Stream::Test, 0, 0);
    for (int i = 0; i < 16; ++i) {
        const auto count = static_cast<float>(traced.triangles.size());
        const auto index = static_cast<size_t>(rng.uniform() * count);
        const glm::uvec3 t = traced.triangles[std::min(index, traced.triangles.size() - 1)];
        const Vec3 aim =
            (traced.positions[t.x] + traced.positions[t.y] + traced.positions[t.z]) / 3.0f;
        const Vec3 from = centre + radius * sample_sphere(rng.uniform2());
        if (!(glm::length(aim - from) > 0.0f)) continue;
        const Ray ray{from, glm::normalize(aim - from), 0.0f};
        const auto hit = intersect(surfaces, ray, {0.0f, infinity});
        if (!hit) continue;
        const SurfaceVertex vertex = make_vertex(surfaces, *hit, 0.0f);
        ASSERT_TRUE(is_finite(vertex.p));
        ASSERT_NEAR(glm::length(vertex.ns), 1.0f, 1e-4f);
        const Vec3 d = sample_sphere(rng.uniform2());
        (void)is_occluded(surfaces, {ray_origin(vertex, d), d, 0.0f}, {0.0f, infinity});
    }
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
            for (Mesh& mesh : read_any(path)) {
                expect_safe(mesh);
                trace_rays(std::move(mesh), trial);
            }
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
