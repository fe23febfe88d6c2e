#include "scene/prepare.h"

#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "core/text.h"
#include "image/read_image.h"
#include "particles/sequence.h"
#include "scene/gltf_camera.h"
#include "scene/grid_cache.h"
#include "scene/particle_lights.h"
#include "scene/particle_system.h"
#include "scene/prepare_camera.h"
#include "scene/prepare_lights.h"
#include "scene/prepare_surfaces.h"
#include "scene/prepare_volumes.h"
#include "volumes/grid_info.h"

namespace mote {
namespace {

namespace fs = std::filesystem;

/// "volume "smoke"" or "volume 2" for messages.
std::string title_of(const VolumeDescription& volume, size_t index)
{
    return volume.name.empty() ? fmt::format("volume {}", index)
                               : fmt::format("volume \"{}\"", volume.name);
}

/// Extinctions beyond this are refused: optical depths, their sums over cells, would overflow.
constexpr double largest_sigma_t = 1e30;

void require_finite_extinction(const Volume& volume)
{
    if (!volume.density) return;
    const double sigma_t =
        static_cast<double>(volume.density_scale) * static_cast<double>(volume.density->max_value);
    if (sigma_t <= largest_sigma_t) return;
    throw Error(ExitCode::Input,
                fmt::format("{}: densities of up to {:g} times density_scale = {:g} are an "
                            "extinction over {:g} per metre; mend the densities or lower "
                            "density_scale",
                            printable(volume.name), volume.density->max_value, volume.density_scale,
                            largest_sigma_t));
}

struct Preparation {
    const SceneDescription& description;
    int frame;
    const PrepareNeeds& needs;
    SceneCache::Impl& cache;
    PrepareStats& stats;

    [[nodiscard]] double open() const { return frame + description.camera.shutter_open; }
    [[nodiscard]] double close() const { return frame + description.camera.shutter_close; }

    /// Grids beyond density that a volume's look and the renderer ask for.
    [[nodiscard]] std::vector<PlannedGrid> wanted_grids(const VolumeDescription& volume) const
    {
        std::vector<PlannedGrid> grids{{GridRole::Density, volume.density_grid}};
        if (volume.emission.blackbody_scale > 0.0f && !volume.temperature_grid.empty()) {
            grids.push_back({GridRole::Temperature, volume.temperature_grid});
        }
        if (volume.emission.emission_scale > 0.0f) {
            grids.push_back({GridRole::Emission, volume.emission_grid});
        }
        if (volume.use_color) grids.push_back({GridRole::Color, volume.color_grid});
        if (needs.velocity && !volume.velocity_grid.empty()) {
            grids.push_back({GridRole::Velocity, volume.velocity_grid});
        }
        return grids;
    }

