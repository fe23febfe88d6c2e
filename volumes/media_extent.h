#pragma once

#include "volumes/tracking.h"

namespace mote {

/// Ray time at which per-frame caches see moving media: the middle of the shutter.
inline constexpr float cache_time = 0.5f;

/// Local coordinates of the density grid (index minus its `lo`) -> world space [m] at ray time
/// [0,1].
[[nodiscard]] Mat4d world_from_local(const Volume& volume, float time);

/// Box of a grid's non-zero reconstruction, in its local coordinates.
[[nodiscard]] Bounds3 local_bounds(const BrickGrid& grid);

/// Shortest voxel edge of all media at cache_time [m]; 1 without density.
[[nodiscard]] float finest_voxel(const Media& media);

}  // namespace mote
