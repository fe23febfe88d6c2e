#pragma once

#include <vector>

#include "particles/rasterize_params.h"
#include "particles/rasterize_splats.h"

namespace mote {

/// A run of particles that is binned as one piece of work.
struct ChunkRange {
    size_t first;
    size_t last;
    bool all_usable;  ///< see is_usable
};

/// Particles cut into chunks, and chunks into waves that bound the memory of binned splats. Both
/// depend on the particles alone, never on the thread count.
struct RasterPlan {
    SplatRules rules;
    std::vector<ChunkRange> chunks;
    std::vector<size_t> wave_end;  ///< chunk number after the last chunk of each wave
    size_t invalid = 0;            ///< particles left out for a bad value, see is_usable; those
                                   ///< of mass 0 (faded ones) are no fault and not counted
};

/// Checks the input and plans the work. Throws Error(Input) for a voxel size or position that the
/// grids cannot hold, Error(Memory) for a support over max_support_voxels.
[[nodiscard]] RasterPlan make_raster_plan(const ParticleSet& particles,
                                          const RasterizeParams& params);

}  // namespace mote
