#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace mote {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec3d = glm::dvec3;
using Vec3i = glm::ivec3;
using Mat3 = glm::mat3;
using Mat4d = glm::dmat4;
using Quatd = glm::dquat;
/// Linear RGB, Rec. 709 primaries.
using Spectrum = glm::vec3;

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float inv_pi = std::numbers::inv_pi_v<float>;
inline constexpr float inv_4pi = 0.25f * std::numbers::inv_pi_v<float>;
inline constexpr float infinity = std::numeric_limits<float>::infinity();
/// Largest float below 1: the top of every random number.
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;

/// Ray through world space. `d` is unit length, so t is a distance [m]. `time` in [0,1] runs from
/// shutter opening to closing.
struct Ray {
    Vec3 o{0.0f};
    Vec3 d{0.0f, 0.0f, 1.0f};
    float time = 0.0f;

    [[nodiscard]] Vec3 at(float t) const { return o + t * d; }
};

/// Axis-aligned box; empty when lo > hi.
struct Bounds3 {
    Vec3 lo{infinity};
    Vec3 hi{-infinity};

    [[nodiscard]] bool is_empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
    [[nodiscard]] Vec3 extent() const { return is_empty() ? Vec3(0.0f) : hi - lo; }
    [[nodiscard]] Vec3 centre() const { return 0.5f * (lo + hi); }
    void extend(Vec3 p)
    {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    void extend(const Bounds3& b)
    {
        lo = glm::min(lo, b.lo);
        hi = glm::max(hi, b.hi);
    }
};

/// Interval of ray distances [m]; empty when t0 >= t1.
struct Interval {
    float t0 = 0.0f;
    float t1 = -1.0f;

    [[nodiscard]] bool is_empty() const { return !(t0 < t1); }
};

/// Part of [t0,t1] on which o + t d lies inside the box. Direction components may be zero; NaN
/// input gives an empty interval.
[[nodiscard]] inline Interval clip(Vec3 o, Vec3 d, const Bounds3& box, Interval range)
{
    for (int axis = 0; axis < 3; ++axis) {
        if (d[axis] == 0.0f) {
            if (!(o[axis] >= box.lo[axis] && o[axis] <= box.hi[axis])) return {0.0f, -1.0f};
            continue;
        }
        const float inv = 1.0f / d[axis];
        const float a = (box.lo[axis] - o[axis]) * inv;
        const float b = (box.hi[axis] - o[axis]) * inv;
        range.t0 = std::max(range.t0, std::min(a, b));
        range.t1 = std::min(range.t1, std::max(a, b));
    }
    return range;
}

/// Rec. 709 luminance.
[[nodiscard]] inline float luminance(Spectrum c)
{
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

[[nodiscard]] inline float max_component(Spectrum c)
{
    return std::max(c.x, std::max(c.y, c.z));
}

[[nodiscard]] inline bool is_finite(Vec3 v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

[[nodiscard]] inline float sqr(float x)
{
    return x * x;
}

/// Orthonormal frame around a unit vector `n` (its third column). Duff et al. 2017.
[[nodiscard]] inline Mat3 make_frame(Vec3 n)
{
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {Vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x),
            Vec3(b, sign + n.y * n.y * a, -n.y), n};
}

}  // namespace mote
