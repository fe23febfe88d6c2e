#pragma once

#include "core/rng.h"
#include "volumes/cell_walk.h"
#include "volumes/tracking_counts.h"

namespace mote {

/// Optical depth to the next event of a Poisson process of rate 1, from the generator's 24-bit
/// numbers: 1 - u is exact and never 0. Twice as fast as log1p.
[[nodiscard]] inline float sample_optical_depth(Rng& rng)
{
    return -std::log(1.0f - rng.uniform());
}

/// Expected tentative collisions in a brick from which its cells are integrated instead: some 10 to
/// 20 cells of 20 ns against 30 to 45 ns for each dependent lookup. It also bounds the cost of
/// opaque media, where tentative collisions are closer together than floats are.
inline constexpr float dense_span = 16.0f;

/// Lookups of one walk, counted in registers and handed to the thread's counts at its end.
class CountedLookups {
  public:
    CountedLookups() = default;
    CountedLookups(const CountedLookups&) = delete;
    CountedLookups& operator=(const CountedLookups&) = delete;
    ~CountedLookups()
    {
        tracking_counts.lookups += lookups_;
        tracking_counts.majorant_violations += violations_;
        tracking_counts.closed_bricks += bricks_;
    }

    /// Density at a tentative collision, compared with what was said to bound it.
    [[nodiscard]] float density(const BrickGrid& grid, const BrickSpan& span, Vec3 p, float bound)
    {
        const float found = sample_in_brick(grid, span, p);
        ++lookups_;
        violations_ += violates(found, bound) ? 1 : 0;
        return found;
    }
    void add_closed_brick() { ++bricks_; }

