// What the light caches cost and how far off they are, on a plume of 128 x 192 x 128 voxels of
// 1 cm with a given optical depth through its middle.
//   bench_light_caches [optical depth, 8]
// One thread, process CPU time. "rel. mse" is the mean square error of the transmittance over the
// mean square of the exact one, at the scattering points of camera rays.

#include <cstdio>
#include <cstdlib>

#include "core/parallel.h"
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

void run(float depth)
{
    const Media media = plume(depth);
    const std::vector<Vec3> points = scattering_points(media, 20'000);
    std::printf("optical depth %.0f, %zu points\n", static_cast<double>(depth), points.size());
    maps(media, points);
}

}  // namespace
}  // namespace mote

int main(int argc, char** argv)
{
    const float depth = argc > 1 ? static_cast<float>(std::atof(argv[1])) : 8.0f;
    mote::run_with_threads(1, [&] { mote::run(depth); });
    return 0;
}
