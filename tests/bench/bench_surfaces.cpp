#include <benchmark/benchmark.h>

#include "core/rng.h"
#include "core/sampling.h"
#include "support/temporary_folder.h"
#include "surfaces/gltf/gltf_scene.h"
#include "surfaces/gltf_text.h"
#include "surfaces/load_mesh.h"
#include "surfaces/meshes.h"
#include "surfaces/surfaces.h"

// Texture look-ups, hits with and without textures and cut-outs, and reading glTF, on one thread.
namespace mote {
namespace {

std::shared_ptr<const Texture> noise_texture(int size, bool is_float)
{
    Rng rng(1, 0, Stream::Test, 0, 0);
    const size_t count = 4 * static_cast<size_t>(size) * static_cast<size_t>(size);
    if (is_float) {
        std::vector<float> values(count);
        for (float& value : values) value = rng.uniform();
        return std::make_shared<const Texture>(size, size, std::move(values));
    }
    std::vector<uint8_t> values(count);
    for (uint8_t& value : values) value = static_cast<uint8_t>(rng.next());
    return std::make_shared<const Texture>(size, size, std::move(values), true);
}

/// At random places: the worst for the cache. Arguments: size, whether floats.
void look_up(benchmark::State& state)
{
    const auto texture = noise_texture(static_cast<int>(state.range(0)), state.range(1) != 0);
    Rng rng(2, 0, Stream::Test, 0, 0);
    for (auto _ : state) benchmark::DoNotOptimize(texture->at(rng.uniform2()));
}
BENCHMARK(look_up)->Args({64, 0})->Args({64, 1})->Args({4096, 0})->Args({4096, 1});

enum class Look { Plain, Textured, Cut };

/// Rays from the middle of a ball of 20,000 triangles with coordinates, and all of the hits.
void hit_and_make_vertex(benchmark::State& state)
{
    const auto look = static_cast<Look>(state.range(0));
    Mesh ball = test::sphere_mesh(1.0f, 71);
    for (const Vec3& p : ball.positions) ball.uvs.emplace_back(4.0f * p.x, 4.0f * p.y);
    Surfaces surfaces;
    surfaces.objects = {{"ball", 0}};
    surfaces.materials = {Material{}};
    MaterialTextures textures;
    if (look != Look::Plain) {
        textures.color = noise_texture(512, false);
        textures.roughness = textures.metallic = textures.normal = noise_texture(512, false);
    }
    if (look == Look::Cut) textures.alpha_cutoff = 0.1f;
    set_textures(surfaces, {textures});
    MeshInstance instance{std::make_shared<const MeshBvh>(std::move(ball)), {}};
    surfaces.bvh = std::make_shared<const InstanceBvh>(std::vector<MeshInstance>{instance});
    Rng rng(3, 0, Stream::Test, 0, 0);
    for (auto _ : state) {
        const Ray ray{Vec3(0.0f), sample_sphere(rng.uniform2()), 0.0f};
        const auto hit = intersect(surfaces, ray, {0.0f, infinity});
        if (hit) benchmark::DoNotOptimize(make_vertex(surfaces, *hit, 0.0f));
    }
    static const char* const names[] = {"plain", "colour, roughness, normal map", "and cut out"};
    state.SetLabel(names[state.range(0)]);
}
BENCHMARK(hit_and_make_vertex)->DenseRange(0, 2);

/// A GLB of about 1 million triangles in 100 meshes; OBJ text of one of them for comparison.
void read_gltf(benchmark::State& state)
{
    test::GltfText text;
    const Mesh ball = test::sphere_mesh(1.0f, 50);
    for (int i = 0; i < 100; ++i) {
        text.json["nodes"].push_back({{"mesh", text.add_mesh(ball)}});
    }
    const bool is_binary = state.range(0) != 0;
    const TemporaryFolder folder;
    const std::string path =
        is_binary ? folder.write("a.glb", text.glb()) : folder.write("a.gltf", text.gltf());
    for (auto _ : state) benchmark::DoNotOptimize(load_gltf(path).parts.size());
    state.SetItemsProcessed(state.iterations() * 100 * static_cast<int64_t>(ball.triangles.size()));
}
BENCHMARK(read_gltf)->Arg(1)->Arg(0)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void read_small_gltf(benchmark::State& state)
{
    const std::string path = std::string(MOTE_SOURCE_DIR) + "/scenes/meshes/garden.gltf";
    for (auto _ : state) benchmark::DoNotOptimize(load_gltf(path).parts.size());
}
BENCHMARK(read_small_gltf)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote

BENCHMARK_MAIN();
