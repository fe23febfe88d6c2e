#pragma once

#include <optional>

#include "restir/pass_state.h"
#include "restir/shift.h"

namespace mote {

/// Where a pixel was in an earlier pass.
struct PreviousPixel {
    int x = 0;
    int y = 0;
    Vec3 motion{0.0f};  ///< of the medium at the followed point, from then to now [m]
};

/// What changed between two passes' domains.
struct Change {
    bool camera = false;
    bool media = false;
    bool lights = false;
    bool surfaces = false;

    [[nodiscard]] bool any() const { return camera || media || lights || surfaces; }
};

/// Compares cameras, grids, meshes, transforms and lights. Cheap: grids and meshes by identity.
[[nodiscard]] Change change_between(const FrameDomain& before, const FrameDomain& now);

/// Follows the point at the middle of the ray's collisions (cumulative share 1/2: pixel data, no
/// sample) back along the media's velocities and transforms, and projects it with the earlier
/// camera. Empty off screen or behind the camera, and for rays without media.
[[nodiscard]] std::optional<PreviousPixel> previous_pixel(const FrameDomain& before,
                                                          const FrameDomain& now,
                                                          const PixelDomain& domain, bool moved);

/// How well two rays' optical-depth profiles agree, in [0,1]: exp(-strength * distance), the
/// distance between shares of light that got through, compared at four shares of the own ray and at
/// its end. From pixel data alone (linear between the bins' edges), so scaling a history's
/// confidence by it keeps the estimate unbiased.
[[nodiscard]] float profile_agreement(const RayBins& own, const RayBins& other,
                                      const RayMap& other_from_own, float strength);

}  // namespace mote
