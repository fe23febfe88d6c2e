#pragma once

#include <string>

#include "particles/particle_set.h"

namespace mote {

/// Grids to write beside the density.
struct GridChannels {
    bool velocity = false;
    bool temperature = false;
    bool color = false;
};

/// Writes particles as VDB points, atomically. Throws Error(Output).
void write_point_file(const std::string& path, const ParticleSet& particles);

/// Rasterises particles and writes the grids, atomically. Throws as rasterize, or Error(Output).
void write_grid_file(const std::string& path, const ParticleSet& particles, float voxel_size,
                     const GridChannels& channels);

}  // namespace mote