    [[nodiscard]] std::optional<GridPlan> plan(const VolumeDescription& volume, size_t index) const;
    [[nodiscard]] std::optional<GridPlan> plan_file(const VolumeDescription& volume) const;
    [[nodiscard]] GridPlan plan_particles(const VolumeDescription& volume) const;
    [[nodiscard]] GridPlan plan_procedural(const VolumeDescription& volume, size_t index) const;
    [[nodiscard]] Volume make_volume(const VolumeDescription& volume, size_t index,
                                     const GridPlan& plan) const;
    [[nodiscard]] Camera camera_over(double from, double to) const
    {
        if (!description.camera.file.path.empty()) {
            return make_gltf_camera(description, cache.gltfs, from, to);
        }
        return make_camera(description.camera, description.render, from, to);
    }
    void add_environment(Scene& scene) const;
    void add_next_frame(Scene& scene, const std::vector<size_t>& shown) const;
};

std::optional<GridPlan> Preparation::plan_file(const VolumeDescription& volume) const
{
    const auto path = resolve_sequence(*volume.file, frame, description.base_dir);
    if (!path) return std::nullopt;
    GridPlan plan{FilePlan{*path}, file_version(*path), wanted_grids(volume)};
    // The velocity is the last of the wanted grids.
    if (plan.grids.back().role == GridRole::Velocity) {
        const std::vector<GridInfo> held = list_grids(*path);
        const std::string& name = plan.grids.back().name;
        const bool is_held = std::any_of(held.begin(), held.end(),
                                         [&](const GridInfo& grid) { return grid.name == name; });
        if (!is_held && needs.velocity_may_be_missing) {
            plan.grids.pop_back();
        } else {
            require_grid(*path, held, name, no_velocity_advice);
        }
    }
    return plan;
}

/// Volumes that show the same system share one rasterisation with all channels that any needs.
GridPlan Preparation::plan_particles(const VolumeDescription& volume) const
{
    const ParticlesDescription& system = find_system(description, volume.particles);
    ParticlesPlan particles{&system};
    particles.shutter_open_s =
        static_cast<float>(description.camera.shutter_open / description.fps);
    particles.shutter_close_s =
        static_cast<float>(description.camera.shutter_close / description.fps);
    GridPlan plan{particles, "", {{GridRole::Density, "density"}}};
    bool has_temperature = false;
    bool has_color = false;
    for (const VolumeDescription& other : description.volumes) {
        if (other.particles != volume.particles) continue;
        has_temperature |= other.emission.blackbody_scale > 0.0f;
        has_color |= other.use_color;
    }
    if (has_temperature) plan.grids.push_back({GridRole::Temperature, "temperature"});
    if (has_color) plan.grids.push_back({GridRole::Color, "Cd"});
    if (needs.velocity) plan.grids.push_back({GridRole::Velocity, "velocity"});
    plan.version =
        fmt::format("particles {} {} {} {} {}{}{}",
                    source_version(system.source, frame, description.fps, description.base_dir),
                    system.voxel_size, particles.shutter_open_s, particles.shutter_close_s,
                    has_temperature, has_color, needs.velocity);
    return plan;
}

GridPlan Preparation::plan_procedural(const VolumeDescription& volume, size_t index) const
{
    const ProceduralParams& p = *volume.procedural;
    const double time = p.evolve == 0.0f ? 0.0 : frame / description.fps;
    if (volume.use_color) {
        throw Error(ExitCode::Input, fmt::format("{}: \"use_color\" needs particles or a file; a "
                                                 "procedural has no colours",
                                                 title_of(volume, index)));
    }
    if (volume.emission.blackbody_scale > 0.0f && volume.emission.temperature_offset <= 0.0f) {
        throw Error(ExitCode::Input, fmt::format("{}: a procedural has no temperature grid; set "
                                                 "emission.temperature_offset [K]",
                                                 title_of(volume, index)));
    }
    return {ProceduralPlan{p, time},
            fmt::format("procedural {} {} {} {} {} {} {} {} {}", static_cast<int>(p.kind), p.size.x,
                        p.size.y, p.size.z, p.voxel_size, p.noise, p.seed, p.evolve, time),
            {{GridRole::Density, "density"}}};
}

std::optional<GridPlan> Preparation::plan(const VolumeDescription& volume, size_t index) const
{
    if (volume.file) return plan_file(volume);
    if (volume.procedural) return plan_procedural(volume, index);
    return plan_particles(volume);
}

Volume Preparation::make_volume(const VolumeDescription& from, size_t index,
                                const GridPlan& plan) const
{
    Volume volume;
    volume.name = from.name.empty() ? fmt::format("volume {}", index) : from.name;
    for (const PlannedGrid& grid : plan.grids) {
        const auto cached = cache.grids.find(plan.key(grid));
        if (cached == cache.grids.end()) continue;
        switch (grid.role) {
            case GridRole::Density:
                volume.density = cached->second.scalar;
                break;
            case GridRole::Temperature:
                volume.temperature = cached->second.scalar;
                break;
            case GridRole::Emission:
                volume.emission = cached->second.scalar;
                break;
            case GridRole::Color:
                if (from.use_color) volume.color = cached->second.vector;
                break;
            case GridRole::Velocity:
                volume.velocity = cached->second.vector;
                break;
        }
    }
    // Particles and procedurals have no grid of their own for it: they glow where they are dense.
    if (from.emission.emission_scale > 0.0f && !from.file) volume.emission = volume.density;
    if (from.emission.blackbody_scale <= 0.0f) volume.temperature = nullptr;
    volume.density_scale = from.density_scale;
    require_finite_extinction(volume);
    volume.albedo = from.albedo;
    volume.phase = from.phase;
    volume.emission_params = from.emission;
    volume.world_from_object = over_shutter(from.transform, open(), close());
    finalize(volume);
    return volume;
}

void Preparation::add_environment(Scene& scene) const
{
    for (const LightDescription& light : description.lights) {
        if (light.kind != LightKind::Environment) continue;
        EnvironmentLight environment;
        const double middle = 0.5 * (open() + close());
        environment.radiance = brightness_at(light, middle);
        environment.map_from_world = map_from_world(light, middle);
        if (!light.image.empty()) {
            const std::string path = (fs::path(description.base_dir) / light.image).string();
            std::shared_ptr<const EnvironmentMap>& map = cache.environments[file_version(path)];
            if (!map) map = make_environment_map(read_image(path), path);
            environment.map = map;
        }
        if (max_component(environment.radiance) > 0.0f) scene.environment = environment;
    }
}

void Preparation::add_next_frame(Scene& scene, const std::vector<size_t>& shown) const
{
    NextFrame next;
    next.camera = camera_over(open() + 1.0, close() + 1.0);
    for (const size_t index : shown) {
        next.world_from_object.push_back(
            over_shutter(description.volumes[index].transform, open() + 1.0, close() + 1.0));
    }
    scene.next = std::move(next);
}

size_t memory_of(const SceneCache::Impl& cache)
{
    size_t bytes = 0;
    for (const auto& [key, grid] : cache.grids) {
        if (grid.scalar) bytes += grid.scalar->memory_bytes();
        if (!grid.vector) continue;
        for (const BrickGrid& channel : grid.vector->channel) bytes += channel.memory_bytes();
    }
    return bytes;
}

void warn_if_dark(const Scene& scene)
{
    bool emits = false;
    for (const Volume& volume : scene.media.volumes) emits |= volume.emission_params.is_on();
    if (emits || !scene.lights.empty() || scene.environment) return;
    spdlog::warn("nothing gives light: add a [[lights]] entry, e.g. type = \"environment\"");
}

}  // namespace

std::string file_version(const std::string& path)
{
    std::error_code error;
    const auto size = fs::file_size(path, error);
    if (error) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: cannot be read ({})", printable(path), error.message()));
    }
    const auto time = fs::last_write_time(path, error).time_since_epoch().count();
    return fmt::format("file {} {} {}", path, size, time);
}

