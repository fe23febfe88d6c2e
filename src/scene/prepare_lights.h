#pragma once

#include <vector>

#include "scene/description.h"
#include "scene/light.h"

namespace mote {

/// Strength times colour at a (fractional) frame, in the units of `strength`.
[[nodiscard]] Spectrum brightness_at(const LightDescription& light, double frame);

/// Makes the light's brightness that many times what it was, at all frames.
void scale_brightness(LightDescription& light, float factor);

/// The lights other than the environment and particles, placed at a (fractional) frame; swarms are
/// scattered. Lamps that keyframes make black now stay in their places in the list, where samples
/// of other frames know them by their numbers. Transforms move positions and directions; a sphere's
/// radius takes the mean scale.
[[nodiscard]] std::vector<Light> make_lights(const std::vector<LightDescription>& descriptions,
                                             double frame);

/// Rotation from world directions to those of an environment's image. Scale and shift of its
/// transform mean nothing at infinity and are ignored.
[[nodiscard]] Mat3 map_from_world(const LightDescription& environment, double frame);

}  // namespace mote
