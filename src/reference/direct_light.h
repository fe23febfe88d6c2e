#pragma once

#include <optional>

#include "core/rng.h"
#include "reference/scatter_event.h"
#include "reference/trace_context.h"

namespace mote {

/// A ray on which light may arrive, with the density of its direction for MIS.
struct LightRay {
    Ray ray;
    float pdf_dir = 0.0f;               ///< [1/sr] with which scattering chose it
    bool is_camera = true;              ///< chosen by no event: shadow rays do not compete
    const FirstEvent* first = nullptr;  ///< the event it left, if equiangular sampling competes
    float t_surface = infinity;         ///< where a surface ends it [m]
};

/// A shadow ray, not traced yet.
struct ShadowRay {
    Vec3 wi{0.0f};
    float distance = infinity;  ///< to the light [m]
    Spectrum light{0.0f};   ///< over density, with its MIS weight; not scattered, nor attenuated
    Scattering scattering;  ///< of the event, towards the ray
};

/// The shadow ray of estimate_direct_light; empty where no light is found.
[[nodiscard]] std::optional<ShadowRay> sample_shadow_ray(const TraceContext& context,
                                                         const ScatterEvent& event, Rng& rng);

/// Light that reaches the event by one shadow ray and scatters towards wo, weighted against
/// scattered rays that could have found it. Unbiased together with seen_light of the scattered ray.
[[nodiscard]] Spectrum estimate_direct_light(const TraceContext& context, const ScatterEvent& event,
                                             Rng& rng);

/// Light that a ray meets, attenuated.
struct SeenLight {
    Spectrum lamps{0.0f};
    Spectrum environment{0.0f};
};

/// Light of lamps and of the environment that a ray meets, before any surface. t_end: where the
/// ray's free flight ended, at the surface or infinity if it left the media; empty to estimate
/// transmittances instead.
[[nodiscard]] SeenLight seen_light(const TraceContext& context, const LightRay& light_ray,
                                   std::optional<float> t_end, Rng& rng);

/// Light that the surface at the ray's end (light_ray.t_surface) gives off itself, weighted against
/// shadow rays. Media in between are the caller's business.
[[nodiscard]] Spectrum seen_surface_light(const TraceContext& context, const LightRay& light_ray,
                                          const SurfaceVertex& vertex);

/// Radiance of emissive volumes that arrives along a ray whose free flight ended at t_end (at a
/// surface, or infinity if it left the media): the expected integral of the emission up to the end
/// of a free flight is the emission attenuated by the transmittance, wherever extinction is 0 too.
[[nodiscard]] Spectrum seen_emission(const TraceContext& context, const LightRay& light_ray,
                                     float t_end, Rng& rng);

}  // namespace mote
