#include "app/info_scene.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/image_metadata.h"
#include "app/info_particles.h"
#include "core/text.h"
#include "scene/prepare.h"

namespace mote {

namespace {

/// Edges of a voxel along the grid's axes [m].
Vec3 voxel_size_of(const BrickGrid& grid)
{
    const Mat3 object_from_index = glm::inverse(grid.index_from_object.linear);
    return {glm::length(object_from_index[0]), glm::length(object_from_index[1]),
            glm::length(object_from_index[2])};
}

/// Smallest and largest value that a stored brick holds.
std::pair<float, float> range_of(const BrickGrid& grid)
{
    std::pair<float, float> range{0.0f, 0.0f};
    for (size_t i = 1; i < grid.ranges.size(); ++i) {
        range.first = std::min(range.first, grid.ranges[i].min);
        range.second = std::max(range.second, grid.ranges[i].max);
    }
    return range;
}

std::string grid_line(const char* name, const BrickGrid& grid)
{
    const auto [low, high] = range_of(grid);
    const Bounds3& box = grid.index_bounds;
    const Vec3 voxel = voxel_size_of(grid);
    if (box.is_empty()) return fmt::format("  {:<12} empty\n", name);
    return fmt::format(
        "  {:<12} {:.5g} .. {:.5g}, {} bricks of 8x8x8 voxels in {:.0f}x{:.0f}x{:.0f}, voxel "
        "{:.4g}x{:.4g}x{:.4g} m, {}\n",
        name, low, high, grid.active_bricks(), box.extent().x, box.extent().y, box.extent().z,
        voxel.x, voxel.y, voxel.z, format_bytes(static_cast<double>(grid.memory_bytes())));
}

std::string velocity_line(const ColorGrid& velocity, double fps)
{
    // Per axis: the largest component over the edge of a voxel; a bound of the displacement.
    const Vec3 voxel = voxel_size_of(velocity.channel[0]);
    double voxels = 0.0;
    double fastest = 0.0;
    size_t bytes = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] = range_of(velocity.channel[axis]);
        const auto speed = static_cast<double>(std::max(-low, high));
        fastest = std::max(fastest, speed);
        voxels = std::max(voxels, speed / fps / static_cast<double>(voxel[axis]));
        bytes += velocity.channel[axis].memory_bytes();
    }
    return fmt::format(
        "  {:<12} up to {:.4g} m/s along an axis: largest displacement {:.3g} voxels per frame, "
        "{}\n",
        "velocity", fastest, voxels, format_bytes(static_cast<double>(bytes)));
}

std::string volume_lines(const Volume& volume, double fps)
{
    std::string text = fmt::format("volume \"{}\"\n", printable(volume.name));
    if (volume.density) {
        text += grid_line("density", *volume.density);
        const Vec3 voxel = voxel_size_of(*volume.density);
        text += fmt::format("  {:<12} {:.6g} (density summed over its volume in m^3)\n", "mass",
                            volume.density->sum * static_cast<double>(voxel.x) *
                                static_cast<double>(voxel.y) * static_cast<double>(voxel.z));
    }
    if (volume.temperature) text += grid_line("temperature", *volume.temperature);
    if (volume.emission) text += grid_line("emission", *volume.emission);
    if (volume.color) {
        for (int c = 0; c < 3; ++c) {
            constexpr const char* names[] = {"color.R", "color.G", "color.B"};
            text += grid_line(names[c], volume.color->channel[c]);
        }
    }
    if (volume.velocity) text += velocity_line(*volume.velocity, fps);
    return text;
}

std::string settings_lines(const SceneDescription& scene)
{
    return fmt::format(
        "{}: scene{}, frames {}-{} at {:g} fps\n"
        "image        {}x{}, {} samples per pixel, {} bounces, seed {}, hash {}\n"
        "output       {}, {} layers beside RGBA\n",
        printable(scene.path), scene.name.empty() ? "" : " \"" + printable(scene.name) + "\"",
        scene.first_frame, scene.last_frame, scene.fps, scene.render.width, scene.render.height,
        scene.render.samples, scene.render.path.max_bounces, scene.render.seed,
        scene_hash_text(scene), printable(scene.output.path), scene.output.aovs.size());
}

}  // namespace

std::string describe_scene(const SceneDescription& scene, int frame)
{
    std::string text = settings_lines(scene);
    text += fmt::format("at frame {}:\n", frame);
    for (const ParticlesDescription& system : scene.particles) {
        text += fmt::format("particles \"{}\"\n", printable(system.name));
        const ParticleSet particles = particles_at(system.source, frame, scene.fps, scene.base_dir);
        text += particle_lines(describe_particles(particles), scene.fps, system.voxel_size);
    }
    SceneCache cache;
    PrepareStats stats;
    const Scene prepared = prepare_frame(scene, frame, {true, true}, cache, stats);
    for (const Volume& volume : prepared.media.volumes) text += volume_lines(volume, scene.fps);
    text += fmt::format("lights       {}{}\n", prepared.lights.size(),
                        prepared.environment ? " and an environment" : "");
    if (prepared.surfaces) {
        text += fmt::format("objects      {} with {} meshes, {}; {} of textures\n",
                            prepared.surfaces->objects.size(), stats.meshes_built,
                            format_bytes(static_cast<double>(stats.mesh_bytes)),
                            format_bytes(static_cast<double>(stats.texture_bytes)));
    }
    text +=
        fmt::format("memory       {} of volumes, {} not finite and {} negative values replaced\n",
                    format_bytes(static_cast<double>(stats.brick_bytes)), stats.non_finite_values,
                    stats.negative_values);
    return text;
}

}  // namespace mote
