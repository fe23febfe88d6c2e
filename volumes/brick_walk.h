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

/// The stored bricks that a ray crosses, nearest first. Spans tile the ray's inside of the bricks
/// without gap or overlap; empty space is crossed in jumps of the table's skip distances.
class BrickWalk {
  public:
    BrickWalk(const BrickGrid& grid, const LocalRay& ray)
        : grid_(&grid), ray_(ray), is_done_(ray.misses())
    {
        if (is_done_) return;
        for (int axis = 0; axis < 3; ++axis) {
            const bool moves = std::abs(ray.d[axis]) > 1e-30f;
            inv_[axis] = moves ? 1.0f / ray.d[axis] : 0.0f;
            never_[axis] = moves ? 0.0f : infinity;
            step_[axis] = ray.d[axis] > 0.0f ? 1 : -1;
            cell_[axis] = std::clamp(static_cast<int>(ray.o[axis] * (1.0f / size)), 0,
                                     grid.brick_count[axis] - 1);
        }
    }

    /// Moves to the next brick; false if there is none.
    bool next(BrickSpan& span)
    {
        const BrickGrid& grid = *grid_;
        while (!is_done_) {
            const int32_t entry = grid.table[grid.table_index(cell_.x, cell_.y, cell_.z)];
            const int reach = std::max(-entry, 1);
            // Distance to the border of the cube of positions that may be crossed at once.
            Vec3 border;
            for (int axis = 0; axis < 3; ++axis) {
                const int plane = cell_[axis] + (step_[axis] > 0 ? reach : 1 - reach);
                border[axis] =
                    (static_cast<float>(plane) * size - ray_.o[axis]) * inv_[axis] + never_[axis];
            }
            const int axis =
                border.x < border.y ? (border.x < border.z ? 0 : 2) : (border.y < border.z ? 1 : 2);
            const float exit = std::min(border[axis], ray_.s1);
            const bool is_hit = entry > 0 && exit > s_;
            if (is_hit) span = {s_, exit, entry, Vec3(cell_) * size};
            s_ = std::max(s_, exit);
            is_done_ = !(border[axis] < ray_.s1);
            if (!is_done_) advance(axis, reach);
            if (is_hit) return true;
        }
        return false;
    }

  private:
    static constexpr float size = BrickGrid::brick_size;

    void advance(int axis, int reach)
    {
        const int next = cell_[axis] + step_[axis] * reach;
        if (reach > 1) {
            const Vec3 p = ray_.at(s_) * (1.0f / size);
            for (int other = 0; other < 3; ++other) {
                // Rounding must not leave the cube that is known to be empty.
                const int lo = std::max(cell_[other] - reach + 1, 0);
                const int hi = std::min(cell_[other] + reach, grid_->brick_count[other]) - 1;
                cell_[other] = std::clamp(static_cast<int>(p[other]), lo, hi);
            }
        }
        cell_[axis] = next;
        is_done_ = next < 0 || next >= grid_->brick_count[axis];
    }

    const BrickGrid* grid_;
    LocalRay ray_;
    Vec3 inv_;
    Vec3 never_;  // infinite along axes that the ray does not move in
    Vec3i step_;
    Vec3i cell_;
    float s_ = 0.0f;
    bool is_done_;
};

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
