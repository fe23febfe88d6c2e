#pragma once

#include "particles/particle_set.h"

namespace mote::bench {

/// Grid built from `points` [index space] by OpenVDB: createPointDataGrid, dilated topology, and
/// points::rasterize with the kernel (1 - r^2/h^2)^2 (not normalised per particle). Returns its
/// active voxel count.
size_t rasterize_with_openvdb(const std::vector<Vec3>& points, float support);

}  // namespace mote::bench
