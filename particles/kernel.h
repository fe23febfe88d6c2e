#pragma once

#include <algorithm>

#include "core/math.h"

namespace mote {

/// Every particle is at least this wide, so that some lattice point always lies well inside its
/// support (the farthest point of a cell is sqrt(3)/2 away from the lattice).
inline constexpr float min_support_voxels = 1.0f;

/// Splat kernel before normalisation, (1 - r^2/h^2)^2 inside the support radius h and 0 outside.
/// `r2` is (r/h)^2. Continuous first derivatives; its integral over space is 32 pi h^3 / 105.
[[nodiscard]] inline float eval_kernel(float r2)
{
    const float root = std::max(0.0f, 1.0f - r2);
    return root * root;
}

/// Sum of the kernel over all integer lattice points, for a particle at `p` [voxels] with support
/// radius `support` [voxels], at least min_support_voxels. Dividing by it makes a splat conserve
/// mass exactly on the lattice, whatever the radius and the place within a cell.
/// Closed form per row of voxels; relative error below 1e-6.
[[nodiscard]] double kernel_lattice_sum(Vec3 p, float support);

/// Eight particles, components apart.
struct KernelCentres {
    alignas(32) float x[8];  ///< within a cell, [0,1)
    alignas(32) float y[8];
    alignas(32) float z[8];
    alignas(32) float support[8];  ///< [voxels], min_support_voxels or more
};

/// kernel_lattice_sum of eight particles at once, four times as fast for supports up to 4 voxels.
void kernel_lattice_sums(const KernelCentres& centres, float* sums);

}  // namespace mote
