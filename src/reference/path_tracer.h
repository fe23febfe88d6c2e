#pragma once

#include "core/rng.h"
#include "reference/aimed_light.h"
#include "reference/direct_light.h"
#include "reference/light_sampler.h"
#include "reference/scatter_event.h"
#include "scene/path_tracer_params.h"
#include "scene/scene.h"

namespace mote {

/// What one camera path brings. The parts of L are disjoint and sum to it.
struct PathResult {
    Spectrum direct{0.0f};            ///< one scattering event, in a medium
    Spectrum indirect{0.0f};          ///< two and more, the first of them in a medium
    Spectrum emission{0.0f};          ///< from emissive media straight to the camera
    Spectrum background{0.0f};        ///< environment and area lights seen through the media
    Spectrum surface_direct{0.0f};    ///< one scattering event, on a surface
    Spectrum surface_indirect{0.0f};  ///< two and more, the first of them on a surface
    Spectrum surface_emission{0.0f};  ///< from emissive surfaces straight to the camera
    Spectrum sky{0.0f};  ///< of direct and surface_direct, what the scattered ray itself has found
                         ///< of the environment
    float transmittance = 1.0f;  ///< unbiased estimate (0 or 1), camera to infinity
    float depth = infinity;      ///< of the first event, whether it scatters or not [m]
    Spectrum albedo{0.0f};       ///< at the first event
    int object = -1;             ///< of the first event, into Surfaces; -1: in a medium
    /// Weight that the path had left when max_bounces cut it, 0: it was not cut. What is missing is
    /// at most this times the light that would have arrived.
    float cut = 0.0f;

    [[nodiscard]] Spectrum L() const
    {
        return direct + indirect + emission + background + surface_direct + surface_indirect +
               surface_emission;
    }
};

/// Traces one path along a camera ray: up to params.max_bounces scattering events in media and on
/// surfaces, each lit by one shadow ray and by the scattered ray, weighted by MIS. Unbiased for
/// every choice of params but max_bounces itself. Lamps and the environment are seen by the camera
/// through the media.
/// Shares phase functions, lights and media walks with the rest of mote but no reservoir,
/// resampling-MIS or shift code: it is the judge of those.
[[nodiscard]] PathResult trace_path(const Scene& scene, const LightSampler& lights,
                                    const PathTracerParams& params, const Ray& ray, Rng& rng);

/// What a path brings that is about to scatter for the first time at `first`: radiance scattered
/// twice and more, seen at the event, in indirect or surface_indirect. A medium's albedo is left
/// out. Of light scattered once there is what the scattered ray finds: by MIS with shadow rays, or
/// all of it where those are not used, as for a constant environment alone. Precondition:
/// params.max_bounces > 1. For estimators that place the first event themselves.
[[nodiscard]] PathResult trace_after_event(const TraceContext& context, const ScatterEvent& first,
                                           Rng& rng);

/// Radiance that arrives on a ray along which an event scattered light, `event_count` events behind
/// it, that one included: together with estimate_direct_light at the event, and with what it has
/// sought by `aim`, all light scattered there. The ray's share of PathResult::cut is added to
/// `cut`.
[[nodiscard]] Spectrum trace_scattered_ray(const TraceContext& context, const LightRay& light_ray,
                                           int event_count, const Aim& aim, Rng& rng, float& cut);

}  // namespace mote