  private:
    int lookups_ = 0;
    int violations_ = 0;
    int bricks_ = 0;
};

/// Tentative collisions along a ray, nearest first: the one walk behind all trackers.
/// `bound(range, span)` gives the majorant (in density units) of a span through a brick;
/// `keep_going(s, span, majorant)` is called at each tentative collision and may stop the walk by
/// returning false. `scale` turns density into extinction [1/m]. Returns false if stopped, true if
/// the ray left the grid.
///
/// One exponential optical depth is spent across brick borders (the process is memoryless, so
/// redrawing at each border would be right too, at one logarithm per brick).
template <class Bound, class OnCollision>
bool for_each_collision(const BrickGrid& grid, const LocalRay& ray, float scale, Rng& rng,
                        Bound&& bound, OnCollision&& keep_going)
{
    float left = sample_optical_depth(rng);
    return for_each_brick(grid, ray, [&](const BrickSpan& span) {
        const BrickRange& range = grid.ranges[static_cast<size_t>(span.brick)];
        const float majorant = bound(range, span);
        const float sigma_maj = scale * majorant;
        float s = span.s0;
        for (;;) {
            const float here = (span.s1 - s) * sigma_maj;
            if (!(here > left)) {
                left -= here;
                return true;
            }
            s += left / sigma_maj;
            if (!keep_going(s, span, majorant)) return false;
            left = sample_optical_depth(rng);
        }
    });
}

/// Where the integral of density over a cell, counted from its start, reaches `goal`. Density is a
/// cubic along the cell, known by four values, so its integral is a quartic: the root of a monotone
/// function by Newton's method, kept inside a bracket, without further lookups.
[[nodiscard]] inline float invert_cell(const BrickGrid& grid, const LocalRay& ray,
                                       const BrickSpan& span, const CellSpan& cell, float goal)
{
    const float length = cell.s1 - cell.s0;
    const float vq = sample_in_brick(grid, span, ray.at(cell.s0 + 0.25f * length));
    // v0 + a t + b t^2 + c t^3 over t in [0,1].
    const float quarter = vq - cell.v0;
    const float half = cell.vm - cell.v0;
    const float whole = cell.v1 - cell.v0;
    const float a = (32.0f * quarter - 12.0f * half + whole) * (1.0f / 3.0f);
    const float b = 8.0f * half - whole - 3.0f * a;
    const float c = whole - a - b;
    const float area = cell.integral() / length;
    const float wanted = goal / length;
    float lo = 0.0f;
    float hi = 1.0f;
    float t = std::clamp(wanted / area, 0.0f, 1.0f);
    for (int i = 0; i < 20; ++i) {
        const float density = cell.v0 + t * (a + t * (b + t * c));
        const float before =
            t * (cell.v0 + t * (0.5f * a + t * ((1.0f / 3.0f) * b + t * 0.25f * c)));
        const float excess = before - wanted;
        if (std::abs(excess) <= 2e-7f * area) break;
        (excess > 0.0f ? hi : lo) = t;
        const float newton = t - excess / density;
        const float next = newton > lo && newton < hi ? newton : 0.5f * (lo + hi);
        if (next == t) break;
        t = next;
    }
    return cell.s0 + t * length;
}

/// Spends the optical depth `left` in one brick by its cells' closed-form integrals. Returns where
/// it ran out, or < 0 with what is left.
[[nodiscard]] inline float invert_brick(const BrickGrid& grid, const LocalRay& ray,
                                        const BrickSpan& span, float scale, float& left)
{
    float found = -1.0f;
    for_each_cell(grid, ray, span, [&](const CellSpan& cell) {
        const float tau = scale * cell.integral();
        if (left >= tau) {
            left -= tau;
            return true;
        }
        found = invert_cell(grid, ray, span, cell, left / scale);
        return false;
    });
    return found;
}

/// First real collision, by delta tracking (Woodcock et al. 1965) with brick majorants; s < 0 if
/// the ray leaves. Bricks of one value and dense bricks are inverted in closed form.
[[nodiscard]] inline float track_delta(const BrickGrid& grid, const LocalRay& ray, float scale,
                                       Rng& rng)
{
    CountedLookups counts;
    float found = -1.0f;
    float left = sample_optical_depth(rng);
    for_each_brick(grid, ray, [&](const BrickSpan& span) {
        const BrickRange& range = grid.ranges[static_cast<size_t>(span.brick)];
        const float sigma_maj = scale * range.max;
        float s = span.s0;
        if ((span.s1 - s) * sigma_maj > dense_span && range.min < range.max) {
            counts.add_closed_brick();
            found = invert_brick(grid, ray, span, scale, left);
            return found < 0.0f;
        }
        for (;;) {
            const float here = (span.s1 - s) * sigma_maj;
            if (!(here > left)) {
                left -= here;
                return true;
            }
            s += left / sigma_maj;
            if (range.min == range.max ||
                rng.uniform() * range.max < counts.density(grid, span, ray.at(s), range.max)) {
                found = s;
                return false;
            }
            left = sample_optical_depth(rng);
        }
    });
    return found;
}

/// Unbiased transmittance by ratio tracking (Novak et al. 2014). Bricks of one value and dense
/// bricks take part in closed form.
[[nodiscard]] inline float track_ratio(const BrickGrid& grid, const LocalRay& ray, float scale,
                                       Rng& rng)
{
    CountedLookups counts;
    float T = 1.0f;
    float tau = 0.0f;
    for_each_collision(
        grid, ray, scale, rng,
        [&](const BrickRange& range, const BrickSpan& span) {
            const bool is_dense = (span.s1 - span.s0) * scale * range.max > dense_span;
            if (range.min < range.max && !is_dense) return range.max;
            counts.add_closed_brick();
            tau += scale * integrate_brick(grid, ray, span);
            return 0.0f;
        },
        [&](float s, const BrickSpan& span, float majorant) {
            T *= 1.0f - counts.density(grid, span, ray.at(s), majorant) / majorant;
            return T > 0.0f;
        });
    return T > 0.0f ? T * std::exp(-tau) : 0.0f;
}

/// Unbiased transmittance by residual ratio tracking (Novak et al. 2014). The control is the
/// brick's mean: of the choices measured (minimum, middle, mean) it has the least variance.
[[nodiscard]] inline float track_residual_ratio(const BrickGrid& grid, const LocalRay& ray,
                                                float scale, Rng& rng)
{
    CountedLookups counts;
    float T = 1.0f;
    float tau = 0.0f;
    for_each_collision(
        grid, ray, scale, rng,
        [&](const BrickRange& range, const BrickSpan& span) {
            const float majorant = std::max(range.max - range.mean, range.mean - range.min);
            const float length = span.s1 - span.s0;
            const bool is_dense = length * scale * majorant > dense_span;
            if (is_dense) counts.add_closed_brick();
            tau += scale * (is_dense ? integrate_brick(grid, ray, span) : range.mean * length);
            return is_dense ? 0.0f : majorant;
        },
        [&](float s, const BrickSpan& span, float majorant) {
            const BrickRange& range = grid.ranges[static_cast<size_t>(span.brick)];
            const float density = counts.density(grid, span, ray.at(s), range.max);
            T *= 1.0f - (density - range.mean) / majorant;
            return T > 0.0f;
        });
    return T > 0.0f ? T * std::exp(-tau) : 0.0f;
}

}  // namespace mote
