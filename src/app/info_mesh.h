#pragma once

#include <string>

namespace mote {

/// Lines on a mesh or glTF file: triangles, bounds, texture coordinates; materials, nodes, cameras
/// and animations. Throws Error(Input) naming the file.
[[nodiscard]] std::string describe_mesh_file(const std::string& path);

/// Whether a .ply file holds faces rather than particles alone. Throws Error(Input).
[[nodiscard]] bool is_ply_mesh(const std::string& path);

}  // namespace mote
