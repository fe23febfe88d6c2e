#pragma once

#include <cstdint>
#include <cstring>

namespace mote {

/// Eight floats for the compiler's vector unit (an extension that GCC and Clang share): one vector
/// of an AVX2 machine. A lane never depends on its neighbours.
using Float8 = float __attribute__((vector_size(32)));
using Int8 = int32_t __attribute__((vector_size(32)));
inline constexpr int lane_count = 8;

// The functions below are approximations, good enough for weights of samples unless they say more;
// errors are relative.
// always_inline: vectors as arguments have no ABI that all compilers agree on.

[[nodiscard, gnu::always_inline]] inline Float8 splat(float x)
{
    return Float8{} + x;
}

/// Eight floats from memory, aligned or not.
[[nodiscard, gnu::always_inline]] inline Float8 load(const float* from)
{
    Float8 x;
    std::memcpy(&x, from, sizeof x);
    return x;
}

[[gnu::always_inline]] inline void store(float* to, Float8 x)
{
    std::memcpy(to, &x, sizeof x);
}

[[nodiscard, gnu::always_inline]] inline Float8 min(Float8 a, Float8 b)
{
    return a < b ? a : b;
}

[[nodiscard, gnu::always_inline]] inline Float8 max(Float8 a, Float8 b)
{
    return a > b ? a : b;
}

[[nodiscard, gnu::always_inline]] inline Float8 abs(Float8 x)
{
    return x < 0.0f ? -x : x;
}

[[nodiscard, gnu::always_inline]] inline Int8 bits(Float8 x)
{
    return reinterpret_cast<Int8>(x);
}

[[nodiscard, gnu::always_inline]] inline Float8 from_bits(Int8 x)
{
    return reinterpret_cast<Float8>(x);
}

/// 1/sqrt(x) for x in [1e-37, 1e37], to 5e-6.
[[nodiscard, gnu::always_inline]] inline Float8 approximate_inv_sqrt(Float8 x)
{
    Float8 y = from_bits(0x5f375a86 - (bits(x) >> 1));
    y *= 1.5f - 0.5f * x * y * y;
    return y * (1.5f - 0.5f * x * y * y);
}

/// exp(x) for x in [-87, 0], to 1e-5; values below (and NaN) are held at exp(-87).
[[nodiscard, gnu::always_inline]] inline Float8 approximate_exp(Float8 x)
{
    constexpr float magic = 0x1.8p23f;
    const Float8 e = max(x, splat(-87.0f)) * 1.44269504f;
    const Float8 whole = (e + magic) - magic;  // the nearest whole number
    const Float8 f = (e - whole) * 0.69314718f;
    const Float8 mantissa =
        1.0f + f * (1.0f + f * (0.5f + f * (1.0f / 6.0f + f * (1.0f / 24.0f + f / 120.0f))));
    return mantissa * from_bits((__builtin_convertvector(whole, Int8) + 127) << 23);
}

/// exp(x) for x <= 0, to 2e-7 down to x = -87; values below (and NaN) are held at exp(-87). Cody
/// and Waite's reduction, polynomial of the Cephes library.
[[nodiscard, gnu::always_inline]] inline Float8 exp_of_negative(Float8 x)
{
    constexpr float magic = 0x1.8p23f;
    x = max(x, splat(-87.0f));
    const Float8 whole = (x * 1.44269504f + magic) - magic;  // the nearest whole number
    // ln 2 in two parts: whole times the first is exact.
    const Float8 r = (x - whole * 0.693359375f) + whole * 2.12194440e-4f;
    const Float8 p =
        0.5f +
        r * (0.166666655f + r * (4.16657959e-2f +
                                 r * (8.33345191e-3f + r * (1.39819995e-3f + r * 1.98756915e-4f))));
    return (p * r * r + r + 1.0f) * from_bits((__builtin_convertvector(whole, Int8) + 127) << 23);
}

/// log(x) for finite x >= 1, to 3e-5 absolute.
[[nodiscard, gnu::always_inline]] inline Float8 approximate_log(Float8 x)
{
    // x = m 2^e with m in [2/3, 4/3); log m from the series in (m - 1)/(m + 1).
    const Int8 exponent = (bits(x) - 0x3f2aaaab) >> 23;
    const Float8 m = from_bits(bits(x) - (exponent << 23));
    const Float8 s = (m - 1.0f) / (m + 1.0f);
    const Float8 z = s * s;
    const Float8 log_m = 2.0f * s * (1.0f + z * (1.0f / 3.0f + z * (0.2f + z / 7.0f)));
    return log_m + 0.69314718f * __builtin_convertvector(exponent, Float8);
}

}  // namespace mote
