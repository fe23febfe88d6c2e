#include "app/check_inputs.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <tuple>
#include <variant>

#include <fmt/format.h>

#include "core/error.h"
#include "image/read_image.h"
#include "particles/sequence.h"
#include "particles/source_info.h"
#include "render/aov.h"
#include "scene/object_parts.h"
#include "scene/prepare.h"
#include "surfaces/load_mesh.h"
#include "volumes/grid_info.h"

namespace mote {

namespace {

constexpr size_t max_problems = 20;

/// A check under way.
struct Check {
    using Clock = std::chrono::steady_clock;

    const SceneDescription& scene;
    const std::vector<int>& frames;
    Clock::time_point deadline;
    InputReport report;

    [[nodiscard]] bool is_over() const { return report.problems.size() >= max_problems; }

    /// Runs `step` and keeps the message if it throws; false then.
    template <class Step>
    bool keep_message(Step&& step)
    {
        std::vector<std::string>& problems = report.problems;
        try {
            step();
            return true;
        } catch (const Error& error) {
            // The same missing file at many frames (outside = "hold") is one problem.
            if (std::find(problems.begin(), problems.end(), error.what()) == problems.end()) {
                problems.emplace_back(error.what());
            }
            return false;
        }
    }

    std::vector<std::string> shown_files(const SequenceParams& sequence);

