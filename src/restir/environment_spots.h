#pragma once

#include <vector>

#include "scene/environment.h"

namespace mote {

/// A small and very bright part of an environment image, such as the sun in a sky: nearly a distant
/// light. Its radiance is what the image has there above the rest of it.
struct EnvironmentSpot {
    Vec3 direction{0.0f};       ///< towards its centre [unit, world]
    Spectrum irradiance{0.0f};  ///< integral of its radiance [W/m^2]
    std::vector<uint32_t> pixels;
    AliasTable table;  ///< over `pixels`
};

/// An environment as the sum of an image without extremes and few spots. Exact: the radiance of
/// both adds up to that of the whole in every direction, and spots do not overlap.
struct EnvironmentParts {
    EnvironmentLight whole;
    EnvironmentLight rest;  ///< the whole itself if there are no spots
    std::vector<EnvironmentSpot> spots;
};

/// Takes up to four spots out of an environment image, each a brightest pixel and what is about as
/// bright next to it, within 4 degrees, if it gives at least 2 % of the image's light. A constant
/// environment has none, nor has an image of fewer than 60 rows. Cost: a few passes over the image.
[[nodiscard]] EnvironmentParts split_environment(const EnvironmentLight& whole);

/// A direction towards a spot; the mean of Li / pdf_dir is its irradiance.
[[nodiscard]] LightSample sample_spot(const EnvironmentParts& parts, const EnvironmentSpot& spot,
                                      float u_pixel, Vec2 u);

}  // namespace mote
