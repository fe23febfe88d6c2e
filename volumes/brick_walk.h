#pragma once

#include "volumes/local_ray.h"

namespace mote {

/// The part of a ray inside one brick.
struct BrickSpan {
    float s0 = 0.0f;
    float s1 = 0.0f;
    int brick = 0;
    Vec3 origin{0.0f};  ///< local coordinates of the brick's low corner
};

/// Calls keep_going(span) for every stored brick that the ray crosses, nearest first; false stops
/// the walk. Returns false if stopped. Spans tile the ray's inside of the bricks without gap or
/// overlap; empty space is crossed in jumps of the table's skip distances.
template <class OnSpan>
bool for_each_brick(const BrickGrid& grid, const LocalRay& ray, OnSpan&& keep_going)
{
    if (ray.misses()) return true;
    constexpr float size = BrickGrid::brick_size;
    Vec3 inv;
    Vec3 never;  // infinite along axes that the ray does not move in
    Vec3i step;
    Vec3i cell;
    for (int axis = 0; axis < 3; ++axis) {
        const bool moves = std::abs(ray.d[axis]) > 1e-30f;
        inv[axis] = moves ? 1.0f / ray.d[axis] : 0.0f;
        never[axis] = moves ? 0.0f : infinity;
        step[axis] = ray.d[axis] > 0.0f ? 1 : -1;
        cell[axis] = std::clamp(static_cast<int>(ray.o[axis] * (1.0f / size)), 0,
                                grid.brick_count[axis] - 1);
    }
    float s = 0.0f;
    for (;;) {
        const int32_t entry = grid.table[grid.table_index(cell.x, cell.y, cell.z)];
        const int reach = std::max(-entry, 1);
        // Distance to the border of the cube of positions that may be crossed at once.
        Vec3 border;
        for (int axis = 0; axis < 3; ++axis) {
            const int plane = cell[axis] + (step[axis] > 0 ? reach : 1 - reach);
            border[axis] =
                (static_cast<float>(plane) * size - ray.o[axis]) * inv[axis] + never[axis];
        }
        const int axis =
            border.x < border.y ? (border.x < border.z ? 0 : 2) : (border.y < border.z ? 1 : 2);
        const float exit = std::min(border[axis], ray.s1);
        if (entry > 0 && exit > s) {
            if (!keep_going(BrickSpan{s, exit, entry, Vec3(cell) * size})) return false;
        }
        if (!(border[axis] < ray.s1)) return true;
        s = std::max(s, exit);
        const int next = cell[axis] + step[axis] * reach;
        if (reach > 1) {
            const Vec3 p = ray.at(s) * (1.0f / size);
            for (int other = 0; other < 3; ++other) {
                // Rounding must not leave the cube that is known to be empty.
                const int lo = std::max(cell[other] - reach + 1, 0);
                const int hi = std::min(cell[other] + reach, grid.brick_count[other]) - 1;
                cell[other] = std::clamp(static_cast<int>(p[other]), lo, hi);
            }
        }
        cell[axis] = next;
        if (cell[axis] < 0 || cell[axis] >= grid.brick_count[axis]) return true;
    }
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
