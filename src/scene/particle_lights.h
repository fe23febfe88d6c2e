#pragma once

#include <vector>

#include "scene/description.h"
#include "scene/light.h"
#include "scene/prepare.h"

namespace mote {

/// Most particles that one [[lights]] entry turns into lamps.
inline constexpr size_t max_particle_lights = 1'000'000;

/// Appends the sphere lights of [[lights]] entries with `particles`: one for each particle of the
/// system at the (fractional) frame, in the particles' order, those that do not glow left out. The
/// entry's transform moves them; radii take its mean scale. Nothing is cached: a system that a
/// volume shows as well is evaluated for each. Throws Error(Input) for an unknown system, a missing
/// attribute or too many particles.
void add_particle_lights(const SceneDescription& description, double frame, PrepareStats& stats,
                         std::vector<Light>& lights);

}  // namespace mote
