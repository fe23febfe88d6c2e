#pragma once

#include <array>

#include "core/math.h"

namespace mote {

/// Real spherical harmonics up to order 2: index l (l + 1) + m.
inline constexpr int sh_count = 9;
using ShBasis = std::array<float, sh_count>;

/// Order l of each index.
inline constexpr std::array<int, sh_count> sh_order{0, 1, 1, 1, 2, 2, 2, 2, 2};

/// Orthonormal over the sphere; d is a unit vector. Sloan 2008, "Stupid Spherical Harmonics (SH)
/// Tricks", without the Condon-Shortley phase.
[[nodiscard]] inline ShBasis eval_sh(Vec3 d)
{
    constexpr float y0 = 0.28209479f;   // sqrt(1 / (4 pi))
    constexpr float y1 = 0.48860251f;   // sqrt(3 / (4 pi))
    constexpr float y2 = 1.09254843f;   // sqrt(15 / (4 pi))
    constexpr float y20 = 0.31539157f;  // sqrt(5 / (16 pi))
    return {y0,
            y1 * d.y,
            y1 * d.z,
            y1 * d.x,
            y2 * d.x * d.y,
            y2 * d.y * d.z,
            y20 * (3.0f * d.z * d.z - 1.0f),
            y2 * d.x * d.z,
            0.5f * y2 * (d.x * d.x - d.y * d.y)};
}

}  // namespace mote
