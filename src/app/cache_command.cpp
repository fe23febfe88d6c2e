#include <algorithm>
#include <filesystem>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "app/cache_writer.h"
#include "app/commands.h"
#include "app/frame_files.h"
#include "app/frame_range.h"
#include "app/output_pattern.h"
#include "app/progress.h"
#include "app/scene_options.h"
#include "app/signals.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "scene/scene_io.h"
#include "volumes/grid_info.h"

namespace mote {

namespace {

/// Where particles come from, from a scene or from files named on the command line.
struct CacheInput {
    SourceParams source;
    std::string base_dir;
    double fps = 24.0;
    float voxel_size = 0.02f;
    std::vector<int> frames;
};

bool is_scene(const std::string& path)
{
    const auto extension = std::filesystem::path(path).extension();
    return extension == ".toml" || extension == ".json";
}

const ParticlesDescription& chosen_system(const SceneDescription& scene, const std::string& name)
{
    std::vector<std::string> names;
    for (const ParticlesDescription& system : scene.particles) {
        if (system.name == name || (name.empty() && scene.particles.size() == 1)) return system;
        names.push_back(system.name);
    }
    if (names.empty()) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: the scene has no particle systems", scene.path));
    }
    if (name.empty()) {
        throw Error(ExitCode::Usage, fmt::format("{} has several particle systems ({}); choose one "
                                                 "with --particles",
                                                 scene.path, fmt::join(names, ", ")));
    }
    throw Error(ExitCode::Input, fmt::format("{}: no particle system \"{}\"{}", scene.path,
                                             printable(name), did_you_mean(name, names)));
}

CacheInput input_of_scene(const CacheOptions& options)
{
    const SceneDescription scene = load_scene(options.input, options.overrides);
    const ParticlesDescription& system = chosen_system(scene, options.particles);
    return {system.source, scene.base_dir, scene.fps,
            options.voxel_size.value_or(system.voxel_size), chosen_frames(options.frames, scene)};
}

CacheInput input_of_files(const CacheOptions& options)
{
    CacheParams cache;
    cache.sequence.pattern = options.input;
    if (options.velocity_per_frame) cache.velocity_unit = VelocityUnit::PerFrame;
    for (const std::string& pair : options.attributes) {
        const size_t equals = pair.find('=');
        if (equals == std::string::npos) {
            throw Error(ExitCode::Usage,
                        fmt::format("--attribute \"{}\": write for example radius=pscale",
                                    printable(pair)));
        }
        cache.attributes[pair.substr(0, equals)] = pair.substr(equals + 1);
    }
    CacheInput input{cache, "", options.fps, options.voxel_size.value_or(0.02f), {1}};
    if (!options.frames.empty()) {
        input.frames = parse_frames(options.frames);
    } else if (const auto range = sequence_range(cache.sequence, "")) {
        input.frames = parse_frames(fmt::format("{}-{}", range->first, range->last));
    }
    return input;
}

/// Says which frames are copies of another because the source's files end before.
void warn_of_held_frames(const CacheInput& input)
{
    const auto* cache = std::get_if<CacheParams>(&input.source);
    if (cache == nullptr || cache->sequence.outside != OutsideRange::Hold) return;
    const auto range = sequence_range(cache->sequence, input.base_dir);
    if (!range) return;
    const int64_t first = int64_t{range->first} - cache->sequence.offset;
    const int64_t last = int64_t{range->last} - cache->sequence.offset;
    std::vector<int> held;
    for (const int frame : input.frames) {
        if (frame < first || frame > last) held.push_back(frame);
    }
    if (held.empty()) return;
    spdlog::warn(
        "{}: has files for frames {} to {}; frames {} repeat the nearest of them, choose others "
        "with --frames",
        printable(cache->sequence.pattern), first, last, printable(format_frames(held)));
}

GridChannels channels_of(const std::string& list)
{
    GridChannels channels;
    constexpr const char* separators = ", ";
    for (size_t begin = list.find_first_not_of(separators); begin != std::string::npos;) {
        const size_t end = std::min(list.find_first_of(separators, begin), list.size());
        const std::string word = list.substr(begin, end - begin);
        if (word == "velocity") {
            channels.velocity = true;
        } else if (word == "temperature") {
            channels.temperature = true;
        } else if (word == "color") {
            channels.color = true;
        } else if (word != "density") {
            throw Error(ExitCode::Usage,
                        fmt::format("--channels: \"{}\" is none of velocity, temperature, color",
                                    printable(word)));
        }
        begin = list.find_first_not_of(separators, end);
    }
    return channels;
}

/// Files of one frame; empty: not asked for.
struct CacheFiles {
    std::string points;
    std::string grids;
};

std::vector<CacheFiles> cache_files(const CacheOptions& options, const std::vector<int>& frames)
{
    std::vector<CacheFiles> files(frames.size());
    const auto fill = [&](const std::string& pattern, const char* option, auto member) {
        if (pattern.empty()) return;
        if (std::filesystem::path(pattern).extension() != ".vdb") {
            throw Error(ExitCode::Usage,
                        fmt::format("{} \"{}\" must end in .vdb", option, printable(pattern)));
        }
        const auto paths = expand_pattern(pattern, frames, option);
        for (size_t i = 0; i < paths.size(); ++i) files[i].*member = paths[i];
        require_writable_folder(paths.front());
    };
    fill(options.points, "--points", &CacheFiles::points);
    fill(options.grids, "--grids", &CacheFiles::grids);
    if (options.points.empty() && options.grids.empty()) {
        throw Error(ExitCode::Usage, "nothing to write: give --points, --grids or both");
    }
    if (options.points == options.grids) {
        throw Error(ExitCode::Usage, "--points and --grids name the same files");
    }
    return files;
}

/// Whether the file is there and opens; files are written atomically, so that is all of it.
bool is_good(const std::string& path)
{
    try {
        return path.empty() || !list_grids(path).empty();
    } catch (const Error&) {
        return false;
    }
}

void write_frame(const CacheInput& input, int frame, const CacheFiles& files,
                 const GridChannels& channels)
{
    const ParticleSet particles = particles_at(input.source, frame, input.fps, input.base_dir);
    if (!files.points.empty()) write_point_file(files.points, particles);
    if (!files.grids.empty()) write_grid_file(files.grids, particles, input.voxel_size, channels);
    spdlog::info("frame {}: {} particles written", frame, particles.size());
}

}  // namespace

