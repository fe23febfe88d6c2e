#include "surfaces/load_mesh.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "core/file_name.h"
#include "core/text.h"

namespace mote {

Mesh load_mesh(const std::string& path)
{
    const std::string extension = lower_extension(path);
    if (extension != ".obj" && extension != ".ply") {
        throw Error(ExitCode::Input, fmt::format("{}: not a mesh that mote reads; export it as "
                                                 ".obj or .ply",
                                                 printable(path)));
    }
    Mesh mesh = extension == ".obj" ? read_obj(path) : read_ply_mesh(path);
    const MeshRepairs repairs = finish_mesh(mesh, path);
    if (repairs.non_finite > 0 || repairs.degenerate > 0) {
        spdlog::warn(
            "{}: left out {} triangles without area and {} with vertices that are not "
            "finite",
            path, repairs.degenerate, repairs.non_finite);
    }
    if (repairs.bad_normals > 0) {
        spdlog::warn("{}: {} normals are not finite; shaded flat there", path, repairs.bad_normals);
    }
    return mesh;
}

}  // namespace mote
