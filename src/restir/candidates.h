#pragma once

#include <vector>

#include "core/rng.h"
#include "restir/incident_light.h"
#include "restir/pixel_domain.h"

namespace mote {

/// A sample with what it would bring if nothing stood between the event and the light.
struct Candidate {
    PathSample y;
    Vec3 x{0.0f};          ///< the event, where the shadow ray starts [m]
    Arrival arrival;       ///< direction and distance of the shadow ray
    Spectrum f{0.0f};      ///< contribution over the density of u, transmittance to the light apart
    float density = 0.0f;  ///< expected number of such candidates per unit of the sample's measure:
                           ///< the estimate is the sum of f T / density
    float known = 1.0f;    ///< what the target knows of T without a ray; > 0
};

/// A point of a chosen light, in the sample's own measure; its density there.
struct LightPoint {
    Vec3 v{0.0f};
    float density = 1.0f;
};
[[nodiscard]] std::optional<LightPoint> sample_light_point(const FrameDomain& frame,
                                                           const SampledLight& light, float time,
                                                           Rng& rng);

/// What sample y brings in a pixel's domain, the transmittance of its shadow ray apart; f is black
/// where it brings nothing. density is not set.
[[nodiscard]] Candidate evaluate(const FrameDomain& frame, const PixelDomain& domain,
                                 const PathSample& y);

/// Draws `count` distances, stratified over the ray's distribution, with one light each, lights
/// stratified too; where the scene has an environment among its sampled lights, quads or emissive
/// volumes also one phase-function direction each, which meets what it meets. Both kinds are
/// weighted against each other by the balance heuristic. Candidates that bring nothing are left
/// out. Appends to `out`.
void draw_candidates(const FrameDomain& frame, const PixelDomain& domain, int count, Rng& rng,
                     std::vector<Candidate>& out);

}  // namespace mote
