#pragma once

#include "volumes/tracking.h"

namespace mote {

/// The same scalar field with voxels twice as large, smoothed by (1/4 1/2 1/4) along each axis: the
/// integral over all space is kept. Cost: about 10 us per brick that comes out.
[[nodiscard]] BrickGrid halve_bricks(const BrickGrid& grid);

/// Media with voxels as large as possible below `voxel_size` [m], densities alone: for walks that
/// are to see no finer. Grids that are coarse already are shared. Overlap, transforms and
/// extinction stay.
[[nodiscard]] Media coarse_media(const Media& media, float voxel_size);

}  // namespace mote
