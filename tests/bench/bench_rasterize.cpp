// Particles per second from a particle set to grids, against OpenVDB's own point rasteriser with
// the same kernel and thread count in the same run.
//   ninja -C build/release bench_rasterize && build/release/tests/bench/bench_rasterize
#include <map>

#include <benchmark/benchmark.h>

#include "bench_rasterize.h"
#include "core/parallel.h"
#include "core/rng.h"
#include "particles/rasterize.h"

namespace mote::bench {
namespace {

float lattice_value(int x, int y, int z)
{
    const auto u = [](int v) { return static_cast<uint32_t>(v); };
    return to_unit_float(hash_combine(hash_combine(hash32(u(x)), u(y)), u(z)));
}

/// Value noise in [0,1].
float noise(Vec3 p)
{
    const Vec3 cell = glm::floor(p);
    const Vec3 f = p - cell;
    const Vec3 u = f * f * (3.0f - 2.0f * f);
    float sum = 0.0f;
    for (int k = 0; k < 8; ++k) {
        const int x = k & 1;
        const int y = k >> 1 & 1;
        const int z = k >> 2;
        const float weight =
            (x ? u.x : 1.0f - u.x) * (y ? u.y : 1.0f - u.y) * (z ? u.z : 1.0f - u.z);
        sum += weight * lattice_value(static_cast<int>(cell.x) + x, static_cast<int>(cell.y) + y,
                                      static_cast<int>(cell.z) + z);
    }
    return sum;
}

/// Density of a turbulent plume in the unit cube, [0,1]; about a fifth of it is not empty.
float plume_density(Vec3 p)
{
    float turbulence = 0.0f;
    float amplitude = 0.5f;
    Vec3 q = p * 6.0f;
    for (int octave = 0; octave < 5; ++octave) {
        turbulence += amplitude * noise(q);
        amplitude *= 0.5f;
        q = q * 2.03f + Vec3(17.3f);
    }
    const float width = 0.12f + 0.38f * p.y;
    const float axis = std::hypot(p.x - 0.5f, p.z - 0.5f) / width;
    return std::clamp(2.2f * (turbulence - 0.22f - 0.42f * axis * axis), 0.0f, 1.0f);
}

/// `count` points of the plume in [4, size - 4)^3, in random order.
const std::vector<Vec3>& plume_points(size_t count, int size)
{
    static std::map<size_t, std::vector<Vec3>> cache;
    std::vector<Vec3>& points = cache[count];
    Rng rng(3, 0, Stream::Test, 0, 0);
    while (points.size() < count) {
        const Vec3 p = rng.uniform3();
        if (rng.uniform() < plume_density(p)) {
            points.push_back(Vec3(4.0f) + p * static_cast<float>(size - 8));
        }
    }
    return points;
}

int edge_of(size_t count)
{
    return count > 2'000'000 ? 512 : 256;
}

double total(const openvdb::FloatGrid& grid)
{
    double sum = 0.0;
    for (auto v = grid.cbeginValueOn(); v; ++v) sum += static_cast<double>(*v);
    return sum;
}

/// Runs make() per iteration and reports what it built: active voxels, and the mass per particle,
/// which shows that both sides do the same work.
template <class F>
void run(benchmark::State& state, F&& make)
{
    openvdb::FloatGrid::Ptr grid;
    run_with_threads(static_cast<int>(state.range(2)), [&] {
        for (auto _ : state) {
            grid.reset();
            grid = make();
        }
    });
    state.counters["active_M"] = static_cast<double>(grid->activeVoxelCount()) * 1e-6;
    state.counters["mass"] = total(*grid) / static_cast<double>(state.range(0));
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

/// Arguments: particles, radius [1/10 voxel], threads.
void mote_density(benchmark::State& state)
{
    const size_t count = static_cast<size_t>(state.range(0));
    ParticleSet particles;
    particles.position = plume_points(count, edge_of(count));
    particles.radius.assign(count, static_cast<float>(state.range(1)) / 10.0f);
    particles.mass.assign(count, 1.0f);
    RasterizeParams params;
    params.voxel_size = 1.0f;
    run(state, [&] { return rasterize(particles, params).density; });
}

void openvdb_points(benchmark::State& state)
{
    const size_t count = static_cast<size_t>(state.range(0));
    const std::vector<Vec3>& points = plume_points(count, edge_of(count));
    const float radius = static_cast<float>(state.range(1)) / 10.0f;
    run(state, [&] { return rasterize_with_openvdb(points, radius); });
}

void all_cases(benchmark::internal::Benchmark* b)
{
    for (const int64_t count : {1'000'000, 10'000'000}) {
        for (const int64_t radius : {10, 15, 30}) {
            for (const int64_t threads : {1, 2}) b->Args({count, radius, threads});
        }
    }
    b->ArgNames({"particles", "radius_tenths", "threads"});
    // Rates are per second of CPU time of all threads, so per thread: they stay meaningful on a
    // busy machine. The Time column is wall time.
    b->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
}

BENCHMARK(mote_density)->Apply(all_cases);
BENCHMARK(openvdb_points)->Apply(all_cases);

}  // namespace
}  // namespace mote::bench

BENCHMARK_MAIN();
