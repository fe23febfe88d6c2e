#pragma once

#include "scene/camera.h"
#include "scene/description.h"

namespace mote {

/// The camera over [open, close] in frames: position, aim and lens by its keyframes. The lens
/// (fov, focus, opening) is that of the shutter's middle, the place moves.
[[nodiscard]] Camera make_camera(const CameraDescription& description,
                                 const RenderDescription& render, double open, double close);

}  // namespace mote
