#pragma once

#include <cstdint>

#include "core/math.h"

namespace mote {

/// What is reused: a scattering event on a pixel's ray and the light that reaches it, in the
/// pixel's primary sample space. In another pixel's domain the same numbers mean another distance
/// (and, for lamps, another point of the lamp), but never an undefined one.
struct PathSample {
    float u = 0.0f;      ///< [0,1): where on the ray, through the domain's distribution
    int32_t light = -1;  ///< into FrameDomain's list of lights
    /// Lamps: two random numbers for the point on the lamp. Environment: direction to it [unit].
    /// Emissive volumes: world point that emits [m]. Distant lights: unused.
    Vec3 v{0.0f};
};
static_assert(sizeof(PathSample) == 20);

}  // namespace mote
