#pragma once

#include <memory>

#include "restir/candidates.h"
#include "restir/frame_domain.h"
#include "restir/pixel_domain.h"

namespace mote::test {

/// A frame on its own, with caches of its own.
[[nodiscard]] inline FrameDomain frame_domain_of(const Scene& scene,
                                                 const RestirParams& params = {})
{
    return make_frame_domain(std::make_shared<const Scene>(scene),
                             make_light_caches(scene, {1000}, nullptr), params);
}

/// What a film point sees, ready to draw from.
inline void make_domain(const FrameDomain& frame, Vec2 film, PixelDomain& domain)
{
    BinCounts counts;
    make_pixel_domain(frame, generate_ray(frame.scene->camera, film, Vec2(0.5f), 0.0f), domain,
                      counts);
    if (!domain.bins.empty()) weigh_bins(frame, domain);
}

}  // namespace mote::test
