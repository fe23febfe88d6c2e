#pragma once

#include "scene/camera.h"
#include "scene/grid_cache.h"

namespace mote {

/// The camera of a glTF file that `description.file` names, over [open, close] in frames; lens and
/// shutter are the scene's. Throws Error(Input) naming the file, and the cameras that it has.
[[nodiscard]] Camera make_gltf_camera(const SceneDescription& scene, GltfCache& cache, double open,
                                      double close);

}  // namespace mote
