#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace mote {

/// Particles that are computed side by side: two vectors of an AVX2 machine, one of AVX-512. Plain
/// loops over lanes; the compiler vectorises them, and a lane never depends on its neighbours.
inline constexpr size_t lane_count = 16;

struct Lanes {
    alignas(64) float v[lane_count]{};

    [[nodiscard]] float& operator[](size_t lane) { return v[lane]; }
    [[nodiscard]] float operator[](size_t lane) const { return v[lane]; }
};

struct Lanes3 {
    Lanes x, y, z;
};

/// To the nearest whole number, |x| < 2^22; unlike std::round it vectorises.
[[nodiscard]] inline float nearest(float x)
{
    constexpr float magic = 0x1.8p23f;
    return (x + magic) - magic;
}

/// sin(2 pi x), to 1e-7 of its argument's rounding.
[[nodiscard]] inline float sin_turns(float x)
{
    const float turn = x - nearest(x);
    const float size = std::abs(turn);
    const float y = std::copysign(std::min(size, 0.5f - size), turn);  // sin(pi - a) = sin(a)
    const float z = y * y;
    return y *
           (6.2831852803f +
            z * (-41.341680613f + z * (81.602476369f + z * (-76.581172645f + z * 39.759827086f))));
}

}  // namespace mote
