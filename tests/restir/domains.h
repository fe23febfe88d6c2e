#pragma once

#include <memory>

#include "restir/frame_domain.h"
#include "restir/pixel_domain.h"
#include "restir/scenes.h"

namespace mote::test {

/// For scenes that outlive everything that is made of them.
inline std::shared_ptr<const Scene> borrow(const Scene& scene)
{
    return {std::shared_ptr<const Scene>(), &scene};
}

/// A domain with fresh caches.
inline FrameDomain make_domain(const Scene& scene, const RestirParams& params = {})
{
    return make_frame_domain(borrow(scene), make_light_caches(scene, {100'000}, nullptr), params);
}

/// The same with all lights among the candidates.
inline FrameDomain candidates_domain(const Scene& scene)
{
    RestirParams params;
    params.control_variate = false;
    return make_domain(scene, params);
}

inline Ray random_ray(const Camera& camera, Rng& rng)
{
    const Vec2 film = rng.uniform2() * Vec2(camera.width, camera.height);
    const Vec2 lens = rng.uniform2();
    return generate_ray(camera, film, lens, rng.uniform());
}

}  // namespace mote::test
