#pragma once

#include "particles/curl_noise.h"
#include "particles/emitter_kinds.h"

namespace mote {

/// Seconds for which curl noise carries a particle off its path; 0: there is no turbulence. Slow
/// particles feel an eddy longer, bounded so that paths do not fold.
[[nodiscard]] inline float choose_wobble_time(const EmitterParams& params)
{
    if (!(params.turbulence > 0.0f)) return 0.0f;
    return 0.3f * params.turbulence_size / std::max(params.speed, params.turbulence);
}

/// Displaces particles on closed-form paths by curl noise, without steps: neighbours stay
/// neighbours. Velocities get the exact derivative.
inline void add_wobble(const CurlNoise& noise, float wobble_time, ParticleBlock& block)
{
    Lanes3 u;
    Lanes3 u_rate;
    eval_curl_noise_with_rate(noise, block.p, block.v, u, u_rate);
    for (size_t i = 0; i < lane_count; ++i) {
        block.p.x[i] += wobble_time * u.x[i];
        block.p.y[i] += wobble_time * u.y[i];
        block.p.z[i] += wobble_time * u.z[i];
        block.v.x[i] += wobble_time * u_rate.x[i];
        block.v.y[i] += wobble_time * u_rate.y[i];
        block.v.z[i] += wobble_time * u_rate.z[i];
    }
}

}  // namespace mote
