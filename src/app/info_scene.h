#pragma once

#include <string>

#include "scene/description.h"

namespace mote {

/// What a scene holds at one frame: settings, particle systems, volumes as they will be rendered
/// (grids, voxels, bounds, ranges, memory, largest displacement in voxels per frame), lights.
/// Prepares the frame. Throws as prepare_frame.
[[nodiscard]] std::string describe_scene(const SceneDescription& scene, int frame);

}  // namespace mote
