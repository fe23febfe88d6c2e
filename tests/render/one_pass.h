#pragma once

#include "render/seen_look.h"
#include "render/surface_pass.h"
#include "restir/light_caches.h"

namespace mote::test {

/// A pass of a scene, whose pixels take several camera rays where they see edges.
struct Pass {
    Scene scene;
    RenderDescription render;
    LightSampler lights;
    FrameDomain domain;
    PassInputs inputs;

    Pass(Scene s, int strata, uint32_t seed)
        : scene(std::move(s)),
          render(),
          domain(make_frame_domain({std::shared_ptr<const Scene>(), &scene},
                                   make_light_caches(scene, {100}, nullptr), render.restir)),
          inputs{domain, render, {}, lights}
    {
        render.seed = seed;
        inputs.split = find_split_pixels(scene, strata);
    }

    [[nodiscard]] SeenLook look(const Ray& ray) const { return look_along(*scene.surfaces, ray); }
};

}  // namespace mote::test
