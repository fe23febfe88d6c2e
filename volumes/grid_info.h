#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.h"
#include "volumes/grid_source.h"

namespace mote {

/// One grid of a .vdb file, as its metadata describe it: nothing of the voxels is read. Numbers
/// that the writing program left out are -1.
struct GridInfo {
    std::string name;
    std::string value_type;  ///< "float", "vec3s", "double", "ptdataidx32", ...
    std::string grid_class;  ///< "fog volume", "level set", "staggered" or "unknown"
    int64_t active_voxels = -1;
    Vec3i bbox_lo{0};           ///< of the active voxels, index coordinates
    Vec3i bbox_hi{-1};          ///< less than bbox_lo: not in the file
    int64_t memory_bytes = -1;  ///< of the tree in memory
    Vec3 voxel_size{0.0f};      ///< [m]; 0: the transform is not linear
};

/// The grids of a .vdb file. Throws Error(Input) naming the file if it is missing, damaged or no
/// .vdb file, Error(Memory) if it is over the budget. Cost: a file header, read in a child process
/// first (see core/guarded_child.h).
[[nodiscard]] std::vector<GridInfo> list_grids(const std::string& path,
                                               const GridBudget& budget = {});

/// Throws Error(Input) unless `name` is among the grids `held` by the file at `path`. The message
/// lists what the file holds; `advice`, if any, says what else could be done.
void require_grid(const std::string& path, const std::vector<GridInfo>& held,
                  const std::string& name, const std::string& advice = "");

}  // namespace mote
