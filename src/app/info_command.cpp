#include <filesystem>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/info_image.h"
#include "app/info_mesh.h"
#include "app/info_particles.h"
#include "app/info_scene.h"
#include "app/info_volume.h"
#include "app/output_pattern.h"
#include "core/error.h"
#include "core/file_name.h"
#include "core/text.h"
#include "particles/source_info.h"
#include "scene/scene_io.h"

namespace mote {

namespace {

/// The file itself, or the one of a pattern at --frame.
std::string chosen_file(const InfoOptions& options)
{
    if (!has_frame_token(options.file) || std::filesystem::exists(options.file)) {
        return options.file;
    }
    if (options.frame) return expand_pattern(options.file, *options.frame);
    throw Error(ExitCode::Usage,
                fmt::format("{} is a pattern; say which file with --frame", options.file));
}

std::string describe_points(const std::string& path, double fps)
{
    return particle_lines(describe_particle_file(path, {}, fps), fps, 0.0f);
}

std::string describe_vdb(const std::string& path, double fps)
{
    const std::vector<GridInfo> grids = list_grids(path);
    std::string text = fmt::format("{}: OpenVDB file, {} grid{}\n", printable(path), grids.size(),
                                   grids.size() == 1 ? "" : "s");
    for (const GridInfo& grid : grids) {
        text += is_point_grid(grid) ? fmt::format("points \"{}\"\n", printable(grid.name)) +
                                          describe_points(path, fps)
                                    : describe_grid(path, grid, fps);
    }
    return text;
}

}  // namespace

void run_info(const InfoOptions& options)
{
    const std::string file = chosen_file(options);
    const std::string extension = lower_extension(file);
    if (extension == ".toml" || extension == ".json") {
        const SceneDescription scene = load_scene(file, options.overrides);
        fmt::print("{}", describe_scene(scene, options.frame.value_or(scene.first_frame)));
    } else if (extension == ".exr") {
        fmt::print("{}", describe_image(file));
    } else if (extension == ".vdb") {
        fmt::print("{}", describe_vdb(file, options.fps));
    } else if (extension == ".obj" || extension == ".gltf" || extension == ".glb" ||
               (extension == ".ply" && is_ply_mesh(file))) {
        fmt::print("{}", describe_mesh_file(file));
    } else if (extension == ".ply" || extension == ".csv" || extension == ".npy") {
        fmt::print("{}: particle file\n{}", printable(file), describe_points(file, options.fps));
    } else {
        throw Error(ExitCode::Input,
                    fmt::format("{}: no kind of file that mote info reads; those are .toml, .json, "
                                ".vdb, .ply, .csv, .npy, .obj, .gltf, .glb and .exr",
                                printable(file)));
    }
}

}  // namespace mote
