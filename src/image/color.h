#pragma once

#include <algorithm>
#include <cmath>

namespace mote {

/// Display code value in [0,1] of a linear value; outside [0,1] and NaN are clamped. IEC 61966-2-1.
[[nodiscard]] inline float encode_srgb(float linear)
{
    if (!(linear > 0.0f)) return 0.0f;
    if (linear >= 1.0f) return 1.0f;
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// Linear value of an sRGB code value in [0,1]; inverse of encode_srgb.
[[nodiscard]] inline float decode_srgb(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Filmic tone curve: linear scene value to linear display value in [0,1], per channel. Soft toe
/// and shoulder; 18 % grey stays 18 % grey, 1 becomes 0.73, white is reached at 10.
/// Source: Narkowicz 2015, "ACES Filmic Tone Mapping Curve", its input scaled by 0.7232.
[[nodiscard]] inline float filmic_curve(float linear)
{
    if (!(linear > 0.0f)) return 0.0f;
    const float x = 0.7232f * std::min(linear, 1e6f);
    return std::clamp(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0.0f, 1.0f);
}

}  // namespace mote
