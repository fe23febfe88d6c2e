#pragma once

#include <cstring>

#include "core/math.h"

namespace mote {

/// Eight floats, one AVX register.
using Float8 = float __attribute__((vector_size(32)));

/// Adds to eight consecutive floats.
inline void add_to(float* sums, Float8 v)
{
    Float8 sum;
    std::memcpy(&sum, sums, sizeof sum);
    sum += v;
    std::memcpy(sums, &sum, sizeof sum);
}

/// The root of a scaled kernel, s (1 - r^2/h^2), on rows of eight lattice points along z: its
/// square is the kernel times s^2.
struct KernelRows {
    Float8 along_z;  ///< s (1 - dz^2/h^2)
    float falloff;   ///< s / h^2
};

/// Rows that start at z = z0, for a kernel centred at z with scale s.
[[nodiscard]] inline KernelRows make_kernel_rows(float z0, float z, float support, float s)
{
    constexpr Float8 lanes = {0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f};
    const float falloff = s / (support * support);
    const Float8 dz = lanes - (z - z0);
    return {s - dz * dz * falloff, falloff};
}

/// Kernel values of the row at squared distance `d2` from the axis through the centre.
[[nodiscard]] inline Float8 eval_row(const KernelRows& rows, float d2)
{
    constexpr Float8 zero = {};
    const Float8 root = rows.along_z - d2 * rows.falloff;
    const Float8 inside = root > zero ? root : zero;
    return inside * inside;
}

}  // namespace mote
