#pragma once

#include <string>
#include <vector>

#include <openvdb/openvdb.h>

#include "volumes/grid_info.h"

namespace mote {

/// Reads the named grids of a .vdb file, in the order of `names`, each a FloatGrid or a Vec3SGrid
/// (grids of double are converted). Level sets, point grids, integers, masks, frustum transforms
/// and unknown names are refused with a message that lists what the file holds.
/// The file is untrusted: it is read by a child process under limits first, and everything over
/// the budget is refused before any voxel is unpacked. Values are not looked at here; make_bricks
/// replaces NaN, infinities and negative densities.
/// Throws Error(Input) or Error(Memory) naming file and grid. Thread-safe.
[[nodiscard]] openvdb::GridPtrVec read_grids(const std::string& path,
                                             const std::vector<std::string>& names,
                                             const GridBudget& budget = {});

/// One scalar or vector grid; throws Error(Input) if the grid is of the other kind.
[[nodiscard]] openvdb::FloatGrid::Ptr read_float_grid(const std::string& path,
                                                      const std::string& name,
                                                      const GridBudget& budget = {});
[[nodiscard]] openvdb::Vec3SGrid::Ptr read_vec3_grid(const std::string& path,
                                                     const std::string& name,
                                                     const GridBudget& budget = {});

/// Writes grids into a new .vdb file at exactly this path (not atomic: rename it afterwards).
/// Throws Error(Output).
void write_vdb(const std::string& path, const openvdb::GridPtrVec& grids);

}  // namespace mote
