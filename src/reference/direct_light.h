#pragma once

#include <optional>

#include "core/rng.h"
#include "reference/equiangular.h"
#include "reference/trace_context.h"

namespace mote {

/// A scattering event, about to be lit.
struct ScatterEvent {
    Vec3 x;   ///< world [m]
    Vec3 wo;  ///< where the path came from [unit, away from x]
    float time = 0.0f;
    const Phase* phase = nullptr;
    const FirstEvent* first = nullptr;  ///< set if equiangular sampling competes
};

/// A ray on which light may arrive, with the density of its direction for MIS.
struct LightRay {
    Ray ray;
    float pdf_dir = 0.0f;               ///< [1/sr] with which scattering chose it
    bool is_camera = true;              ///< chosen by no event: shadow rays do not compete
    const FirstEvent* first = nullptr;  ///< the event it left, if equiangular sampling competes
};

/// Light that reaches the event by one shadow ray and scatters towards wo, weighted against
/// scattered rays that could have found it. Unbiased together with seen_light of the scattered ray.
[[nodiscard]] Spectrum estimate_direct_light(const TraceContext& context, const ScatterEvent& event,
                                             Rng& rng);

/// Light of lamps and of the environment that a ray meets. t_end: where the ray's free flight
/// ended, infinity if it left the media; empty to estimate transmittances instead.
[[nodiscard]] Spectrum seen_light(const TraceContext& context, const LightRay& light_ray,
                                  std::optional<float> t_end, Rng& rng);

/// Radiance of emissive volumes that arrives along a ray whose free flight ended at t_end (infinity
/// if it left the media): the expected integral of the emission up to the end of a free flight is
/// the emission attenuated by the transmittance, wherever extinction is 0 too.
[[nodiscard]] Spectrum seen_emission(const TraceContext& context, const LightRay& light_ray,
                                     float t_end, Rng& rng);

}  // namespace mote
