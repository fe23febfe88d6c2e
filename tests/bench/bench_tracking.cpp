// What a density lookup, a cell of the exact walk and a ray of each tracker cost, on a plume of
// 128 x 256 x 128 voxels whose optical depth through the middle is 8. Times are per item (lookup,
// cell or ray that hits the plume's box), on one thread.
#include <benchmark/benchmark.h>

#include "core/sampling.h"
#include "volumes/cell_walk.h"
#include "volumes/depth_batch.h"
#include "volumes/procedural_bricks.h"
#include "volumes/ray_bins.h"
#include "volumes/tracking.h"
#include "volumes/walk_isa.h"

namespace mote {
namespace {

constexpr Interval everything{0.0f, infinity};

/// The plume, scaled so that rays across its middle have optical depth 8 on average.
const Media& plume()
{
    static const Media media = [] {
        ProceduralParams params;
        params.kind = ProceduralKind::Plume;
        params.size = {1.0f, 2.0f, 1.0f};
        params.voxel_size = 1.0f / 128.0f;
        Volume volume;
        volume.density = make_procedural_bricks(params, 0.0);
        finalize(volume);
        double sum = 0.0;
        for (int i = 0; i < 64; ++i) {
            const float offset = 0.2f * (static_cast<float>(i) / 63.0f - 0.5f);
            const Ray ray{{offset, offset, -5.0f}, {0.0f, 0.0f, 1.0f}};
            sum += static_cast<double>(optical_depth(volume, ray, everything)) / 64.0;
        }
        volume.density_scale = static_cast<float>(8.0 / sum);
        return Media{{volume}};
    }();
    return media;
}

/// Camera rays of a 480 x 270 image that hit the plume's bounds.
const std::vector<Ray>& camera_rays()
{
    static const std::vector<Ray> rays = [] {
        std::vector<Ray> out;
        const Vec3 eye(0.0f, 0.0f, -3.6f);
        // 16 x 16 pixel tiles, as a renderer takes them.
        for (int i = 0; i < 480 * 272; ++i) {
            const int tile = i / 256;
            const int x = tile % 30 * 16 + i % 16;
            const int y = tile / 30 * 16 + i / 16 % 16;
            const Vec3 d = glm::normalize(
                Vec3(static_cast<float>(x - 240), static_cast<float>(y - 135), 440.0f));
            const Ray ray{eye, d};
            if (!volume_interval(plume().volumes[0], ray, everything).is_empty()) {
                out.push_back(ray);
            }
        }
        return out;
    }();
    return rays;
}

/// Rays towards the sun from collisions of the camera rays.
const std::vector<Ray>& shadow_rays()
{
    static const std::vector<Ray> rays = [] {
        std::vector<Ray> out;
        const Vec3 sun = glm::normalize(Vec3(1.0f, 1.0f, -0.5f));
        uint32_t i = 0;
        for (const Ray& ray : camera_rays()) {
            Rng rng(1, 0, Stream::Test, i++, 0);
            const auto hit = sample_free_flight(plume(), ray, everything, rng);
            if (hit) out.push_back({ray.at(hit->t), sun});
        }
        return out;
    }();
    return rays;
}

/// Runs f(ray, rng) over the rays; reports time per ray.
template <class F>
void over_rays(benchmark::State& state, const std::vector<Ray>& rays, F&& f)
{
    uint32_t pass = 0;
    for (auto _ : state) {
        float sum = 0.0f;
        for (size_t i = 0; i < rays.size(); ++i) {
            Rng rng(1, pass, Stream::Test, static_cast<uint32_t>(i), 0);
            sum += f(rays[i], rng);
        }
        benchmark::DoNotOptimize(sum);
        ++pass;
    }
    state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(rays.size()));
    state.counters["per_item"] = benchmark::Counter(
        static_cast<double>(rays.size()),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void delta_camera(benchmark::State& state)
{
    over_rays(state, camera_rays(), [](const Ray& ray, Rng& rng) {
        const auto hit = sample_free_flight(plume(), ray, everything, rng);
        return hit ? hit->t : 0.0f;
    });
}
BENCHMARK(delta_camera)->Unit(benchmark::kMillisecond);

void walk_camera(benchmark::State& state)
{
    const Volume& volume = plume().volumes[0];
    const BrickGrid& grid = *volume.density;
    over_rays(state, camera_rays(), [&](const Ray& ray, Rng&) {
        float sum = 0.0f;
        for_each_brick(grid, make_local_ray(grid, volume.at_rest->density, ray, everything),
                       [&](const BrickSpan& span) {
                           sum += span.s1 - span.s0;
                           return true;
                       });
        return sum;
    });
}
BENCHMARK(walk_camera)->Unit(benchmark::kMillisecond);

void transmittance_shadow(benchmark::State& state)
{
    const auto kind = static_cast<TransmittanceKind>(state.range(0));
    over_rays(state, shadow_rays(), [&](const Ray& ray, Rng& rng) {
        return estimate_transmittance(plume(), ray, everything, kind, rng);
    });
}
BENCHMARK(transmittance_shadow)
    ->Unit(benchmark::kMillisecond)
    ->ArgName("kind(ratio,residual,exact)")
    ->DenseRange(0, 2);

void transmittance_camera(benchmark::State& state)
{
    const auto kind = static_cast<TransmittanceKind>(state.range(0));
    over_rays(state, camera_rays(), [&](const Ray& ray, Rng& rng) {
        return estimate_transmittance(plume(), ray, everything, kind, rng);
    });
}
BENCHMARK(transmittance_camera)
    ->Unit(benchmark::kMillisecond)
    ->ArgName("kind(ratio,residual,exact)")
    ->DenseRange(0, 2);

void inversion_camera(benchmark::State& state)
{
    over_rays(state, camera_rays(), [](const Ray& ray, Rng& rng) {
        const float tau = sample_exponential(rng.uniform());
        const auto hit = invert_optical_depth(plume().volumes[0], ray, everything, tau);
        return hit ? hit->t : 0.0f;
    });
}
BENCHMARK(inversion_camera)->Unit(benchmark::kMillisecond);

/// Cells of the exact walk; the brick walk around them is part of the time.
void exact_cells(benchmark::State& state)
{
    const Volume& volume = plume().volumes[0];
    const BrickGrid& grid = *volume.density;
    int64_t cells = 0;
    for (auto _ : state) {
        float sum = 0.0f;
        for (const Ray& ray : camera_rays()) {
            const LocalRay local = make_local_ray(grid, volume.at_rest->density, ray, everything);
            for_each_brick(grid, local, [&](const BrickSpan& span) {
                return for_each_cell(grid, local, span, [&](const CellSpan& cell) {
                    sum += cell.integral();
                    ++cells;
                    return true;
                });
            });
        }
        benchmark::DoNotOptimize(sum);
    }
    state.counters["per_item"] = benchmark::Counter(
        static_cast<double>(cells), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["cells/ray"] = static_cast<double>(cells) /
                                  static_cast<double>(state.iterations()) /
                                  static_cast<double>(camera_rays().size());
}
BENCHMARK(exact_cells)->Unit(benchmark::kMillisecond);

/// Cells on the way to the bins of camera rays, so many rays at once; 1: each alone.
void camera_bins(benchmark::State& state)
{
    const auto at_once = static_cast<size_t>(state.range(0));
    const std::vector<Ray>& rays = camera_rays();
    std::vector<RayBins> bins(at_once);
    std::vector<BinQuery> queries;
    BinCounts counts;
    for (auto _ : state) {
        for (size_t begin = 0; begin < rays.size(); begin += at_once) {
            const size_t count = std::min(at_once, rays.size() - begin);
            queries.clear();
            for (size_t i = 0; i < count; ++i) {
                queries.push_back({&rays[begin + i], infinity, &bins[i]});
            }
            if (at_once == 1) {
                make_ray_bins(plume(), rays[begin], 1e-7f, bins[0], counts);
            } else {
                make_ray_bins(plume(), queries, 1e-7f, counts);
            }
            benchmark::DoNotOptimize(bins.data());
        }
    }
    state.counters["per_item"] =
        benchmark::Counter(static_cast<double>(counts.cells),
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(camera_bins)->Unit(benchmark::kMillisecond)->ArgName("at_once")->Arg(1)->Arg(8)->Arg(64);

/// Rays in all directions from the same collisions.
const std::vector<Ray>& isotropic_rays()
{
    static const std::vector<Ray> rays = [] {
        std::vector<Ray> out = shadow_rays();
        for (size_t i = 0; i < out.size(); ++i) {
            Rng rng(2, 0, Stream::Test, static_cast<uint32_t>(i), 0);
            out[i].d = sample_sphere(rng.uniform2());
        }
        return out;
    }();
    return rays;
}

/// Exact optical depths of many rays at once: camera, towards the sun, in all directions. `form`
/// 0 is a call of optical_depth per ray, 1 to 3 optical_depths in scalar, AVX2 and AVX-512 form.
void depth_batch(benchmark::State& state)
{
    const int64_t form = state.range(0);
    const int64_t kind = state.range(1);
    const float tau_max = state.range(2) > 0 ? static_cast<float>(state.range(2)) : infinity;
    const size_t batch = static_cast<size_t>(state.range(3));
    const auto& rays = kind == 0 ? camera_rays() : kind == 1 ? shadow_rays() : isotropic_rays();
    if (form > 0 && !is_supported(static_cast<Isa>(form - 1))) {
        state.SkipWithError("not on this machine");
        return;
    }
    set_walk_isa(form > 0 ? std::optional(static_cast<Isa>(form - 1)) : std::nullopt);
    std::vector<DepthQuery> queries;
    for (const Ray& ray : rays) queries.push_back({ray.o, infinity, ray.d, 0.0f, tau_max});
    std::vector<float> tau(queries.size());
    WalkCounts counts;
    optical_depths(plume(), queries, tau, counts);
    const auto cells = static_cast<double>(counts.cells);
    for (auto _ : state) {
        if (form == 0) {
            for (size_t i = 0; i < rays.size(); ++i) {
                tau[i] = optical_depth(plume(), rays[i], everything);
            }
        } else {
            for (size_t i = 0; i < queries.size(); i += batch) {
                const size_t count = std::min(batch, queries.size() - i);
                optical_depths(plume(), std::span(queries).subspan(i, count),
                               std::span(tau).subspan(i, count), counts);
            }
        }
        benchmark::DoNotOptimize(tau.data());
    }
    const auto per = [](double items) {
        return benchmark::Counter(
            items, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    };
    state.counters["per_cell"] = per(cells);
    state.counters["per_ray"] = per(static_cast<double>(rays.size()));
    state.counters["cells/ray"] = cells / static_cast<double>(rays.size());
}
BENCHMARK(depth_batch)
    ->Unit(benchmark::kMillisecond)
    ->ArgNames({"form(one,scalar,avx2,avx512)", "rays(camera,sun,all)", "tau_max", "batch"})
    ->ArgsProduct({{0, 1, 2, 3}, {0, 1, 2}, {0}, {1024}})
    ->Args({3, 1, 5, 1024});

/// Lookups one voxel apart along rays, and at random points.
void lookups(benchmark::State& state)
{
    const BrickGrid& grid = *plume().volumes[0].density;
    const bool is_random = state.range(0) != 0;
    const Vec3 extent(grid.brick_count * BrickGrid::brick_size);
    std::vector<Vec3> points(1 << 18);
    Rng rng(5, 0, Stream::Test, 0, 0);
    for (size_t i = 0; i < points.size(); ++i) {
        const bool fresh = is_random || i % 64 == 0;
        points[i] = fresh ? rng.uniform3() * extent : points[i - 1] + Vec3(0.55f, 0.6f, 0.58f);
    }
    for (auto _ : state) {
        float sum = 0.0f;
        for (const Vec3& p : points) sum += sample_local(grid, p);
        benchmark::DoNotOptimize(sum);
    }
    state.counters["per_item"] = benchmark::Counter(
        static_cast<double>(points.size()),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(lookups)->Unit(benchmark::kMillisecond)->ArgName("random")->DenseRange(0, 1);

void build_plume_bricks(benchmark::State& state)
{
    ProceduralParams params;
    params.kind = ProceduralKind::Box;
    params.size = {1.0f, 1.0f, 1.0f};
    params.voxel_size = 1.0f / 128.0f;
    for (auto _ : state) benchmark::DoNotOptimize(make_procedural_bricks(params, 0.0));
    const BrickGrid& grid = *plume().volumes[0].density;
    state.counters["plume_bricks"] = static_cast<double>(grid.active_bricks());
    state.counters["plume_filled"] =
        static_cast<double>(grid.active_bricks()) / static_cast<double>(grid.table.size());
    state.counters["camera_rays"] = static_cast<double>(camera_rays().size());
    state.counters["shadow_rays"] = static_cast<double>(shadow_rays().size());
}
BENCHMARK(build_plume_bricks)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote

BENCHMARK_MAIN();
