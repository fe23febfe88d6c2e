#pragma once

#include <openvdb/openvdb.h>

#include "particles/particle_set.h"

namespace mote {

/// Grids to build: only those that the scene uses.
struct RasterChannels {
    bool velocity = false;
    bool temperature = false;
    bool color = false;
};

struct RasterizeParams {
    float voxel_size = 0.02f;      ///< edge of a voxel [m]
    float shutter_open_s = 0.0f;   ///< blur along the velocity from here ... [s, relative to frame]
    float shutter_close_s = 0.0f;  ///< ... to here; equal means no blur
    int64_t max_voxels = 2'000'000'000;  ///< refuse larger results, Error(Memory)
    RasterChannels channels;
};

/// Particle grids of one frame, fog volumes named as in the file formats of other tools.
struct ParticleGrids {
    openvdb::FloatGrid::Ptr density;      ///< "density" [kg/m^3]
    openvdb::Vec3SGrid::Ptr velocity;     ///< "velocity" [m/s], mass-weighted mean; or null
    openvdb::FloatGrid::Ptr temperature;  ///< "temperature" [K], mass-weighted mean; or null
    openvdb::Vec3SGrid::Ptr color;        ///< "Cd", mass-weighted mean; or null
};

/// Splats particles with a normalised smooth kernel whose support is the particle's radius.
/// Mass-conserving: the sum of density times voxel volume is the mass of the particles, to 1e-5.
/// Lock-free per leaf and bit-identical for any thread count: every leaf sums its particles in
/// particle order. Throws Error(Memory) before allocating more than params.max_voxels.
[[nodiscard]] ParticleGrids rasterize(const ParticleSet& particles, const RasterizeParams& params);

}  // namespace mote
