#pragma once

#include <optional>

#include "reference/direct_light.h"

namespace mote {

/// What a ray brings up to its next event, and that event.
struct TracedSegment {
    Spectrum emission{0.0f};          ///< of media along it
    SeenLight seen;                   ///< of lamps and of the environment
    Spectrum surface_emission{0.0f};  ///< of the surface at its end
    std::optional<Collision> collision;
    std::optional<SurfaceVertex> vertex;  ///< of the surface, where no collision comes before it

    [[nodiscard]] Spectrum background() const { return seen.lamps + seen.environment; }
    [[nodiscard]] Spectrum light() const { return emission + background() + surface_emission; }
};

/// Follows a ray to its next event and gathers the light that it meets on the way, weighted by MIS
/// against shadow rays. `only_light`: no event is wanted; then transmittances are estimated, which
/// is less noisy than asking whether a free flight gets there. `light_ray.t_surface` is set.
[[nodiscard]] TracedSegment trace_segment(const TraceContext& context, LightRay& light_ray,
                                          bool only_light, Rng& rng);

}  // namespace mote
