#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "core/transform.h"

namespace mote {

/// Minimum, maximum and mean of the trilinear reconstruction's corner values over one brick.
struct BrickRange {
    float min = 0.0f;
    float max = 0.0f;
    float mean = 0.0f;
};

/// Render-time form of a sparse scalar grid: bricks of 8^3 cells stored with a one-voxel apron on
/// the high side (9^3 values), found through a flat table. Voxel values sit at integer index
/// coordinates; a cell is the cube between eight voxels. Values outside the bricks are 0.
struct BrickGrid {
    static constexpr int brick_size = 8;    ///< cells per edge
    static constexpr int brick_stride = 9;  ///< stored values per edge
    static constexpr int brick_values = 736;  ///< 9^3 = 729, padded to whole vectors

    Vec3i lo{0};          ///< index coordinate of the first cell, a multiple of 8
    Vec3i brick_count{0}; ///< bricks along x, y, z
    std::vector<int32_t> table;       ///< brick number per table cell, x fastest; 0 = empty
    std::vector<float> values;        ///< brick_values per brick; brick 0 is all zeros
    std::vector<BrickRange> ranges;   ///< per brick
    Affine index_from_object;         ///< object space [m] -> index space
    Bounds3 index_bounds;             ///< where the reconstruction may be non-zero; empty: nowhere
    float max_value = 0.0f;
    double sum = 0.0;                 ///< of all voxel values

    [[nodiscard]] size_t active_bricks() const { return ranges.empty() ? 0 : ranges.size() - 1; }
    [[nodiscard]] size_t memory_bytes() const;
};

/// The same for three channels (velocity, colour); used by lookups only.
struct ColorGrid {
    BrickGrid channel[3];  ///< same table layout in all three
};

/// Trilinear reconstruction at an index-space point; 0 outside and for non-finite points.
[[nodiscard]] float sample_trilinear(const BrickGrid& grid, Vec3 p_index);

}  // namespace mote
