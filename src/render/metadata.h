#pragma once

#include <vector>

#include "image/layers.h"
#include "scene/camera.h"

namespace mote {

/// OpenEXR's standard attributes of a rendered image's camera at ray time 0: worldToCamera (a
/// left-handed space that looks along +z) and worldToNDC ((0,0) top left, (1,1) bottom right),
/// both for row vectors; chromaticities (Rec. 709) say what R, G and B are.
[[nodiscard]] std::vector<Attribute> camera_attributes(const Camera& camera);

}  // namespace mote
