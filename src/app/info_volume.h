#pragma once

#include <string>

#include "volumes/grid_info.h"

namespace mote {

/// Lines on one grid of a .vdb file: what its metadata say and, for scalar and vector grids, the
/// range of its values; for grids called velocity, vel or v [m/s] also the largest displacement per
/// frame in voxels. Reads the grid. Throws as read_grids.
[[nodiscard]] std::string describe_grid(const std::string& path, const GridInfo& grid, double fps);

/// Whether the grid holds points, which the particle readers describe.
[[nodiscard]] bool is_point_grid(const GridInfo& grid);

}  // namespace mote
