#pragma once

#include <openvdb/openvdb.h>

#include "particles/particle_set.h"

namespace mote::bench {

/// The same density as mote's rasterize() by OpenVDB's tools, for unit masses and points in index
/// space: createPointDataGrid, one density attribute per point (the kernel (1 - r^2/h^2)^2
/// normalised on the lattice), dilated topology, points::rasterize.
openvdb::FloatGrid::Ptr rasterize_with_openvdb(const std::vector<Vec3>& points, float support);

}  // namespace mote::bench
