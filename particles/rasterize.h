#pragma once

#include <openvdb/openvdb.h>

#include "particles/particle_set.h"
#include "particles/rasterize_params.h"

namespace mote {

/// Particle grids of one frame, fog volumes named as in the file formats of other tools.
struct ParticleGrids {
    openvdb::FloatGrid::Ptr density;      ///< "density" [kg/m^3]
    openvdb::Vec3SGrid::Ptr velocity;     ///< "velocity" [m/s], mass-weighted mean; or null
    openvdb::FloatGrid::Ptr temperature;  ///< "temperature" [K], mass-weighted mean; or null
    openvdb::Vec3SGrid::Ptr color;        ///< "Cd", mass-weighted mean; or null
};

/// Splats particles with the kernel (1 - r^2/h^2)^2, normalised per particle on the lattice, whose
/// support h is the particle's radius (one voxel at least, see kernel.h). Voxel values sit at whole
/// index coordinates, index = world / voxel_size; voxels with density > 0 are active.
/// Mass-conserving: the sum of density times voxel volume is the mass of the particles, to 1e-5.
/// Lock-free per leaf and bit-identical for any thread count: every leaf sums its particles in
/// particle order. Particles of mass 0 add nothing; those with negative masses or radii or with
/// non-finite values are left out, with a count in the log; so are those with other values beyond
/// 1e14 (of masses: per volume of a voxel, in kg/m^3), of which sums might overflow. Without radii,
/// supports are one voxel; without masses, all particles share 1 kg. Motion blur spreads a
/// particle's mass over stamps half a support apart, at most 256. Throws Error(Memory) before
/// allocating grids of more than params.max_voxels, and for radii over 256 voxels; Error(Input) for
/// positions outside the 32-bit index range.
[[nodiscard]] ParticleGrids rasterize(const ParticleSet& particles, const RasterizeParams& params);

}  // namespace mote
