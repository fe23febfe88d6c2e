#include "app/check_inputs.h"

#include <algorithm>
#include <filesystem>
#include <variant>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "image/read_image.h"
#include "particles/sequence.h"
#include "particles/source_info.h"
#include "render/aov.h"
#include "volumes/grid_info.h"

namespace mote {

namespace {

constexpr size_t max_problems = 20;

/// Runs `check` and keeps the message if it throws; false then.
template <class Check>
bool keep_message(std::vector<std::string>& problems, Check&& check)
{
    try {
        check();
        return true;
    } catch (const Error& error) {
        // The same missing file at many frames (outside = "hold") is one problem.
        if (std::find(problems.begin(), problems.end(), error.what()) == problems.end()) {
            problems.emplace_back(error.what());
        }
        return false;
    }
}

/// The file of the first frame that shows one, with all others checked for being there.
std::string check_sequence(const SequenceParams& sequence, const std::vector<int>& frames,
                           const std::string& base_dir, std::vector<std::string>& problems)
{
    std::string first;
    for (const int frame : frames) {
        if (problems.size() >= max_problems) break;
        const bool good = keep_message(problems, [&] {
            const auto path = resolve_sequence(sequence, frame, base_dir);
            if (path && first.empty()) first = *path;
        });
        // A sequence without any file fails alike at every frame.
        if (!good && first.empty()) break;
    }
    return first;
}

/// Names of the grids that rendering this volume reads.
std::vector<std::string> needed_grids(const VolumeDescription& volume, bool needs_velocity)
{
    std::vector<std::string> names{volume.density_grid};
    if (volume.emission.blackbody_scale > 0.0f) names.push_back(volume.temperature_grid);
    if (volume.emission.emission_scale > 0.0f) names.push_back(volume.emission_grid);
    if (volume.use_color) names.push_back(volume.color_grid);
    if (needs_velocity) names.push_back(volume.velocity_grid);
    return names;
}

void require_grids(const std::string& path, const std::vector<std::string>& needed)
{
    std::vector<std::string> held;
    for (const GridInfo& grid : list_grids(path)) held.push_back(grid.name);
    for (const std::string& name : needed) {
        if (std::find(held.begin(), held.end(), name) != held.end()) continue;
        throw Error(
            ExitCode::Input,
            fmt::format(
                "{}: no grid \"{}\"{}; the file holds {}", path, printable(name),
                did_you_mean(name, held),
                held.empty() ? "none" : printable(fmt::format("{}", fmt::join(held, ", ")))));
    }
}

void require_file(const std::string& file, const std::string& base_dir, const std::string& user)
{
    const auto path = std::filesystem::path(base_dir) / file;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored)) return;
    throw Error(ExitCode::Input, fmt::format("{}: no such file, used by {}", path.string(), user));
}

/// "light \"sun\"" or "light 2" for messages.
std::string title(const char* kind, const std::string& name, size_t index)
{
    return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} \"{}\"", kind, name);
}

/// Volumes may ask for attributes that a particle file need not have.
void require_attributes(const SceneDescription& scene, const ParticlesDescription& system,
                        const std::string& path, const ParticleInfo& info, bool needs_velocity)
{
    const auto require = [&](const char* attribute, const char* user) {
        for (const AttributeRange& range : info.attributes) {
            if (range.name == attribute) return;
        }
        throw Error(ExitCode::Input,
                    fmt::format("{}: particles \"{}\" have no {}, which {} needs; name the "
                                "file's attribute under \"attributes\" or do without",
                                path, system.name, attribute, user));
    };
    if (info.count == 0) return;
    for (const VolumeDescription& volume : scene.volumes) {
        if (volume.particles != system.name) continue;
        if (volume.use_color) require("color", "\"use_color\"");
        if (volume.emission.blackbody_scale > 0.0f) require("temperature", "blackbody emission");
        if (needs_velocity) require("velocity", "the motion layer");
    }
}

}  // namespace

std::vector<std::string> check_inputs(const SceneDescription& scene, const std::vector<int>& frames)
{
    std::vector<std::string> problems;
    const bool needs_velocity = parse_aovs(scene.output.aovs).needs_motion();
    for (const ParticlesDescription& system : scene.particles) {
        const auto* cache = std::get_if<CacheParams>(&system.source);
        if (cache == nullptr) continue;
        const std::string first = check_sequence(cache->sequence, frames, scene.base_dir, problems);
        if (first.empty()) continue;
        keep_message(problems, [&] {
            const ParticleInfo info = describe_particle_file(first, *cache, scene.fps);
            require_attributes(scene, system, first, info, needs_velocity);
        });
    }
    for (const VolumeDescription& volume : scene.volumes) {
        if (!volume.file) continue;
        const std::string first = check_sequence(*volume.file, frames, scene.base_dir, problems);
        if (first.empty()) continue;
        keep_message(problems, [&] { require_grids(first, needed_grids(volume, needs_velocity)); });
    }
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const LightDescription& light = scene.lights[i];
        if (light.image.empty()) continue;
        keep_message(problems, [&] {
            require_file(light.image, scene.base_dir, title("light", light.name, i));
            (void)read_image((std::filesystem::path(scene.base_dir) / light.image).string());
        });
    }
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        const MeshDescription& mesh = scene.meshes[i];
        keep_message(problems,
                     [&] { require_file(mesh.file, scene.base_dir, title("mesh", mesh.name, i)); });
    }
    return problems;
}

}  // namespace mote
