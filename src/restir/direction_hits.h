#pragma once

#include <functional>

#include "core/rng.h"
#include "restir/incident_light.h"

namespace mote {

/// A light that a direction meets, as a sample.
struct DirectionHit {
    int light = -1;  ///< into FrameDomain::lights
    Vec3 v{0.0f};    ///< as in PathSample
    Arrival arrival;
    float light_density = 0.0f;  ///< with which the light's own sampling finds v, given the light
    /// Density in v's measure with which directions find it, per density of the direction [sr].
    float per_direction = 0.0f;
};

/// The same factor for any sample: 0 for lights that `finds` does not look for.
[[nodiscard]] float density_per_direction(const FrameDomain& frame, const DirectionTargets& finds,
                                          Vec3 x, float time, const PathSample& y,
                                          const Arrival& arrival);

/// Calls f for every light that the ray meets among those that `finds` looks for: each is a sample
/// of its own, as the densities on different lights have nothing in common. Surfaces in between are
/// left to shadow rays, but of emissive surfaces only the first is met. u in [0,1) picks points of
/// emissive volumes.
void for_each_light_along(const FrameDomain& frame, const DirectionTargets& finds, const Ray& ray,
                          float u, const std::function<void(const DirectionHit&)>& f);

}  // namespace mote
