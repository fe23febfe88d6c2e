#pragma once

#include "restir/control_variate.h"

namespace mote {

/// Rays of one pixel's pass towards one kind of light: each brings `share` of what a single one
/// would bring.
struct RayCount {
    int count = 0;
    float share = 0.0f;
};

/// `usual` rays where the light known to come is what comes to the mean pixel, and more or fewer in
/// proportion: what caches are wrong by follows what they know. Below one ray u in [0,1), uniform,
/// plays roulette; count * share is 1 in the mean. Without a mean (0) always `usual`.
[[nodiscard]] RayCount rays_needed(int usual, float known, float mean_known, float u);

/// For FrameDomain::mean_known: a camera ray through each tile's middle tells. Cost: 1/256 of what
/// the frame's pixels cost without their corrections.
[[nodiscard]] Vec2 mean_known_light(const FrameDomain& frame);

}  // namespace mote
