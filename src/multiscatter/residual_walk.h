#pragma once

#include "multiscatter/radiance_cache.h"
#include "reference/path_tracer.h"

namespace mote {

/// How a residual walk spends its rays; every choice is unbiased.
struct ResidualParams {
    static constexpr int most_directions = 8;

    int directions = 2;        ///< from the first event, [1, most_directions]
    int later_directions = 2;  ///< from those that carry the residual on
    /// With which the residual is carried on from the first event, (0, 1]. Below 1 its weight grows
    /// by the inverse once, and then it lives on as the albedo lets it: a probability below
    /// albedo^2 at every event would make the variance infinite.
    float survival = 1.0f;
};

/// What trace_after_event estimates of an event in a medium, PathResult::indirect and ::cut, with a
/// cache C as control variate. With K one more event, D light scattered once, and n events left,
/// light scattered twice and more is
///   I_n = K (D + I_{n-1}) = C + R_n,   R_n = K (D + C) - C + K R_{n-1},   R_1 = K D - C
/// (I_0 is 0, so that behind the last event C has no place). K (D + C) is estimated by directions
/// that are stratified over the phase function, and one of the events they find carries K R on,
/// while Russian roulette lets it: with a single direction everywhere and no roulette the sum would
/// telescope into plain path tracing. From surfaces plain paths go on. Unbiased for any finite
/// cache; may be negative. Preconditions: first.phase, params.max_bounces > 1.
[[nodiscard]] PathResult residual_light(const TraceContext& context, const RadianceCache& cache,
                                        const ResidualParams& params, const ScatterEvent& first,
                                        Rng& rng);

}  // namespace mote