    /// Calls open(path, is_first) for the files of a sequence: for the first one always, for the
    /// others while there is time.
    template <class Open>
    void open_files(const SequenceParams& sequence, Open&& open)
    {
        bool is_first = true;
        for (const std::string& file : shown_files(sequence)) {
            if (is_over() || (!is_first && Clock::now() > deadline)) return;
            keep_message([&] { open(file, is_first); });
            ++report.opened_files;
            is_first = false;
        }
    }
};

/// The files that the frames show, each once, all of them there.
std::vector<std::string> Check::shown_files(const SequenceParams& sequence)
{
    std::vector<std::string> files;
    std::set<std::string> known;
    SequenceParams ranged = sequence;
    const bool has_files = keep_message([&] {
        // Once, not for each frame: it may list a folder.
        const auto range = sequence_range(sequence, scene.base_dir);
        if (range) std::tie(ranged.first, ranged.last) = std::pair(range->first, range->last);
    });
    for (const int frame : frames) {
        if (!has_files || is_over()) break;
        keep_message([&] {
            const auto path = resolve_sequence(ranged, frame, scene.base_dir);
            if (path && known.insert(*path).second) files.push_back(*path);
        });
    }
    report.sequence_files += files.size();
    return files;
}

/// Grids that rendering this volume reads must be in the file.
void require_grids(const std::string& path, const VolumeDescription& volume, bool needs_velocity)
{
    const std::vector<GridInfo> held = list_grids(path);
    const auto require = [&](bool is_used, const std::string& name, const char* advice = "") {
        if (is_used) require_grid(path, held, name, advice);
    };
    const Emission& emission = volume.emission;
    require(true, volume.density_grid);
    require(emission.blackbody_scale > 0.0f && !volume.temperature_grid.empty(),
            volume.temperature_grid);
    require(emission.emission_scale > 0.0f, volume.emission_grid);
    require(volume.use_color, volume.color_grid);
    require(needs_velocity && !volume.velocity_grid.empty(), volume.velocity_grid,
            no_velocity_advice);
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

/// Volumes and lights may ask for attributes that a particle file need not have.
void require_attributes(const SceneDescription& scene, const ParticlesDescription& system,
                        const std::string& path, const std::vector<std::string>& attributes,
                        bool needs_velocity)
{
    const auto require = [&](bool is_used, const char* attribute, const char* user) {
        const bool is_there =
            std::find(attributes.begin(), attributes.end(), attribute) != attributes.end();
        if (is_there || !is_used) return;
        throw Error(ExitCode::Input,
                    fmt::format("{}: particles \"{}\" have no {}, which {} needs; name the "
                                "file's attribute under \"attributes\" or do without",
                                path, system.name, attribute, user));
    };
    for (const VolumeDescription& volume : scene.volumes) {
        if (volume.particles != system.name) continue;
        require(volume.use_color, "color", "\"use_color\"");
        require(volume.emission.blackbody_scale > 0.0f, "temperature", "blackbody emission");
        require(needs_velocity, "velocity", "the motion layer");
    }
    for (const LightDescription& light : scene.lights) {
        if (light.particles != system.name) continue;
        require(light.use_color, "color", "\"use_color\"");
        require(light.use_temperature, "temperature", "\"use_temperature\"");
    }
}

/// Names of the attributes of a particle file; empty where there are no particles, or where only
/// they tell.
std::optional<std::vector<std::string>> attributes_of(const std::string& path,
                                                      const CacheParams& cache, double fps,
                                                      bool read_particles)
{
    if (!read_particles) return describe_particle_header(path, cache).attributes;
    const ParticleInfo info = describe_particle_file(path, cache, fps);
    if (info.count == 0) return std::nullopt;
    std::vector<std::string> names;
    for (const AttributeRange& range : info.attributes) names.push_back(range.name);
    return names;
}

/// Reads a material's pictures.
void check_pictures(Check& check, const MaterialFiles& files, const std::string& user)
{
    for (const std::string* file : picture_files(files)) {
        if (file->empty() || check.is_over()) continue;
        check.keep_message([&] {
            const std::string& base_dir = check.scene.base_dir;
            require_file(*file, base_dir, user);
            (void)read_stored_image({(std::filesystem::path(base_dir) / *file).string(), {}});
        });
    }
}

/// Reads a glTF file and its pictures.
void check_gltf(Check& check, const std::string& path)
{
    const GltfScene gltf = load_gltf(path);
    for (const GltfImage& image : gltf.images) {
        check.keep_message([&] { (void)read_stored_image({image.path, image.bytes}); });
    }
}

}  // namespace

InputReport check_inputs(const SceneDescription& scene, const std::vector<int>& frames,
                         double max_seconds)
{
    const auto allowed = std::chrono::duration_cast<Check::Clock::duration>(
        std::chrono::duration<double>(max_seconds));
    Check check{scene, frames, Check::Clock::now() + allowed, {}};
    const bool needs_velocity = parse_aovs(scene.output.aovs).needs_motion();
    for (const ParticlesDescription& system : scene.particles) {
        const auto* cache = std::get_if<CacheParams>(&system.source);
        if (cache == nullptr) continue;
        check.open_files(cache->sequence, [&](const std::string& path, bool is_first) {
            const auto attributes = attributes_of(path, *cache, scene.fps, is_first);
            if (attributes) require_attributes(scene, system, path, *attributes, needs_velocity);
        });
    }
    for (const VolumeDescription& volume : scene.volumes) {
        if (!volume.file) continue;
        check.open_files(*volume.file, [&](const std::string& path, bool) {
            require_grids(path, volume, needs_velocity);
        });
    }
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const LightDescription& light = scene.lights[i];
        if (light.image.empty()) continue;
        check.keep_message([&] {
            require_file(light.image, scene.base_dir, title("light", light.name, i));
            (void)read_image((std::filesystem::path(scene.base_dir) / light.image).string());
        });
    }
    if (!scene.camera.file.path.empty()) {
        check.keep_message([&] {
            const std::string& file = scene.camera.file.path;
            require_file(file, scene.base_dir, "the camera");
            const auto path = std::filesystem::path(scene.base_dir) / file;
            (void)load_gltf(path.string());
        });
    }
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        check_pictures(check, scene.materials[i].files,
                       title("material", scene.materials[i].name, i));
    }
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        const ObjectDescription& object = scene.objects[i];
        check_pictures(check, object.material.files, title("object", object.name, i));
        check.open_files(object.file, [&](const std::string& path, bool) {
            is_gltf(path) ? check_gltf(check, path) : (void)load_mesh(path);
        });
    }
    return check.report;
}

}  // namespace mote
