#pragma once

#include "core/rng.h"
#include "volumes/brick_walk.h"

namespace mote {

/// Optical depth to the next event of a Poisson process of rate 1, from the generator's 24-bit
/// numbers: 1 - u is exact and never 0. Twice as fast as log1p.
[[nodiscard]] inline float sample_optical_depth(Rng& rng)
{
    return -std::log(1.0f - rng.uniform());
}

/// Tentative collisions along a ray, nearest first: the one walk behind all trackers.
/// `bound(range, length)` gives the majorant (in density units) of a span of world length `length`
/// through a brick; `keep_going(s, span, majorant)` is called at each tentative collision and may
/// stop the walk by returning false. `scale` turns density into extinction [1/m].
/// Returns false if stopped, true if the ray left the grid.
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
        const float majorant = bound(range, span.s1 - span.s0);
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

/// First real collision, by delta tracking (Woodcock et al. 1965) with brick majorants; s < 0 if
/// the ray leaves.
[[nodiscard]] inline float track_delta(const BrickGrid& grid, const LocalRay& ray, float scale,
                                       Rng& rng)
{
    float found = -1.0f;
    for_each_collision(
        grid, ray, scale, rng, [](const BrickRange& range, float) { return range.max; },
        [&](float s, const BrickSpan& span, float majorant) {
            const BrickRange& range = grid.ranges[static_cast<size_t>(span.brick)];
            const bool is_uniform = range.min == range.max;
            if (is_uniform || rng.uniform() * majorant < sample_in_brick(grid, span, ray.at(s))) {
                found = s;
                return false;
            }
            return true;
        });
    return found;
}

/// Unbiased transmittance by ratio tracking (Novak et al. 2014). Bricks of one value take part
/// in closed form.
[[nodiscard]] inline float track_ratio(const BrickGrid& grid, const LocalRay& ray, float scale,
                                       Rng& rng)
{
    float T = 1.0f;
    float tau = 0.0f;
    for_each_collision(
        grid, ray, scale, rng,
        [&](const BrickRange& range, float length) {
            if (range.min < range.max) return range.max;
            tau += scale * range.max * length;
            return 0.0f;
        },
        [&](float s, const BrickSpan& span, float majorant) {
            T *= 1.0f - sample_in_brick(grid, span, ray.at(s)) / majorant;
            return T > 0.0f;
        });
    return T > 0.0f ? T * std::exp(-tau) : 0.0f;
}

/// Unbiased transmittance by residual ratio tracking (Novak et al. 2014). The control is the
/// brick's mean: of the choices measured (minimum, middle, mean) it has the least variance.
[[nodiscard]] inline float track_residual_ratio(const BrickGrid& grid, const LocalRay& ray,
                                                float scale, Rng& rng)
{
    float T = 1.0f;
    float tau = 0.0f;
    for_each_collision(
        grid, ray, scale, rng,
        [&](const BrickRange& range, float length) {
            tau += scale * range.mean * length;
            return std::max(range.max - range.mean, range.mean - range.min);
        },
        [&](float s, const BrickSpan& span, float majorant) {
            const float mean = grid.ranges[static_cast<size_t>(span.brick)].mean;
            T *= 1.0f - (sample_in_brick(grid, span, ray.at(s)) - mean) / majorant;
            return T > 0.0f;
        });
    return T > 0.0f ? T * std::exp(-tau) : 0.0f;
}

}  // namespace mote
