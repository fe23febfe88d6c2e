#pragma once

#include "volumes/brick_walk_simd.h"

namespace mote {

/// Calls keep_going(span) for every stored brick that the ray crosses, nearest first; false stops
/// the walk. Returns false if stopped.
template <class OnSpan>
bool for_each_brick(const BrickGrid& grid, const LocalRay& ray, OnSpan&& keep_going)
{
    BrickWalk walk(grid, ray);
    BrickSpan span;
    while (walk.next(span)) {
        if (!keep_going(span)) return false;
    }
    return true;
}

/// Density at a point of a brick, given in local coordinates; clamped to the brick.
[[nodiscard]] inline float sample_in_brick(const BrickGrid& grid, const BrickSpan& span, Vec3 p)
{
    constexpr float last = 8.0f - 0x1p-20f;
    const Vec3 q = glm::clamp(p - span.origin, Vec3(0.0f), Vec3(last));
    const Vec3i c(q);
    return interpolate_cell(grid.corner(span.brick, c.x, c.y, c.z), q - Vec3(c));
}

}  // namespace mote
