#pragma once

#include <functional>

#include "core/rng.h"
#include "restir/incident_light.h"

namespace mote {

/// Where a direction drawn from the phase function meets a sampled light.
struct PhaseHit {
    int light = -1;
    Vec3 v{0.0f};  ///< as in PathSample
    Arrival arrival;
    float light_density = 0.0f;  ///< with which the light's own sampling finds v, given the light
    float phase_density = 0.0f;  ///< with which the phase function's does; both in v's measure
};

/// Whether a light is also looked for by phase-function directions: the environment, quads (light
/// sampling is unbounded close to them) and emissive volumes (likewise, inside them).
[[nodiscard]] bool is_found_by_phase(const FrameDomain& frame, int light);

/// Density, in the measure of y.v, with which phase-function directions find a sample; 0 for the
/// lights they do not look for.
[[nodiscard]] float phase_candidate_density(const FrameDomain& frame, Vec3 x, float time, Vec3 wo,
                                            const PathSample& y, const Arrival& arrival);

/// Draws a direction from the phase function at x and calls f for every light that it meets: each
/// is a draw of its own, as the densities on different lights have nothing in common.
void for_each_phase_hit(const FrameDomain& frame, Vec3 x, float time, Vec3 wo, Rng& rng,
                        const std::function<void(const PhaseHit&)>& f);

}  // namespace mote
