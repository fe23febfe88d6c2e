#pragma once

#include <memory>
#include <vector>

#include "multiscatter/cached_lights.h"
#include "multiscatter/walk_path.h"
#include "restir/pixel_domains.h"

namespace mote::test {

/// What paths of a scene are walked and evaluated in; stays where it is.
struct PathScene {
    PathScene(const Scene& scene, int max_bounces, uint32_t run_seed = 1)
        : frame(frame_domain_of(scene)), seed(run_seed)
    {
        params.max_bounces = max_bounces;
        lights = LightSampler(*frame.scene, params);
    }
    PathScene(const PathScene&) = delete;
    PathScene& operator=(const PathScene&) = delete;

    [[nodiscard]] PathWorld world() const
    {
        return {frame, {*frame.scene, lights, params, nullptr, nullptr}, seed};
    }
    /// What a film point sees.
    void make_domain(Vec2 film, PixelDomain& domain) const
    {
        BinCounts counts;
        const Ray ray = generate_ray(frame.scene->camera, film, Vec2(0.5f), 0.0f);
        make_path_domain(frame, ray, domain, counts);
    }

    FrameDomain frame;
    PathTracerParams params;
    LightSampler lights;
    uint32_t seed;
};

[[nodiscard]] inline std::vector<std::unique_ptr<PathScene>> path_scenes(
    const std::vector<Scene>& frames, int max_bounces)
{
    std::vector<std::unique_ptr<PathScene>> out;
    for (const Scene& scene : frames) {
        out.push_back(std::make_unique<PathScene>(scene, max_bounces));
    }
    return out;
}

}  // namespace mote::test
