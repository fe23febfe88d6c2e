// How much of the light of many events two nearby places share: variance and cost of
// estimate_difference by distance, against a path of its own, in a plume of 128 x 192 x 128 voxels
// of 1 cm.   bench_pairs [optical depth, 8] [g, 0.3] [albedo, 0.9]

#include <cstdio>
#include <cstdlib>

#include "core/parallel.h"
#include "core/sampling.h"
#include "core/stats.h"
#include "multiscatter/paired_paths.h"
#include "restir/cache_stats.h"
#include "restir/ray_flight.h"
#include "volumes/procedural_bricks.h"

namespace mote {
namespace {

constexpr Interval everything{0.0f, infinity};
constexpr Vec3 eye{0.0f, 0.0f, 5.4f};

Scene plume(float depth_wanted, float g, float albedo)
{
    Volume volume;
    ProceduralParams params;
    params.kind = ProceduralKind::Plume;
    params.size = Vec3(1.28f, 1.92f, 1.28f);
    params.voxel_size = 0.01f;
    volume.density = make_procedural_bricks(params, 0.0);
    volume.phase.g = g;
    volume.albedo = Spectrum(albedo);
    finalize(volume);
    float depth = 0.0f;
    for (int i = 0; i < 64; ++i) {
        const Vec3 origin(0.0f, -0.5f + 0.015f * static_cast<float>(i), 5.0f);
        depth += optical_depth(volume, {origin, Vec3(0.0f, 0.0f, -1.0f)}, everything) / 64.0f;
    }
    volume.density_scale = depth_wanted / depth;
    Scene scene;
    scene.media = {{volume}};
    scene.lights.push_back(
        DistantLight{glm::normalize(Vec3(-0.4f, 1.0f, 0.8f)), Spectrum(8.0f, 7.6f, 6.8f)});
    scene.environment = EnvironmentLight{Spectrum(0.175f, 0.245f, 0.35f), nullptr};
    return scene;
}

void run(float depth, float g, float albedo)
{
    const Scene scene = plume(depth, g, albedo);
    PathTracerParams path;
    path.max_bounces = 1000;
    const LightSampler lights(scene, path);
    PathTracerParams exact = path;
    exact.transmittance = TransmittanceKind::Exact;
    const Bounds3 bounds = world_bounds(scene.media.volumes[0]);
    std::vector<Vec3> points;
    for (uint32_t i = 0; points.size() < 10000; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        const Vec3 target = bounds.lo + rng.uniform3() * bounds.extent();
        const Ray ray{eye, glm::normalize(target - eye)};
        const auto hit = sample_free_flight(scene.media, ray, everything, rng);
        if (hit) points.push_back(ray.at(hit->t));
    }
    const Phase& phase = scene.media.volumes[0].phase;
    const auto event_at = [&](Vec3 x) {
        return PairedEvent{x, glm::normalize(eye - x), &phase, Spectrum(albedo)};
    };
    const double start = process_cpu_seconds();
    double mean = 0.0, square = 0.0;
    const int n = static_cast<int>(points.size());
    for (int i = 0; i < n; ++i) {
        Rng rng(2, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        const PairedEvent e = event_at(points[static_cast<size_t>(i)]);
        const ScatterEvent first{e.x, e.wo, 0.0f, &phase};
        const double y = static_cast<double>(
            albedo * luminance(trace_after_event({scene, lights, path}, first, rng).indirect));
        mean += y / n;
        square += y * y / n;
    }
    const double path_us = (process_cpu_seconds() - start) / n * 1e6;
    std::printf("path: mean %.4f, rms/mean %.3f, %.2f us; mean free path %.4f m\n", mean,
                std::sqrt(square) / mean, path_us,
                1.0 / static_cast<double>(scene.media.volumes[0].density_scale));
    std::printf("offset | by share of light | by distance: square/path's, us, product\n");
    for (const float d : {0.0005f, 0.001f, 0.0025f, 0.005f, 0.01f, 0.02f, 0.04f, 0.08f}) {
        double sum[2] = {0.0, 0.0};
        double us[2] = {0.0, 0.0};
        double apart[2] = {0.0, 0.0};
        double ray_square = 0.0;
        for (int way = 0; way < 2; ++way) {
            const double t0 = process_cpu_seconds();
            for (int i = 0; i < n; ++i) {
                Rng rng(3, 0, Stream::Test, static_cast<uint32_t>(i), 0);
                const Vec3 x0 = points[static_cast<size_t>(i)];
                const Vec3 offset = d * sample_sphere(rng.uniform2());
                const Ray r{eye, glm::normalize(x0 - eye)};
                const Ray R{eye, glm::normalize(x0 + offset - eye)};
                BinCounts counts;
                RayBins br;
                RayBins bR;
                make_ray_bins(scene.media, r, 1e-8f, br, counts);
                make_ray_bins(scene.media, R, 1e-8f, bR, counts);
                if (br.empty() || bR.empty()) continue;
                const float lr = -std::expm1(-br.depth());
                const float lR = -std::expm1(-bR.depth());
                if (way == 0) ray_square += static_cast<double>(lr * lr) / n;
                PairedEvent ea;
                PairedEvent eb;
                if (way == 0) {
                    const float u = rng.uniform();
                    ea = event_at(flight_at(scene.media, r, br, u).x);
                    eb = event_at(flight_at(scene.media, R, bR, u).x);
                    ea.weight *= lr;
                    eb.weight *= lR;
                } else {
                    const bool first = rng.uniform() * (lr + lR) < lr;
                    const Ray& own = first ? r : R;
                    const Vec3 x = flight_at(scene.media, own, first ? br : bR, rng.uniform()).x;
                    const float t = glm::length(x - eye);
                    const auto f = [&](const Ray& ray, const RayBins& bins) {
                        const auto s = static_cast<float>(static_cast<double>(t) - bins.t0);
                        if (s < bins.s[0] || s > bins.s[bins.count]) return 0.0f;
                        return sigma_t_at(scene.media, ray.at(t), 0.0f) *
                               std::exp(-depth_to(scene.media, ray, bins, s));
                    };
                    const float fr = f(r, br);
                    const float fR = f(R, bR);
                    const float pdf = (fr + fR) / (lr + lR);
                    if (!(pdf > 0.0f)) continue;
                    ea = event_at(r.at(t));
                    eb = event_at(R.at(t));
                    ea.weight *= fr / pdf;
                    eb.weight *= fR / pdf;
                }
                apart[way] += static_cast<double>(glm::length(ea.x - eb.x)) / n;
                const PairedPathParams params{8.0f * glm::length(ea.x - eb.x), true, 0.25f};
                bool truncated = false;
                const double y = static_cast<double>(luminance(estimate_difference(
                    {scene, lights, exact}, ea, eb, 0.0f, params, rng, truncated)));
                sum[way] += y * y / n;
            }
            us[way] = (process_cpu_seconds() - t0) / n * 1e6;
        }
        std::printf("%7.4f", static_cast<double>(d));
        for (int way = 0; way < 2; ++way) {
            const double share = sum[way] / (square * ray_square);
            std::printf("  | apart %.4f: %.4f %5.2f %.4f", apart[way], share, us[way],
                        share * us[way] / path_us);
        }
        std::printf("\n");
    }
}

}  // namespace
}  // namespace mote

int main(int argc, char** argv)
{
    const auto arg = [&](int i, double value) {
        return static_cast<float>(argc > i ? std::atof(argv[i]) : value);
    };
    mote::run_with_threads(1, [&] { mote::run(arg(1, 8.0), arg(2, 0.3), arg(3, 0.9)); });
}
