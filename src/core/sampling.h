#pragma once

#include "core/math.h"

namespace mote {

/// Uniform direction on the sphere [unit]. u in [0,1)^2.
[[nodiscard]] inline Vec3 sample_sphere(Vec2 u)
{
    const float z = 1.0f - 2.0f * u.x;
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    const float phi = 2.0f * pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Density of sample_sphere [1/sr].
[[nodiscard]] constexpr float sample_sphere_pdf()
{
    return inv_4pi;
}

/// Uniform point on the unit disk. u in [0,1)^2. Shirley and Chiu 1997.
[[nodiscard]] inline Vec2 sample_disk(Vec2 u)
{
    const Vec2 p = 2.0f * u - Vec2(1.0f);
    if (p.x == 0.0f && p.y == 0.0f) return Vec2(0.0f);
    const bool wide = std::abs(p.x) > std::abs(p.y);
    const float r = wide ? p.x : p.y;
    const float theta = wide ? pi / 4.0f * (p.y / p.x) : pi / 2.0f - pi / 4.0f * (p.x / p.y);
    return r * Vec2(std::cos(theta), std::sin(theta));
}

/// Distance to the next event of a Poisson process of rate 1. u in [0,1); never infinite.
[[nodiscard]] inline float sample_exponential(float u)
{
    return -std::log1p(-u);
}

}  // namespace mote
