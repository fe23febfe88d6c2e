#pragma once

#include <string>

#include "surfaces/mesh.h"

namespace mote {

/// Coordinates of vertices in their file reach this far [m]: Embree's products of them stay finite.
/// In the world it is max_world_coordinate.
inline constexpr float max_file_coordinate = 1e9f;

/// One mesh file, told apart by its ending: Wavefront .obj (v, vt, vn, f; materials are the scene's
/// business) or .ply (ascii and binary; x y z, optional nx ny nz and s t or u v, faces of any
/// size). Finished, with what was left out told as a warning. Throws Error(Input) naming the file
/// and, for text, line and column.
[[nodiscard]] Mesh load_mesh(const std::string& path);

/// Tells what finish_mesh left out or mended, if anything.
void warn_of_repairs(const MeshRepairs& repairs, const std::string& file);

/// The readers, one per format; their meshes are not finished yet.
[[nodiscard]] Mesh read_obj(const std::string& path);
[[nodiscard]] Mesh read_ply_mesh(const std::string& path);

}  // namespace mote