SceneCache::SceneCache() : impl_(std::make_unique<Impl>()) {}
SceneCache::~SceneCache() = default;

Scene prepare_frame(const SceneDescription& description, int frame, const PrepareNeeds& needs,
                    SceneCache& cache, PrepareStats& stats)
{
    const Preparation prepare{description, frame, needs, cache.impl(), stats};
    std::vector<GridPlan> plans;
    std::vector<size_t> shown;
    std::set<std::string> wanted;
    for (size_t i = 0; i < description.volumes.size(); ++i) {
        std::optional<GridPlan> plan = prepare.plan(description.volumes[i], i);
        if (!plan) continue;  // hidden outside its sequence
        for (const PlannedGrid& grid : plan->grids) wanted.insert(plan->key(grid));
        plans.push_back(std::move(*plan));
        shown.push_back(i);
    }
    cache.impl().keep_only(wanted);

    Scene scene;
    scene.camera = prepare.camera_over(prepare.open(), prepare.close());
    const PlanContext context{frame, description.fps, description.base_dir};
    for (size_t i = 0; i < plans.size(); ++i) {
        build_grids(plans[i], context, cache.impl(), stats);
        scene.media.volumes.push_back(
            prepare.make_volume(description.volumes[shown[i]], shown[i], plans[i]));
    }
    scene.lights = make_lights(description.lights, 0.5 * (prepare.open() + prepare.close()));
    prepare.add_environment(scene);
    scene.frame = frame;
    scene.fps = description.fps;
    scene.shutter_open = description.camera.shutter_open;
    scene.shutter_close = description.camera.shutter_close;
    if (needs.velocity) prepare.add_next_frame(scene, shown);
    prepare_surfaces(description, {frame, prepare.open(), prepare.close()}, cache.impl(), stats,
                     scene);
    // Last, so that others keep their place where particles come and go.
    add_particle_lights(description, 0.5 * (prepare.open() + prepare.close()), stats, scene.lights);
    stats.brick_bytes = memory_of(cache.impl());
    warn_if_dark(scene);
    return scene;
}

}  // namespace mote
