#pragma once

#include <span>
#include <vector>

#include "scene/light.h"
#include "volumes/emission.h"

namespace mote {

/// A light at a finite place, reduced to what choosing among many of them needs: lamps at points,
/// spots, spheres, quads, triangles, and emissive volumes as one light each.
struct LocalLight {
    int id = -1;           ///< what LightPick::light returns
    Vec3 position{0.0f};   ///< centre of its power [m]
    float spread2 = 0.0f;  ///< mean squared distance of its power from `position` [m^2]
    Vec3 facing{0.0f};     ///< normal of a light that shines to one side, 0 of all others
    float power = 0.0f;    ///< luminance, > 0 and finite [W, relative]; of spots as
                           ///< if their cone were wide
};

/// Local lights of a list of lamps; id = position in the list. Lights at infinity and lights
/// without (finite) power or place are left out.
[[nodiscard]] std::vector<LocalLight> local_lights(std::span<const Light> lamps);

/// Appends an emissive volume as one light, placed in the middle of the shutter; nothing if it
/// does not emit.
void add_emissive_volume(const Volume& volume, const EmissiveBricks& bricks, int id,
                         std::vector<LocalLight>& lights);

}  // namespace mote
