#include <filesystem>
#include <fstream>

#include <benchmark/benchmark.h>

#include "core/parallel.h"
#include "particles/cache.h"
#include "particles/emitter.h"
#include "particles/write_points.h"

// Particles per second of the built-in emitters and of reading caches, on one thread.
namespace mote {
namespace {

EmitterParams emitter(EmitterKind kind)
{
    EmitterParams params;
    params.kind = kind;
    params.count = 1'000'000;
    return params;
}

void emit(benchmark::State& state)
{
    const EmitterParams params = emitter(static_cast<EmitterKind>(state.range(0)));
    int64_t particles = 0;
    run_with_threads(1, [&] {
        for (auto _ : state) {
            const ParticleSet set = emit_particles(params, 3.9);
            benchmark::DoNotOptimize(set.position.data());
            particles += static_cast<int64_t>(set.size());
        }
    });
    state.SetItemsProcessed(particles);
    static const char* const names[] = {"plume", "burst", "disk", "snow"};
    state.SetLabel(names[state.range(0)]);
}
BENCHMARK(emit)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

/// The plume as positions in a binary PLY, the plainest of files.
void write_ply(const std::string& path, const ParticleSet& set)
{
    std::ofstream out(path, std::ios::binary);
    out << "ply\nformat binary_little_endian 1.0\nelement vertex " << set.size()
        << "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    out.write(reinterpret_cast<const char*>(set.position.data()),
              static_cast<std::streamsize>(set.size() * sizeof(Vec3)));
}

void write_csv(const std::string& path, const ParticleSet& set)
{
    std::ofstream out(path);
    out << "x,y,z\n";
    for (const Vec3& p : set.position) out << p.x << ',' << p.y << ',' << p.z << '\n';
}

void read_cache(benchmark::State& state, const char* ending,
                void (*write)(const std::string&, const ParticleSet&))
{
    const std::string path =
        (std::filesystem::temp_directory_path() / (std::string("mote_bench") + ending)).string();
    write(path, emit_particles(emitter(EmitterKind::Plume), 4.0));
    int64_t particles = 0;
    for (auto _ : state) {
        particles += static_cast<int64_t>(read_particle_file(path, {}, 24.0).size());
    }
    state.SetItemsProcessed(particles);
    std::filesystem::remove(path);
}
BENCHMARK_CAPTURE(read_cache, ply_positions, ".ply", write_ply)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_cache, csv_positions, ".csv", write_csv)->Unit(benchmark::kMillisecond);
// Read by a child process: wall time.
BENCHMARK_CAPTURE(read_cache, vdb_all_attributes, ".vdb", write_points)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace mote

BENCHMARK_MAIN();