void run_cache(const CacheOptions& options)
{
    const StopSignals signals;  // before anything starts a thread
    const GridChannels channels = channels_of(options.channels);
    const CacheInput input =
        is_scene(options.input) ? input_of_scene(options) : input_of_files(options);
    const std::vector<CacheFiles> files = cache_files(options, input.frames);
    warn_of_held_frames(input);
    Progress progress(progress_style(options.progress, options.log.quiet),
                      static_cast<int>(input.frames.size()), stderr_terminal());
    run_with_threads(chosen_threads(options.threads), [&] {
        for (size_t i = 0; i < input.frames.size(); ++i) {
            const int frame = input.frames[i];
            const std::string& shown = files[i].points.empty() ? files[i].grids : files[i].points;
            if (stop_requested()) {
                throw Error(ExitCode::Interrupted,
                            fmt::format("stopped before frame {}; --existing skip goes on from "
                                        "here",
                                        frame));
            }
            if (options.existing == ExistingMode::Skip && is_good(files[i].points) &&
                is_good(files[i].grids)) {
                progress.skip_frame(frame, shown);
                continue;
            }
            progress.begin_frame(frame, 1);
            write_frame(input, frame, files[i], channels);
            progress.end_frame(shown);
        }
    });
    progress.finish(false);
}

}  // namespace mote
