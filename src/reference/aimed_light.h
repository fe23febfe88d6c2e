#pragma once

#include "core/rng.h"
#include "reference/scatter_event.h"
#include "reference/trace_context.h"

namespace mote {

/// Distant lights towards which walks aim. In media that scatter forwards, an event shows such a
/// light to hardly any ray that arrives at it, but to those that come from the light's side with
/// the phase function's peak: rare, and by far the most of a path's noise. So events also seek a
/// next one on the light's side, and both ways to find it are weighted against each other.
struct AimedLights {
    static constexpr int most = 2;

    int count = 0;
    Vec3 direction[most];        ///< towards the light [unit], no two alike
    Spectrum irradiance[most];   ///< [W/m^2]
    float share[most] = {0, 0};  ///< of the brightest one's irradiance
};

/// The brightest distant lights; those that share a direction are one. Cost: linear in the lights.
[[nodiscard]] AimedLights find_aimed_lights(const Scene& scene);

/// How an event seeks the next one on the side of each light: with probability q, by a lobe of
/// Henyey and Greenstein around the light's direction. Any q in [0,1] is unbiased.
struct Aim {
    float q[AimedLights::most] = {0, 0};
    float g = 0.0f;

    /// Density with which a direction is sought, q included [1/sr].
    [[nodiscard]] float density(int light, Vec3 to_light, Vec3 wi) const
    {
        return q[light] > 0.0f ? q[light] * eval_hg(glm::dot(wi, to_light), g) : 0.0f;
    }
};

/// Where the event's phase function and shadows as far as they are guessed make it worth a ray.
/// Nothing is sought from surfaces, nor for several ways at once, nor in media that hardly scatter
/// forwards.
[[nodiscard]] Aim aim_at_lights(const TraceContext& context, const ScatterEvent& event);

/// What one light sends to an event by way of an event that was sought.
struct AimedArrival {
    Vec3 wi{0.0f};     ///< of the way there [unit]
    Spectrum E{0.0f};  ///< radiance over the density of wi, weighted; black if nothing was found
};

/// Seeks with probability q; black otherwise. Precondition: aim = aim_at_lights(context, event).
[[nodiscard]] AimedArrival seek_light(const TraceContext& context, const ScatterEvent& event,
                                      const Aim& aim, int light, Rng& rng);

/// Sum over the lights of what seek_light finds, scattered towards wo.
[[nodiscard]] Spectrum estimate_aimed_light(const TraceContext& context, const ScatterEvent& event,
                                            const Aim& aim, Rng& rng);

/// estimate_direct_light at an event to which a scattered ray of density pdf_dir has led from one
/// that aimed as well; unbiased together with what that one sought.
[[nodiscard]] Spectrum estimate_direct_light_after(const TraceContext& context,
                                                   const ScatterEvent& event, const Aim& before,
                                                   float pdf_dir, Rng& rng);

}  // namespace mote
