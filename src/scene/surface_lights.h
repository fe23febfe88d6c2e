#pragma once

#include "scene/scene.h"

namespace mote {

/// Appends one TriangleLight for every triangle of every emissive object to scene.lights, and fills
/// first_light_of_object. Emissive objects must not move while the shutter is open (asserted), as
/// lamps do not.
void add_surface_lights(Scene& scene);

}  // namespace mote
