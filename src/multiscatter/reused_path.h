#pragma once

#include <cstdint>

#include "core/math.h"

namespace mote {

/// What names a walk's random numbers, so that it can be walked again: in another pixel, or in the
/// medium of another frame. The run's seed is no part of it.
struct WalkKey {
    uint32_t frame = 0;
    uint32_t pixel = 0;  ///< of the image where it was walked first
    uint32_t walk = 0;   ///< pass, and number of the walk in it
};

/// How a path goes to another pixel.
enum class PathForm : uint32_t {
    ToLight,  ///< keeps its second vertex; a shadow ray leaves it
    ToRay,    ///< keeps its second vertex and the direction of the scattered ray there
    Replay,   ///< keeps its random numbers alone: the whole walk is walked again
};

/// A path of two or more events, as far as reuse needs it. With x1 the event at number u on the
/// pixel's ray, w1 and r direction and distance from there to the second vertex x2, and f the light
/// that the path brings, the measures are
///   ToLight  du dw1 dr, and the shadow ray's random numbers
///   ToRay    du dw1 dr dwi, and the random numbers of what follows the scattered ray
///   Replay   du and all other random numbers.
/// E stands for what has been found with the random numbers. Where nothing has changed it is the
/// same for all pixels, as wi and x2 are; in another medium it is found anew by `key`.
struct ReusedPath {
    float u = 0.0f;    ///< [0,1): share of the ray's lost light that is lost before x1
    Vec3 x2{0.0f};     ///< second vertex, in a medium; of Replay unused, like all below [m]
    float r = 0.0f;    ///< from x1 to x2 [m]
    Vec3 wi{0.0f};     ///< from x2 on [unit]
    Spectrum E{0.0f};  ///< arrives at x2 from there: radiance, of ToLight over density
    WalkKey key;
    PathForm form = PathForm::Replay;
};
static_assert(sizeof(ReusedPath) <= 64);

/// Finished reservoir of a pixel's paths; see Reservoir.
struct PathReservoir {
    ReusedPath y;
    float p_hat = 0.0f;  ///< luminance of the light that y brings, in this pixel's domain
    float W = 0.0f;      ///< unbiased contribution weight; 0 = empty
    float M = 0.0f;      ///< confidence [passes]
    float age = 0.0f;    ///< passes since y was walked
};
static_assert(sizeof(PathReservoir) <= 80);

/// The same on its way through a pass, with the light that its path brings.
struct PathPixel {
    PathReservoir r;
    Spectrum f{0.0f};
};

}  // namespace mote
