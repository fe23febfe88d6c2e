#pragma once

#include <string>

#include "scene/object_parts.h"

namespace mote {

/// Surfaces lie within this of the origin, along each axis [m]: as lengths in scene files.
inline constexpr double max_world_coordinate = 1e7;

/// Throws Error(Input), naming file, object and vertex, if a vertex of the part lies farther out at
/// any key of its motion, now or one frame later.
void require_in_reach(const ObjectPart& part, const std::string& file);

}  // namespace mote
