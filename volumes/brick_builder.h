#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "volumes/bricks.h"
#include "volumes/grid_source.h"

namespace mote {

/// What is known of a voxel source before its bricks are filled, in blocks of 8^3 voxels aligned
/// to multiples of 8. Block (x, y, z) covers the same index coordinates as the brick's own cells.
struct BlockTable {
    static constexpr float varied = std::numeric_limits<float>::quiet_NaN();

    Vec3i lo{0};                  ///< index coordinate of the first voxel of block (0,0,0)
    Vec3i count{0};               ///< blocks along x, y, z; no non-zero voxel lies outside
    std::vector<uint8_t> needed;  ///< brick here has a non-zero value among its 9^3
    std::vector<float> uniform;   ///< the one value of all the block's voxels, or `varied`

    /// Empty table for voxels lo..hi (inclusive), with room for the cells below `lo`. Throws
    /// Error(Memory) naming `what` if the table alone would be over the budget.
    static BlockTable covering(Vec3i voxel_lo, Vec3i voxel_hi, const GridBudget& budget,
                               const std::string& what);

    [[nodiscard]] size_t index(int x, int y, int z) const
    {
        return (static_cast<size_t>(z) * static_cast<size_t>(count.y) + static_cast<size_t>(y)) *
                   static_cast<size_t>(count.x) +
               static_cast<size_t>(x);
    }

    /// Marks the bricks that non-zero voxels of block (x, y, z) reach. Bit dx + 2 dy + 4 dz of
    /// `faces`: there is one with local coordinate 0 in each axis whose d is 1 (bit 0: any).
    void mark(int x, int y, int z, unsigned faces);
};

/// Writes the 9^3 values (z fastest) of the brick whose first voxel has index coordinate `origin`.
using FillBrick = std::function<void(Vec3i origin, float* values)>;

/// Numbers the needed bricks in table order, fills them in parallel, and derives ranges, skip
/// distances and bounds. Bricks of one value share storage. Bit-identical for any thread count.
/// Throws Error(Memory) naming `what` if the bricks would be over the budget.
[[nodiscard]] BrickGrid build_bricks(const BlockTable& blocks, const FillBrick& fill,
                                     const GridBudget& budget, const std::string& what);

}  // namespace mote
