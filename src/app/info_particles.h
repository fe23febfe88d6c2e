#pragma once

#include <string>

#include "particles/source_info.h"

namespace mote {

/// Lines on particles: count, bounds, attributes with their ranges, memory, and the largest
/// displacement per frame, in metres and, where `voxel_size` [m] is above 0, in voxels.
[[nodiscard]] std::string particle_lines(const ParticleInfo& info, double fps, float voxel_size);

}  // namespace mote
