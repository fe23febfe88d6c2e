// What the light caches cost and how far off they are, on a plume of 128 x 192 x 128 voxels of
// 1 cm with a given optical depth through its middle.
//   bench_light_caches [optical depth, 8]
// One thread, process CPU time. "rel. mse" is the mean square error of the transmittance over the
// mean square of the exact one, at the scattering points of camera rays.

#include <cstdio>
#include <cstdlib>

#include "core/parallel.h"
#include "core/sampling.h"
#include "core/stats.h"
#include "restir/environment_cache.h"
#include "restir/transmittance_map.h"
#include "volumes/procedural_bricks.h"

namespace mote {
namespace {

constexpr Interval everything{0.0f, infinity};
constexpr Vec3 eye{0.0f, 0.0f, 5.4f};

Media plume(float depth_wanted)
{
    Volume volume;
    ProceduralParams params;
    params.kind = ProceduralKind::Plume;
    params.size = Vec3(1.28f, 1.92f, 1.28f);
    params.voxel_size = 0.01f;
    volume.density = make_procedural_bricks(params, 0.0);
    volume.phase.g = 0.3f;
    finalize(volume);
    float depth = 0.0f;
    for (int i = 0; i < 64; ++i) {
        const Vec3 origin(0.0f, -0.5f + 0.015f * static_cast<float>(i), 5.0f);
        depth += optical_depth(volume, {origin, Vec3(0.0f, 0.0f, -1.0f)}, everything) / 64.0f;
    }
    volume.density_scale = depth_wanted / depth;
    return {{volume}};
}

std::vector<Vec3> scattering_points(const Media& media, int count)
{
    std::vector<Vec3> points;
    const Bounds3 bounds = world_bounds(media.volumes[0]);
    for (uint32_t i = 0; static_cast<int>(points.size()) < count && i < 1'000'000; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        const Vec3 target = bounds.lo + rng.uniform3() * bounds.extent();
        const Ray ray{eye, glm::normalize(target - eye)};
        const auto hit = sample_free_flight(media, ray, everything, rng);
        if (hit) points.push_back(ray.at(hit->t));
    }
    return points;
}

/// Nanoseconds per call of f(point), the points taken again and again.
template <class F>
double nanoseconds(const std::vector<Vec3>& points, F&& f)
{
    constexpr int rounds = 20;
    float sum = 0.0f;
    const double start = process_cpu_seconds();
    for (int round = 0; round < rounds; ++round) {
        for (const Vec3& x : points) sum += f(x);
    }
    const double seconds = process_cpu_seconds() - start;
    if (sum == -1.0f) std::puts("");  // the sum must not be optimised away
    return 1e9 * seconds / (rounds * static_cast<double>(points.size()));
}

void maps(const Media& media, const std::vector<Vec3>& points)
{
    const Vec3 sun = glm::normalize(Vec3(1.0f, 1.0f, 0.6f));
    std::vector<double> exact;
    double square = 0.0;
    for (const Vec3& x : points) {
        exact.push_back(std::exp(-static_cast<double>(optical_depth(media, {x, sun}, everything))));
        square += exact.back() * exact.back();
    }
    std::printf("%-24s %10s %10s %10s %10s %10s %12s\n", "map, spacing in voxels", "build ms",
                "rays", "nodes", "MB", "ns/lookup", "rel. mse");
    for (const float voxels : {1.0f, 2.0f, 4.0f, 8.0f}) {
        TransmittanceMapParams params;
        params.spacing = 0.01f * voxels;
        params.node_budget = 100'000'000;
        const TransmittanceMap map(media, sun, params);
        double error = 0.0;
        for (size_t i = 0; i < points.size(); ++i) {
            const double T = static_cast<double>(map.transmittance(points[i]));
            error += (T - exact[i]) * (T - exact[i]);
        }
        const double ns = nanoseconds(points, [&](Vec3 x) { return map.optical_depth(x); });
        const CacheStats& stats = map.stats();
        std::printf("%-24.0f %10.2f %10lld %10lld %10.2f %10.1f %12.2e\n",
                    static_cast<double>(voxels), 1e3 * stats.cpu_seconds,
                    static_cast<long long>(stats.rays), static_cast<long long>(stats.nodes),
                    1e-6 * static_cast<double>(stats.bytes), ns, error / square);
    }
}

/// Nanoseconds per call of f(point, direction).
template <class F>
double directional_nanoseconds(const std::vector<Vec3>& points, F&& f)
{
    size_t i = 0;
    std::vector<Vec3> directions;
    for (uint32_t n = 0; n < 1024; ++n) {
        Rng rng(2, 0, Stream::Test, n, 0);
        directions.push_back(sample_sphere(rng.uniform2()));
    }
    return nanoseconds(points, [&](Vec3 x) { return f(x, directions[i++ & 1023]); });
}

struct Quality {
    double inscatter = 0.0;  ///< rel. mse of inscatter()
    double residual = 0.0;   ///< variance of one residual ray over the mean squared in-scatter
    double plain = 0.0;      ///< the same without a control variate
};

/// Against exact rays in directions drawn from the phase function, constant environment.
Quality quality_of(const EnvironmentCache& cache, const Media& media,
                   const std::vector<Vec3>& points)
{
    constexpr int n = 24;
    const Phase phase = media.volumes[0].phase;
    Quality out;
    double square = 0.0;
    for (size_t i = 0; i < points.size(); i += points.size() / 100) {
        const Vec3 x = points[i];
        const Vec3 wo = glm::normalize(eye - x);
        RunningStats truth;
        RunningStats residual;
        for (int k = 0; k < n * n; ++k) {
            const Vec2 u((static_cast<float>(k % n) + 0.5f) / n,
                         (static_cast<float>(k / n) + 0.5f) / n);
            const Vec3 wi = sample_phase(phase, wo, u);
            const float T = std::exp(-optical_depth(media, {x, wi}, everything));
            const float f = cache.directional(0, x, wo, wi).x / phase_pdf(phase, wo, wi);
            truth.add(static_cast<double>(T));
            residual.add(static_cast<double>(T - f));
        }
        const double S = static_cast<double>(cache.inscatter(0, x).x);
        out.inscatter += (S - truth.mean) * (S - truth.mean);
        out.residual += residual.variance() + residual.mean * residual.mean;
        out.plain += truth.variance();
        square += truth.mean * truth.mean;
    }
    return {out.inscatter / square, out.residual / square, out.plain / square};
}

void environments(Media media, const std::vector<Vec3>& points)
{
    const EnvironmentLight sky{Spectrum(1.0f), nullptr, Mat3(1.0f)};
    std::printf("\n%-28s %9s %9s %9s %9s %9s %9s\n", "environment", "build ms", "rays", "nodes",
                "MB", "bake ms", "T ns");
    struct Shape {
        DirectionHats hats;
        float node_voxels;
        float map_voxels;
    };
    for (const Shape& shape : {Shape{{4, 8}, 4.0f, 8.0f},
                               {{4, 8}, 4.0f, 4.0f},
                               {{6, 12}, 4.0f, 8.0f},
                               {{6, 12}, 4.0f, 4.0f},
                               {{6, 12}, 2.0f, 2.0f}}) {
        DirectionTransmittanceParams params;
        params.hats = shape.hats;
        params.node_spacing = 0.01f * shape.node_voxels;
        params.map_spacing = 0.01f * shape.map_voxels;
        params.node_budget = 1'000'000;
        const auto T = std::make_shared<const DirectionTransmittance>(media, params);
        const auto radiance = mean_radiance(sky, shape.hats);
        media.volumes[0].phase.g = 0.3f;
        const EnvironmentCache cache(T, radiance, media, eye);
        const double ns = directional_nanoseconds(
            points, [&](Vec3 x, Vec3 wi) { return T->transmittance(x, wi); });
        char name[64];
        std::snprintf(name, sizeof name, "%d directions, nodes %.0f, maps %.0f", shape.hats.count(),
                      static_cast<double>(shape.node_voxels),
                      static_cast<double>(shape.map_voxels));
        std::printf(
            "%-28s %9.1f %9lld %9lld %9.1f %9.2f %9.1f\n", name, 1e3 * T->stats().cpu_seconds,
            static_cast<long long>(T->stats().rays), static_cast<long long>(T->stats().nodes),
            1e-6 * static_cast<double>(T->stats().bytes), 1e3 * cache.stats().cpu_seconds, ns);
        for (const float g : {0.0f, 0.3f, 0.6f, 0.9f, 0.95f, -0.9f}) {
            media.volumes[0].phase.g = g;
            const EnvironmentCache one(T, radiance, media, eye);
            const double in = nanoseconds(points, [&](Vec3 x) { return one.inscatter(0, x).x; });
            const double dir = directional_nanoseconds(points, [&](Vec3 x, Vec3 wi) {
                return one.directional(0, x, Vec3(0.0f, 0.0f, 1.0f), wi).x;
            });
            const Quality q = quality_of(one, media, points);
            std::printf(
                "    g %5.2f: inscatter %5.1f ns, rel. mse %8.2e; directional %5.1f ns, "
                "residual variance %8.2e (plain %8.2e)\n",
                static_cast<double>(g), in, q.inscatter, dir, q.residual, q.plain);
        }
    }
}

void run(float depth)
{
    const Media media = plume(depth);
    const std::vector<Vec3> points = scattering_points(media, 20'000);
    std::printf("optical depth %.0f, %zu points\n", static_cast<double>(depth), points.size());
    maps(media, points);
    environments(media, points);
}

}  // namespace
}  // namespace mote

int main(int argc, char** argv)
{
    const float depth = argc > 1 ? static_cast<float>(std::atof(argv[1])) : 8.0f;
    mote::run_with_threads(1, [&] { mote::run(depth); });
    return 0;
}
