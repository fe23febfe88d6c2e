#pragma once

#include "volumes/cell_walk_simd.h"

namespace mote {

/// Calls keep_going(cell) for each cell of a brick that the ray crosses, nearest first; false stops
/// the walk. Returns false if stopped.
template <class OnCell>
bool for_each_cell(const BrickGrid& grid, const LocalRay& ray, const BrickSpan& span,
                   OnCell&& keep_going)
{
    CellWalk walk(grid, ray, span);
    for (bool more = true; more;) {
        more = walk.next();
        if (!keep_going(walk.cell())) return false;
    }
    return true;
}

/// Integral of density over the span [density units x m], exact up to float rounding.
[[nodiscard]] inline float integrate_brick(const BrickGrid& grid, const LocalRay& ray,
                                           const BrickSpan& span)
{
    const BrickRange& range = grid.ranges[static_cast<size_t>(span.brick)];
    if (range.min == range.max) return (span.s1 - span.s0) * range.max;
    float sum = 0.0f;
    for_each_cell(grid, ray, span, [&](const CellSpan& cell) {
        sum += (cell.s1 - cell.s0) * (cell.v0 + 4.0f * cell.vm + cell.v1);
        return true;
    });
    return sum * (1.0f / 6.0f);
}

}  // namespace mote
