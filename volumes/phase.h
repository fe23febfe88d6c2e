#pragma once

#include "core/math.h"

namespace mote {

/// Two-lobe Henyey-Greenstein mixture; weight_b = 0 is one lobe, g = 0 is isotropic.
struct Phase {
    float g = 0.0f;         ///< mean cosine of the first lobe, [-0.999, 0.999]; > 0 is forward
    float g_b = 0.0f;       ///< mean cosine of the second lobe
    float weight_b = 0.0f;  ///< share of the second lobe, [0,1]
};

/// Henyey-Greenstein phase function [1/sr]. Integrates to 1 over the sphere; mean cosine is g.
/// cos_theta = -dot(wo, wi): +1 continues straight ahead. Precondition: |g| < 1.
/// Source: Henyey and Greenstein 1941.
[[nodiscard]] inline float eval_hg(float cos_theta, float g)
{
    // 1 + g^2 - 2 g cos, without the cancellation that would flatten narrow peaks.
    const float a = std::abs(g);
    const float off_axis = std::max(0.0f, 1.0f - std::copysign(1.0f, g) * cos_theta);
    const float denom = sqr(1.0f - a) + 2.0f * a * off_axis;
    return inv_4pi * (1.0f - a) * (1.0f + a) / (denom * std::sqrt(denom));
}

/// Phase function [1/sr] for light arriving from wi and leaving to wo, both away from the vertex.
[[nodiscard]] inline float eval_phase(const Phase& phase, Vec3 wo, Vec3 wi)
{
    const float cos_theta = -glm::dot(wo, wi);
    const float a = eval_hg(cos_theta, phase.g);
    if (phase.weight_b == 0.0f) return a;
    // Not a + weight_b (b - a): in the peak of one lobe that would lose the other to rounding.
    return (1.0f - phase.weight_b) * a + phase.weight_b * eval_hg(cos_theta, phase.g_b);
}

/// Density of sample_phase [1/sr]; the phase function itself, since sampling is exact.
[[nodiscard]] inline float phase_pdf(const Phase& phase, Vec3 wo, Vec3 wi)
{
    return eval_phase(phase, wo, wi);
}

/// Samples wi [unit, away from the vertex] in proportion to the phase function. u in [0,1)^2.
[[nodiscard]] inline Vec3 sample_phase(const Phase& phase, Vec3 wo, Vec2 u)
{
    float g = phase.g;
    if (phase.weight_b > 0.0f) {  // u.x chooses the lobe and is stretched back to [0,1)
        const bool second = u.x < phase.weight_b;
        g = second ? phase.g_b : phase.g;
        u.x = second ? u.x / phase.weight_b : (u.x - phase.weight_b) / (1.0f - phase.weight_b);
        u.x = std::min(u.x, one_minus_epsilon);
    }
    // Inverse of the distribution function, as 1 - |cos|: exact for any g, 0 included. Backward
    // lobes are mirrored forward ones: 1 + cos would be lost to rounding where it is small.
    const float a = std::abs(g);
    const float w = 1.0f - a + 2.0f * a * u.x;
    const float off_axis =
        std::min(2.0f, (1.0f - a) * (1.0f - u.x) / w * ((1.0f - a * a) / w + 1.0f - a));
    const float cos_theta = std::copysign(1.0f, g) * (1.0f - off_axis);
    const float sin_theta = std::sqrt(off_axis * (2.0f - off_axis));
    const float phi = 2.0f * pi * u.y;
    return make_frame(-wo) * Vec3(sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta);
}

}  // namespace mote
