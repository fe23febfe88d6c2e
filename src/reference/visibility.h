#pragma once

#include "core/rng.h"
#include "reference/scatter_event.h"
#include "reference/trace_context.h"

namespace mote {

/// Unbiased transmittance [0,1] between an event and a point `distance` along wi (infinity: all the
/// way); 0 if a surface is in between.
[[nodiscard]] float estimate_visibility(const TraceContext& context, const ScatterEvent& event,
                                        Vec3 wi, float distance, Rng& rng);

/// The same from a point in media, along a ray of which the caller knows where a surface ends it:
/// only media attenuate.
[[nodiscard]] float estimate_attenuation(const TraceContext& context, const Ray& ray,
                                         float distance, Rng& rng);

}  // namespace mote
