#pragma once

#include <cstdint>

#include "core/math.h"
#include "particles/lanes.h"

namespace mote {

struct CurlNoiseParams {
    float size = 0.5f;   ///< diameter of the largest eddies [m]
    float speed = 0.5f;  ///< root mean square of the whole velocity vector [m/s]
    Vec3 drift{0.0f};    ///< velocity at which the pattern itself moves [m/s]
    uint32_t seed = 1;
};

/// Divergence-free turbulence: a sum of plane waves, each at right angles to its wave vector, in
/// four octaves whose speed falls as size^(1/3) (Kolmogorov). The waves turn over in time. Exact
/// derivatives, no lattice, no table: eight waves an octave are enough to look irregular.
/// Source: kinematic simulation, Kraichnan 1970; Fung et al. 1992.
struct CurlNoise {
    static constexpr int mode_count = 32;

    float kx[mode_count], ky[mode_count], kz[mode_count];  ///< wave vector [turns/m]
    float rate[mode_count];                                ///< [turns/s]
    float phase[mode_count];                               ///< at the reference time [turns]
    float ax[mode_count], ay[mode_count], az[mode_count];  ///< amplitude [m/s]
};

/// Noise around the reference time `time` [s], which is reduced in double: the noise stays exact
/// over hours. Evaluations give their time relative to it.
[[nodiscard]] CurlNoise make_curl_noise(const CurlNoiseParams& params, double time);

/// Velocity [m/s] at world points p [m] and times t [s, relative to the reference time].
void eval_curl_noise(const CurlNoise& noise, const Lanes3& p, const Lanes& t, Lanes3& velocity);

/// The same at t = 0, with the rate of change [m/s^2] seen by points that move at `motion` [m/s].
void eval_curl_noise_with_rate(const CurlNoise& noise, const Lanes3& p, const Lanes3& motion,
                               Lanes3& velocity, Lanes3& velocity_rate);

}  // namespace mote
