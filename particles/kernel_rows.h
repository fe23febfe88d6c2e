#pragma once

#include <cstring>

#include <immintrin.h>

#include "core/math.h"

namespace mote {

/// Eight floats, one AVX register.
using Float8 = float __attribute__((vector_size(32)));

[[nodiscard]] inline Float8 load8(const float* from)
{
    Float8 v;
    std::memcpy(&v, from, sizeof v);
    return v;
}

inline void store8(float* to, Float8 v)
{
    std::memcpy(to, &v, sizeof v);
}

[[nodiscard]] inline Float8 positive_part(Float8 v)
{
#ifdef __AVX__
    return _mm256_max_ps(v, _mm256_setzero_ps());
#else
    constexpr Float8 zero = {};
    return v > zero ? v : zero;
#endif
}

/// a b + c; one rounding where the machine has it.
[[nodiscard]] inline Float8 multiply_add(Float8 a, Float8 b, Float8 c)
{
#ifdef __FMA__
    return _mm256_fmadd_ps(a, b, c);
#else
    return a * b + c;
#endif
}

/// The root of a scaled kernel, s (1 - r^2/h^2), on an 8^3 block of lattice points: its square is
/// the kernel times s^2. Separable before squaring, s - x^2 - y^2 - z^2 with scaled distances.
struct KernelBlock {
    Float8 along_z;                  ///< s minus the scaled squared distance along z
    alignas(32) float across[2][8];  ///< scaled squared distances along x and y
};

/// Block with lattice points 0 to 7 along each axis, for a kernel centred at (x, y, z), scale s.
[[nodiscard]] inline KernelBlock make_kernel_block(float x, float y, float z, float support,
                                                   float s)
{
    constexpr Float8 lattice = {0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f};
    const float falloff = s / (support * support);
    const auto distance2 = [&](float c) {
        const Float8 d = lattice - c;
        return d * d * falloff;
    };
    KernelBlock block;
    block.along_z = s - distance2(z);
    store8(block.across[0], distance2(x));
    store8(block.across[1], distance2(y));
    return block;
}

/// Roots of the kernel values of the row at (x, y).
[[nodiscard]] inline Float8 eval_row_roots(const KernelBlock& block, size_t x, size_t y)
{
    return positive_part(block.along_z - block.across[0][x] - block.across[1][y]);
}

}  // namespace mote
