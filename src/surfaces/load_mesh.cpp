#include "surfaces/load_mesh.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "core/file_name.h"
#include "core/text.h"

namespace mote {

void warn_of_repairs(const MeshRepairs& repairs, const std::string& file)
{
    if (repairs.non_finite > 0 || repairs.degenerate > 0) {
        spdlog::warn(
            "{}: left out {} triangles without area and {} with vertices that are not "
            "finite",
            file, repairs.degenerate, repairs.non_finite);
    }
    if (repairs.bad_normals > 0) {
        spdlog::warn("{}: {} normals are not finite; shaded flat there", file, repairs.bad_normals);
    }
    if (repairs.bad_uvs > 0) {
        spdlog::warn("{}: {} texture coordinates are not finite; taken as 0", file,
                     repairs.bad_uvs);
    }
}

Mesh load_mesh(const std::string& path)
{
    const std::string extension = lower_extension(path);
    if (extension != ".obj" && extension != ".ply") {
        throw Error(ExitCode::Input, fmt::format("{}: not a mesh that mote reads; export it as "
                                                 ".obj, .ply, .gltf or .glb",
                                                 printable(path)));
    }
    Mesh mesh = extension == ".obj" ? read_obj(path) : read_ply_mesh(path);
    const MeshRepairs repairs = finish_mesh(mesh, path);
    warn_of_repairs(repairs, path);
    return mesh;
}

}  // namespace mote
