#pragma once

#include <cstring>

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

/// Square of v where it is positive, 0 elsewhere.
[[nodiscard]] inline Float8 square_if_positive(Float8 v)
{
    constexpr Float8 zero = {};
    const Float8 inside = v > zero ? v : zero;
    return inside * inside;
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

/// Kernel values of the row at (x, y).
[[nodiscard]] inline Float8 eval_row(const KernelBlock& block, size_t x, size_t y)
{
    return square_if_positive(block.along_z - block.across[0][x] - block.across[1][y]);
}

}  // namespace mote
