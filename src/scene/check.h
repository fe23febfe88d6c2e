#pragma once

#include "scene/description.h"
#include "scene/node.h"
#include "scene/problems.h"

namespace mote {

/// Checks what no single field can tell: names, references, conflicting sources, the order of
/// keyframes, degenerate cameras and lights. `root` gives positions.
void check_scene(const SceneDescription& scene, const Node& root, Problems& problems);

}  // namespace mote
