// CPU time and variance of the reference path tracer on scenes/plume_sun_sky: a plume of
// 128 x 256 x 128 voxels, optical depth 8 through its middle, sun and sky, 480 x 270 pixels.
//   bench_path_tracer [samples per pixel] [rounds] [camera distance, 5.4]
// One thread, process CPU time, camera rays included. Variants take turns in each round, so that
// what else runs on the machine disturbs them alike; the time is the median of the rounds.
// "rel. variance" is the per-sample variance of luminance, averaged over the image, over the
// square of the image's mean luminance.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "core/stats.h"
#include "reference/path_tracer.h"
#include "volumes/procedural_bricks.h"

namespace mote {
namespace {

double cpu_seconds()
{
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Scene plume_scene(double camera_distance)
{
    Volume volume;
    ProceduralParams params;
    params.kind = ProceduralKind::Plume;
    params.size = Vec3(1.28f, 2.56f, 1.28f);
    params.voxel_size = 0.01f;
    volume.density = make_procedural_bricks(params, 0.0);
    volume.albedo = Spectrum(0.9f);
    volume.phase.g = 0.3f;
    finalize(volume);
    // Mean optical depth of rays through the column's middle.
    float depth = 0.0f;
    for (int i = 0; i < 64; ++i) {
        const Vec3 origin(0.0f, -0.6f + 0.02f * static_cast<float>(i), 5.0f);
        depth +=
            optical_depth(volume, {origin, Vec3(0.0f, 0.0f, -1.0f), 0.0f}, {0.0f, infinity}) / 64;
    }
    volume.density_scale = 8.0f / depth;
    Scene scene;
    scene.media.volumes.push_back(volume);
    scene.lights.push_back(
        DistantLight{glm::normalize(Vec3(1.0f, 1.0f, 0.6f)), Spectrum(5.0f, 4.75f, 4.25f)});
    scene.environment = EnvironmentLight{0.35f * Spectrum(0.5f, 0.7f, 1.0f), nullptr, Mat3(1.0f)};
    scene.camera.width = 480;
    scene.camera.height = 270;
    scene.camera.tan_half_fov_y = 0.26795f;
    scene.camera.world_from_camera.keys[0].translate = Vec3d(0.0, 0.0, camera_distance);
    return scene;
}

struct Variant {
    std::string name;
    PathTracerParams params;
    std::vector<double> microseconds;  // per pixel and sample, one per round
    RunningStats pixel_mean;
    RunningStats pixel_variance;
    RunningStats events;  // 1 for paths that scatter, else 0
};

void render(const Scene& scene, int samples, uint32_t round, Variant& variant)
{
    const double start = cpu_seconds();
    const LightSampler lights = build_light_sampler(scene, variant.params);
    uint32_t pixel = 0;
    for (int y = 0; y < scene.camera.height; ++y) {
        for (int x = 0; x < scene.camera.width; ++x, ++pixel) {
            RunningStats stats;
            for (int i = 0; i < samples; ++i) {
                Rng rng(round, 0, Stream::Path, pixel, static_cast<uint32_t>(i));
                const Vec2 film = Vec2(x, y) + rng.uniform2();
                const Ray ray = generate_ray(scene.camera, film, Vec2(0.5f), 0.0f);
                const PathResult result = trace_path(scene, lights, variant.params, ray, rng);
                stats.add(static_cast<double>(luminance(result.L())));
                variant.events.add(result.depth < infinity ? 1.0 : 0.0);
            }
            variant.pixel_mean.add(stats.mean);
            variant.pixel_variance.add(stats.variance());
        }
    }
    const double paths = 1.0 * scene.camera.width * scene.camera.height * samples;
    variant.microseconds.push_back(1e6 * (cpu_seconds() - start) / paths);
}

std::vector<Variant> make_variants()
{
    std::vector<Variant> list;
    for (const int max_bounces : {1, 1'000'000}) {
        const std::string events = max_bounces == 1 ? "single  " : "multiple";
        PathTracerParams plain;
        plain.max_bounces = max_bounces;
        plain.light_strategy = LightStrategy::Mis;
        plain.light_sampler = LightSamplerKind::Power;
        plain.transmittance = TransmittanceKind::Ratio;
        list.push_back({events + " plain: one light, MIS, ratio", plain, {}, {}, {}, {}});
        PathTracerParams params;
        params.max_bounces = max_bounces;
        list.push_back({events + " default", params, {}, {}, {}, {}});
        params.transmittance = TransmittanceKind::Ratio;
        list.push_back({events + " ratio", params, {}, {}, {}, {}});
        params.transmittance = TransmittanceKind::ResidualRatio;
        list.push_back({events + " residual ratio", params, {}, {}, {}, {}});
        params.transmittance = TransmittanceKind::Exact;
        list.push_back({events + " exact", params, {}, {}, {}, {}});
    }
    return list;
}

}  // namespace
}  // namespace mote

int main(int argc, char** argv)
{
    const int samples = argc > 1 ? std::max(2, std::atoi(argv[1])) : 4;
    const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 3;
    const mote::Scene scene = mote::plume_scene(argc > 3 ? std::atof(argv[3]) : 5.4);
    std::vector<mote::Variant> variants = mote::make_variants();
    for (int round = 0; round < rounds; ++round) {
        for (mote::Variant& variant : variants) {
            mote::render(scene, samples, static_cast<uint32_t>(round), variant);
        }
    }
    std::printf("%.1f %% of the paths scatter\n", 100.0 * variants[0].events.mean);
    std::printf("%-42s %10s %10s %14s %12s\n", "variant", "us/sample", "mean", "rel. variance",
                "1/(us var)");
    for (mote::Variant& variant : variants) {
        std::sort(variant.microseconds.begin(), variant.microseconds.end());
        const double time = variant.microseconds[variant.microseconds.size() / 2];
        const double mean = variant.pixel_mean.mean;
        const double variance = variant.pixel_variance.mean / (mean * mean);
        std::printf("%-42s %10.3f %10.5f %14.4f %12.3f\n", variant.name.c_str(), time, mean,
                    variance, 1.0 / (time * variance));
    }
    return 0;
}
