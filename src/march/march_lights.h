#pragma once

#include <vector>

#include "scene/scene.h"

namespace mote {

/// A light as the ray marcher sees it: a direction or a point.
struct MarchLight {
    bool is_distant = false;
    Vec3 place{0.0f};      ///< direction towards the light [unit], or position [m]
    Spectrum power{0.0f};  ///< irradiance [W/m^2], or intensity [W/sr] towards `facing`
    Vec3 facing{0.0f};     ///< intensity falls with the cosine to this normal; 0: none
    bool two_sided = false;
    Vec3 axis{0.0f};  ///< of a spot's cone, away from it [unit]; 0: shines everywhere
    float cos_inner = 1.0f;
    float cos_outer = 1.0f;

    bool operator==(const MarchLight&) const = default;
};

/// What arrives at a point if nothing is in the way.
struct MarchArrival {
    Vec3 wi{0.0f};          ///< towards the light [unit]
    float distance = 0.0f;  ///< [m]; infinity for distant ones
    Spectrum Li{0.0f};      ///< irradiance facing the light [W/m^2]
};

/// The lights of a scene: lamps of any size shrunk to their centres, and the sky cut into
/// sky_bands x 2 sky_bands areas of equal solid angle, each with its mean radiance. Biased where a
/// lamp is near or a phase function narrower than such an area.
[[nodiscard]] std::vector<MarchLight> march_lights(const Scene& scene, int sky_bands);

[[nodiscard]] MarchArrival arrival(const MarchLight& light, Vec3 x);

}  // namespace mote
