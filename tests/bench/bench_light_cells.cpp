// Light cells over a plume of 128 x 256 x 128 voxels with many lamps in and around it: what they
// cost to build and to use, and how well they choose lights against the reference's light tree.
//   bench_light_cells [optical depth through the middle, 8] [g, 0.3] [voxels across, 128]
//                     [most clusters per cell, 128] [effort, 1: points at which variance is taken]
//                     [most lights, 1000000]
//   bench_light_cells scene.toml
// CPU time of one process. "rel. variance" is that of one light sample at the collisions of camera
// rays, exact (a sum over all lights with exact transmittance): sum of variances over sum of
// squared means, then the median over points of variance over squared mean.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "reference/light_sampler.h"
#include "restir/light_cells.h"
#include "scene/prepare.h"
#include "scene/scene_io.h"
#include "volumes/procedural_bricks.h"

namespace mote {
namespace {

double cpu_seconds()
{
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Scene plume_scene(float depth_goal, float g, int voxels)
{
    Volume volume;
    ProceduralParams params;
    params.kind = ProceduralKind::Plume;
    params.size = Vec3(1.28f, 2.56f, 1.28f);
    params.voxel_size = 1.28f / static_cast<float>(voxels);
    volume.density = make_procedural_bricks(params, 0.0);
    volume.albedo = Spectrum(0.9f);
    volume.phase.g = g;
    finalize(volume);
    float depth = 0.0f;
    for (int i = 0; i < 64; ++i) {
        const Vec3 origin(0.0f, -0.6f + 0.02f * static_cast<float>(i), 5.0f);
        depth += optical_depth(volume, {origin, Vec3(0.0f, 0.0f, -1.0f)}, {0.0f, infinity}) / 64;
    }
    volume.density_scale = depth_goal / depth;
    Scene scene;
    scene.media.volumes.push_back(volume);
    scene.camera.width = 480;
    scene.camera.height = 270;
    scene.camera.tan_half_fov_y = 0.26795f;
    scene.camera.world_from_camera.keys[0].translate = Vec3d(0.0, 0.0, 5.4);
    return scene;
}

void scatter_lamps(Scene& scene, int count)
{
    scene.lights.clear();
    for (int i = 0; i < count; ++i) {
        Rng rng(7, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        const Vec3 p = (rng.uniform3() - 0.5f) * Vec3(1.4f, 2.6f, 1.4f);
        scene.lights.push_back(PointLight{p, rng.uniform3()});
    }
}

struct Event {
    Vec3 x;
    Vec3 wo;
    Phase phase;
};

/// At random places of the film, or in scanline order with 8 rays per pixel.
std::vector<Event> collisions(const Scene& scene, int count, bool in_order)
{
    std::vector<Event> out;
    for (uint32_t i = 0; static_cast<int>(out.size()) < count && i < 2000000; ++i) {
        Rng rng(3, 0, Stream::Test, i, 0);
        const auto width = static_cast<uint32_t>(scene.camera.width);
        const auto height = static_cast<uint32_t>(scene.camera.height);
        const Vec2 film = in_order ? Vec2(i / 8 % width, i / 8 / width % height)
                                   : rng.uniform2() * Vec2(width, height);
        const Ray ray = generate_ray(scene.camera, film, Vec2(0.5f), 0.5f);
        const auto hit = sample_free_flight(scene.media, ray, {0.0f, infinity}, rng);
        if (!hit) continue;
        out.push_back(
            {ray.at(hit->t), -ray.d, scene.media.volumes[static_cast<size_t>(hit->volume)].phase});
    }
    return out;
}

/// Luminance that light `l` scatters to the eye at the event, exact but for lamps with a surface
/// (taken at their centre); lamps nearer than 1 cm as if they were 1 cm away.
double scattered(const Scene& scene, const Event& event, const Light& lamp)
{
    const Bounds3 box = light_bounds(lamp);
    if (box.is_empty()) return 0.0;
    const Vec3 to_light = box.centre() - event.x;
    const float distance = std::max(glm::length(to_light), 1e-6f);
    const Ray ray{event.x, to_light / distance, 0.5f};
    const float tau = optical_depth(scene.media, ray, {0.0f, distance});
    const double power = static_cast<double>(light_power(lamp, 0.0f));
    return power * static_cast<double>(inv_4pi / sqr(std::max(distance, 0.01f)) * std::exp(-tau) *
                                       eval_phase(event.phase, event.wo, ray.d));
}

struct Quality {
    double variance = 0.0;
    double mean2 = 0.0;
    std::vector<double> relative;

    void add(double second_moment, double mean)
    {
        variance += second_moment - mean * mean;
        mean2 += mean * mean;
        relative.push_back(second_moment / (mean * mean) - 1.0);
    }
    [[nodiscard]] double median()
    {
        std::sort(relative.begin(), relative.end());
        return relative.empty() ? 0.0 : relative[relative.size() / 2];
    }
};

void compare(const Scene& scene, const LightCells& cells, int points)
{
    PathTracerParams params;
    params.light_sampler = LightSamplerKind::Tree;
    const LightSampler tree = build_light_sampler(scene, params);
    Quality by_tree;
    Quality by_cells;
    std::vector<double> log_ratio;
    for (const Event& event : collisions(scene, points, false)) {
        double mean = 0.0;
        double second_tree = 0.0;
        double second_cells = 0.0;
        for (size_t i = 0; i < scene.lights.size(); ++i) {
            const double f = scattered(scene, event, scene.lights[i]);
            if (!(f > 0.0)) continue;
            mean += f;
            const int l = static_cast<int>(i);
            second_tree += f * f / static_cast<double>(tree.pmf(LightSource::Lamp, l, event.x));
            second_cells += f * f / static_cast<double>(cells.pmf(l, event.x));
        }
        if (!(mean > 0.0)) continue;
        by_tree.add(second_tree, mean);
        by_cells.add(second_cells, mean);
        log_ratio.push_back(std::log(static_cast<double>(cells.inscatter(event.x)) / mean));
    }
    double shift = 0.0;
    double spread = 0.0;
    for (const double r : log_ratio) shift += r / static_cast<double>(log_ratio.size());
    for (const double r : log_ratio) spread += (r - shift) * (r - shift);
    spread = std::sqrt(spread / static_cast<double>(log_ratio.size()));
    const double tree_variance = by_tree.variance / by_tree.mean2;
    const double cell_variance = by_cells.variance / by_cells.mean2;
    std::printf("    rel. variance  tree %8.3f %8.3f  cells %8.3f %8.3f  ratio %6.2f %6.2f\n",
                tree_variance, by_tree.median(), cell_variance, by_cells.median(),
                tree_variance / cell_variance, by_tree.median() / by_cells.median());
    std::printf("    inscatter / exact  mean factor %.3f, spread factor %.3f\n", std::exp(shift),
                std::exp(spread));
}

void time_lookups(const Scene& scene, const LightCells& cells)
{
    const std::vector<Event> events = collisions(scene, 100000, true);
    const double count = 5.0 * static_cast<double>(events.size());
    double sum = 0.0;
    const auto over = [&](auto&& f) {
        const double start = cpu_seconds();
        for (int round = 0; round < 5; ++round) {
            for (size_t i = 0; i < events.size(); ++i)
                sum += f(events[i].x,
                         (static_cast<double>(i) + 0.5) / static_cast<double>(events.size()));
        }
        return 1e9 * (cpu_seconds() - start) / count;
    };
    const double sample = over([&](Vec3 x, double u) {
        return static_cast<double>(cells.sample(x, std::fmod(u * 911.0, 1.0)).pmf);
    });
    const double pmf = over([&](Vec3 x, double u) {
        const auto light = static_cast<int>(u * static_cast<double>(scene.lights.size()));
        return static_cast<double>(cells.pmf(light, x));
    });
    const double inscatter =
        over([&](Vec3 x, double) { return static_cast<double>(cells.inscatter(x)); });
    std::printf("    sample %.0f ns, pmf %.0f ns, inscatter %.0f ns%s\n", sample, pmf, inscatter,
                sum < 0.0 ? "!" : "");
}

void run(const Scene& scene, const LightCellsParams& params, int points)
{
    const Vec3 eye = generate_ray(scene.camera, Vec2(0.5f), Vec2(0.5f), 0.5f).o;
    std::vector<double> build;
    std::vector<double> view;
    LightCells cells;
    size_t local = 0;
    for (int round = 0; round < 3; ++round) {
        const double start = cpu_seconds();
        const std::vector<LocalLight> lights = local_lights(scene.lights);
        cells = LightCells(scene.media, lights, eye, params);
        const double built = cpu_seconds();
        cells.set_eye(eye);
        build.push_back(built - start);
        view.push_back(cpu_seconds() - built);
        local = lights.size();
    }
    std::sort(build.begin(), build.end());
    std::sort(view.begin(), view.end());
    std::printf(
        "%zu lights: build %.1f ms CPU, new camera %.1f ms, %zu cells of %.3f m, "
        "%.1f clusters each, %.1f MB\n",
        local, 1e3 * build[1], 1e3 * view[1], cells.cell_count(), cells.cell_edge(),
        static_cast<double>(cells.entry_count()) /
            static_cast<double>(std::max<size_t>(cells.cell_count(), 1)),
        1e-6 * static_cast<double>(cells.memory_bytes()));
    time_lookups(scene, cells);
    if (points > 0) compare(scene, cells, points);
    std::fflush(stdout);
}

}  // namespace
}  // namespace mote

int main(int argc, char** argv)
{
    using namespace mote;
    if (argc > 1 && std::strstr(argv[1], ".toml")) {
        SceneCache cache;
        PrepareStats stats;
        run(prepare_frame(load_scene(argv[1]), 1, {}, cache, stats), {}, 200);
        return 0;
    }
    Scene scene = plume_scene(argc > 1 ? static_cast<float>(std::atof(argv[1])) : 8.0f,
                              argc > 2 ? static_cast<float>(std::atof(argv[2])) : 0.3f,
                              argc > 3 ? std::max(16, std::atoi(argv[3])) : 128);
    LightCellsParams params;
    if (argc > 4) params.most_clusters = std::atoi(argv[4]);
    const int effort = argc > 5 ? std::atoi(argv[5]) : 1;
    const int most_lights = argc > 6 ? std::atoi(argv[6]) : 1'000'000;
    for (const int count : {1, 100, 1000, 100'000, 1'000'000}) {
        if (count > most_lights) break;
        scatter_lamps(scene, count);
        const int points = count <= 1 || count > 100'000 ? 0 : std::max(16, 100'000 / count);
        run(scene, params, effort * points);
    }
    return 0;
}
