#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/sweep.h"
#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

constexpr SweepInfo table[] = {
    {SweepKind::Threads, "threads", "threads", "threads", "one thread to all", 1.0, true},
    {SweepKind::Resolution, "resolution", "pixels", "pixels", "80x45 to 1280x720 pixels", 4.0,
     true},
    {SweepKind::Voxels, "voxels", "voxels along an edge", "edge", "128^3 to 1024^3 voxels, sparse",
     4.0, false},
    {SweepKind::Particles, "particles", "particles", "particles", "10^3 to 10^7 particles", 3.0,
     false},
    {SweepKind::Lights, "lights", "lamps", "lamps", "1 to 10^6 lamps", 3.0, false},
    {SweepKind::Empty, "empty", "share of the view without margins", "share",
     "smoke on all of the image to hardly any", 1.0, true},
};

void add_sun_and_sky(SceneDescription& scene)
{
    LightDescription sun;
    sun.kind = LightKind::Distant;
    sun.direction = Vec3(1.0f, 2.0f, 1.0f);
    sun.strength = 3.0f;
    LightDescription sky;
    sky.kind = LightKind::Environment;
    sky.strength = 0.4f;
    scene.lights = {sun, sky};
}

SceneDescription empty_scene()
{
    SceneDescription scene;
    scene.render.width = 160;
    scene.render.height = 90;
    scene.render.path.max_bounces = 1;
    scene.camera.position = Vec3d(0.0, 0.0, 3.0);
    scene.camera.fov = 30.0;
    return scene;
}

/// A puff of 1 m in sun and sky that fills most of the image.
SceneDescription puff_scene()
{
    SceneDescription scene = empty_scene();
    VolumeDescription& smoke = scene.volumes.emplace_back();
    smoke.procedural = ProceduralParams{};
    smoke.density_scale = 12.0f;
    add_sun_and_sky(scene);
    return scene;
}

/// A cloud of particles of about 4 m.
SceneDescription particle_scene(int64_t count, float voxel_size, float radius)
{
    SceneDescription scene = empty_scene();
    scene.camera.position = Vec3d(0.0, 0.0, 6.0);
    ParticlesDescription& burst = scene.particles.emplace_back();
    burst.name = "burst";
    EmitterParams emitter;
    emitter.kind = EmitterKind::Burst;
    emitter.count = count;
    emitter.speed = 3.0f;
    emitter.drag = 2.5f;
    emitter.radius = radius;
    burst.source = emitter;
    burst.voxel_size = voxel_size;
    VolumeDescription& dust = scene.volumes.emplace_back();
    dust.particles = burst.name;
    dust.density_scale = 40.0f;
    add_sun_and_sky(scene);
    return scene;
}

SceneDescription lamp_scene(int count)
{
    SceneDescription scene = puff_scene();
    LightDescription lamps;
    lamps.kind = LightKind::Sphere;
    lamps.count = count;
    lamps.position = Vec3(0.0f);
    lamps.spread = Vec3(2.4f, 1.6f, 1.6f);
    lamps.radius = 0.01f;
    lamps.strength = 3000.0f / static_cast<float>(count);
    scene.lights = {lamps};
    return scene;
}

/// The view widened until what it showed covers this share of its area: margins all around.
SceneDescription widened(SceneDescription scene, double share)
{
    const double tangent = std::tan(0.5 * glm::radians(scene.camera.fov)) / std::sqrt(share);
    scene.camera.fov = glm::degrees(2.0 * std::atan(tangent));
    for (CameraKey& key : scene.camera.keys) key.fov.reset();
    return scene;
}

SceneDescription sized(SceneDescription scene, int width)
{
    scene.render.width = width;
    scene.render.height = width * 9 / 16;
    return scene;
}

}  // namespace

std::span<const SweepInfo> sweep_table()
{
    return table;
}

const SweepInfo& sweep_info(SweepKind kind)
{
    return table[static_cast<size_t>(kind)];
}

std::vector<SweepKind> choose_sweeps(const std::string& list)
{
    std::vector<SweepKind> chosen;
    std::vector<std::string> known{"all"};
    for (const SweepInfo& info : table) known.emplace_back(info.name);
    for (const std::string& name : split_list(list)) {
        bool found = false;
        for (const SweepInfo& info : table) {
            if (name != "all" && name != info.name) continue;
            found = true;
            const bool is_new = std::find(chosen.begin(), chosen.end(), info.kind) == chosen.end();
            if (is_new) chosen.push_back(info.kind);
        }
        if (found) continue;
        throw Error(ExitCode::Usage,
                    fmt::format("no sweep \"{}\"{}; the sweeps are {}", printable(name),
                                did_you_mean(name, known), fmt::join(known, ", ")));
    }
    return chosen;
}

std::vector<SweepSize> sweep_sizes(SweepKind kind, int most_threads,
                                   const std::optional<SceneDescription>& scene)
{
    std::vector<SweepSize> sizes;
    const SceneDescription base = scene ? *scene : puff_scene();
    const SceneDescription large = scene ? *scene : sized(base, 640);  // enough tiles for all
    switch (kind) {
        case SweepKind::Threads:
            for (int n = 1; n < most_threads; n *= 2) sizes.push_back({double(n), n, large});
            sizes.push_back({double(most_threads), most_threads, large});
            break;
        case SweepKind::Resolution:
            for (const int width : {80, 160, 320, 640, 1280}) {
                const SceneDescription s = sized(base, width);
                sizes.push_back({double(s.render.width) * s.render.height, 1, s});
            }
            break;
        case SweepKind::Voxels:
            for (const int edge : {128, 256, 512, 1024}) {
                const float voxel = 4.0f / static_cast<float>(edge);
                sizes.push_back({double(edge), 1, particle_scene(200'000, voxel, 0.012f)});
            }
            break;
        case SweepKind::Particles:
            for (const int64_t n : {1'000, 10'000, 100'000, 1'000'000, 10'000'000}) {
                sizes.push_back({double(n), 1, particle_scene(n, 0.03f, 0.03f)});
            }
            break;
        case SweepKind::Lights:
            for (const int n : {1, 10, 100, 1'000, 10'000, 100'000, 1'000'000}) {
                sizes.push_back({double(n), 1, lamp_scene(n)});
            }
            break;
        case SweepKind::Empty:
            for (const double share : {0.003, 0.01, 0.03, 0.1, 0.3, 1.0}) {
                sizes.push_back({share, 1, widened(base, share)});
            }
            break;
    }
    return sizes;
}

}  // namespace mote
