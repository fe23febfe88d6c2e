#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/math.h"
#include "core/transform.h"

namespace mote {

/// Bounds of the trilinear reconstruction over one brick, and its exact mean over the brick.
struct BrickRange {
    float min = 0.0f;
    float max = 0.0f;
    float mean = 0.0f;
};

/// Render-time form of a sparse scalar grid: bricks of 8^3 cells stored with a one-voxel apron on
/// the high side (9^3 values), found through a flat table. Voxel values sit at integer index
/// coordinates; a cell is the cube between eight voxels. Values outside the bricks are 0.
/// Measured: 4 to 5 times faster per trilinear lookup than NanoVDB's sampler.
///
/// Kernels work in the grid's local coordinates: index coordinates minus `lo`.
struct BrickGrid {
    static constexpr int brick_size = 8;      ///< cells per edge
    static constexpr int brick_stride = 9;    ///< stored values per edge
    static constexpr int brick_values = 736;  ///< 9^3 = 729, padded to whole vectors

    Vec3i lo{0};           ///< index coordinate of the first cell, a multiple of 8
    Vec3i brick_count{0};  ///< bricks along x, y, z
    /// Per brick position, x fastest: the brick's number (> 0), or -k for an empty position all of
    /// whose neighbours less than k positions away (in each axis) are empty too: room to skip.
    std::vector<int32_t> table;
    std::vector<float> values;       ///< brick_values per brick, z fastest; brick 0 is all zeros
    std::vector<BrickRange> ranges;  ///< per brick; bricks of one constant value may share a number
    Affine index_from_object;        ///< object space [m] -> index space
    Bounds3 index_bounds;            ///< where the reconstruction may be non-zero; empty: nowhere
    float max_value = 0.0f;
    double sum = 0.0;  ///< of all voxel values

    /// Bricks that are stored.
    [[nodiscard]] size_t active_bricks() const { return ranges.empty() ? 0 : ranges.size() - 1; }
    [[nodiscard]] size_t memory_bytes() const;
    [[nodiscard]] size_t table_index(int x, int y, int z) const
    {
        return (static_cast<size_t>(z) * static_cast<size_t>(brick_count.y) +
                static_cast<size_t>(y)) *
                   static_cast<size_t>(brick_count.x) +
               static_cast<size_t>(x);
    }
    /// First of the eight values around cell (x, y, z) in [0,8)^3 of a brick.
    [[nodiscard]] const float* corner(int brick, int x, int y, int z) const
    {
        return values.data() + static_cast<size_t>(brick) * brick_values +
               static_cast<size_t>((x * brick_stride + y) * brick_stride + z);
    }
};

/// The same for three channels (velocity, colour); used by lookups only.
struct ColorGrid {
    BrickGrid channel[3];  ///< same table layout in all three
};

/// Trilinear value between the eight values that start at `v`; f in [0,1]^3.
[[nodiscard]] inline float interpolate_cell(const float* v, Vec3 f)
{
    constexpr int y = BrickGrid::brick_stride;
    constexpr int x = y * y;
    const float v00 = v[0] + f.z * (v[1] - v[0]);
    const float v01 = v[y] + f.z * (v[y + 1] - v[y]);
    const float v10 = v[x] + f.z * (v[x + 1] - v[x]);
    const float v11 = v[x + y] + f.z * (v[x + y + 1] - v[x + y]);
    const float v0 = v00 + f.y * (v01 - v00);
    const float v1 = v10 + f.y * (v11 - v10);
    return v0 + f.x * (v1 - v0);
}

/// Trilinear reconstruction at a point in local coordinates (index minus grid.lo); 0 outside and
/// for non-finite points.
[[nodiscard]] inline float sample_local(const BrickGrid& grid, Vec3 p)
{
    const Vec3 extent(grid.brick_count * BrickGrid::brick_size);
    const bool inside = p.x >= 0.0f && p.y >= 0.0f && p.z >= 0.0f && p.x < extent.x &&
                        p.y < extent.y && p.z < extent.z;
    if (!inside) return 0.0f;
    const Vec3i c(p);
    const int brick = std::max(grid.table[grid.table_index(c.x >> 3, c.y >> 3, c.z >> 3)], 0);
    return interpolate_cell(grid.corner(brick, c.x & 7, c.y & 7, c.z & 7), p - Vec3(c));
}

/// Trilinear reconstruction at an index-space point; 0 outside and for non-finite points.
[[nodiscard]] inline float sample_trilinear(const BrickGrid& grid, Vec3 p_index)
{
    return sample_local(grid, p_index - Vec3(grid.lo));
}

/// Three channels at an object-space point [m].
[[nodiscard]] Vec3 sample_color(const ColorGrid& grid, Vec3 p_object);

/// Bricks of a dense array of size.x * size.y * size.z voxels, z fastest, whose first voxel sits at
/// index (0,0,0). For tests and small analytic media; values must be finite and >= 0 (asserted).
[[nodiscard]] std::shared_ptr<const BrickGrid> make_dense_bricks(Vec3i size,
                                                                 std::span<const float> values,
                                                                 const Affine& index_from_object);

}  // namespace mote
