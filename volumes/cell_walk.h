#pragma once

#include "volumes/brick_walk.h"

namespace mote {

/// Four floats for the compiler's vector unit (an extension that GCC and Clang share).
using Float4 = float __attribute__((vector_size(16)));

/// interpolate_cell at two points of one cell at once: the same operations, so the same bits.
/// Measured on the plume of bench_tracking: 19 ns per cell where two scalar calls take 21.
inline void interpolate_pair(const float* v, Vec3 f, Vec3 g, float& at_f, float& at_g)
{
    constexpr int y = BrickGrid::brick_stride;
    constexpr int x = y * y;
    const Float4 low{v[0], v[y], v[x], v[x + y]};
    const Float4 rise = Float4{v[1], v[y + 1], v[x + 1], v[x + y + 1]} - low;
    const Float4 rows_f = low + f.z * rise;
    const Float4 rows_g = low + g.z * rise;
    const Float4 even = __builtin_shufflevector(rows_f, rows_g, 0, 2, 4, 6);
    const Float4 odd = __builtin_shufflevector(rows_f, rows_g, 1, 3, 5, 7);
    const Float4 planes = even + Float4{f.y, f.y, g.y, g.y} * (odd - even);
    at_f = planes[0] + f.x * (planes[1] - planes[0]);
    at_g = planes[2] + g.x * (planes[3] - planes[2]);
}

/// A piece of a ray inside one cell: density at its start, middle and end. Inside a cell the
/// trilinear density is a cubic in s, so Simpson's rule gives its integral exactly.
struct CellSpan {
    float s0, s1;
    float v0, vm, v1;

    /// Integral of density over the piece [density units x m].
    [[nodiscard]] float integral() const
    {
        return (s1 - s0) * (v0 + 4.0f * vm + v1) * (1.0f / 6.0f);
    }
};

/// Calls keep_going(cell) for each cell of a brick that the ray crosses, nearest first; false stops
/// the walk. Returns false if stopped.
template <class OnCell>
bool for_each_cell(const BrickGrid& grid, const LocalRay& ray, const BrickSpan& span,
                   OnCell&& keep_going)
{
    const Vec3 o = ray.o - span.origin;
    const Vec3 entry = o + span.s0 * ray.d;
    Vec3 next;   // s at which the ray leaves the cell, per axis
    Vec3 pitch;  // s between cell borders
    Vec3 step;
    Vec3 corner;
    int jump[3];
    int carry[3];   // steps of `place`
    int place = 0;  // the three cell coordinates in one byte each: bit 3 of a byte is set outside
    constexpr int strides[3] = {81, 9, 1};
    for (int axis = 0; axis < 3; ++axis) {
        const bool moves = std::abs(ray.d[axis]) > 1e-30f;
        const bool up = ray.d[axis] > 0.0f;
        const float inv = moves ? 1.0f / ray.d[axis] : 0.0f;
        corner[axis] = static_cast<float>(std::clamp(static_cast<int>(entry[axis]), 0, 7));
        next[axis] = moves ? (corner[axis] + (up ? 1.0f : 0.0f) - o[axis]) * inv : infinity;
        pitch[axis] = std::abs(inv);
        step[axis] = up ? 1.0f : -1.0f;
        jump[axis] = up ? strides[axis] : -strides[axis];
        carry[axis] = up ? 1 << (8 * axis) : -(1 << (8 * axis));
        place += static_cast<int>(corner[axis]) << (8 * axis);
    }
    const float* values = grid.corner(span.brick, static_cast<int>(corner.x),
                                      static_cast<int>(corner.y), static_cast<int>(corner.z));
    CellSpan cell;
    cell.s0 = span.s0;
    cell.v0 = interpolate_cell(values, entry - corner);
    for (;;) {
        const float exit = std::min(next.x, std::min(next.y, next.z));
        cell.s1 = std::clamp(exit, cell.s0, span.s1);
        const Vec3 f = o - corner;
        interpolate_pair(values, f + (0.5f * (cell.s0 + cell.s1)) * ray.d, f + cell.s1 * ray.d,
                         cell.vm, cell.v1);
        if (!keep_going(cell)) return false;
        if (!(exit < span.s1)) return true;
        for (int axis = 0; axis < 3; ++axis) {
            const bool crosses = next[axis] <= exit;
            next[axis] += crosses ? pitch[axis] : 0.0f;
            corner[axis] += crosses ? step[axis] : 0.0f;
            values += crosses ? jump[axis] : 0;
            place += crosses ? carry[axis] : 0;
        }
        // Rounding may put the brick's border a hair before span.s1: the rest has no length.
        if ((place & 0x080808) != 0) return true;
        cell.s0 = cell.s1;
        cell.v0 = cell.v1;
    }
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
