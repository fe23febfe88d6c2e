#pragma once

#include <algorithm>
#include <cmath>

#include "volumes/local_ray.h"
#include "volumes/walk_kernels.h"

namespace mote {

static_assert(BrickGrid::brick_values == 736 && BrickGrid::brick_stride == 9,
              "cell_steps_simd.h knows the layout by heart");

[[nodiscard]] inline BrickTable table_of(const BrickGrid& grid)
{
    const Vec3i count = grid.brick_count;
    return {grid.table.data(), {count.x, count.y, count.z}};
}

/// Puts a ray at the start of its way through a grid. One that misses has ended.
inline void set_ray(RayBlock& rays, size_t i, const BrickGrid& grid, const LocalRay& ray)
{
    for (int axis = 0; axis < 3; ++axis) {
        const bool moves = std::abs(ray.d[axis]) > 1e-30f;
        const int cell = static_cast<int>(ray.o[axis] / BrickGrid::brick_size);
        rays.o[axis][i] = ray.o[axis];
        rays.d[axis][i] = ray.d[axis];
        rays.inv[axis][i] = moves ? 1.0f / ray.d[axis] : 0.0f;
        rays.cell[axis][i] = static_cast<float>(std::clamp(cell, 0, grid.brick_count[axis] - 1));
    }
    rays.s[i] = 0.0f;
    rays.s1[i] = ray.s1;
}

}  // namespace mote
