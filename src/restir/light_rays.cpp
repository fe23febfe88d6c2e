#include "restir/light_rays.h"

#include <algorithm>
#include <cmath>

#include "volumes/tracking_counts.h"

namespace mote {
namespace {

constexpr float deepest = 104.0f;  // a float's exp(-tau) is 0 beyond

}  // namespace

void LightRays::clear()
{
    queries.clear();
    weights.clear();
    owners.clear();
}

void LightRays::add(int owner, Vec3 x, Vec3 wi, float distance, float time, Spectrum weight,
                    float tau_max)
{
    if (!(max_component(glm::abs(weight)) > 0.0f)) return;
    queries.push_back({x, distance, wi, time, std::min(tau_max, deepest)});
    weights.push_back(weight);
    owners.push_back(owner);
}

void LightRays::trace(const Scene& scene, WalkCounts& counts)
{
    trace(scene.surfaces.get(), scene.media, counts);
}

void LightRays::trace(const Surfaces* surfaces, const Media& media, WalkCounts& counts)
{
    walk_open(surfaces, media, optical_depths, counts);
}

void LightRays::guess(const Surfaces* surfaces, const Media& coarse, WalkCounts& counts)
{
    walk_open(surfaces, coarse, march_depths, counts);
}

void LightRays::walk_open(const Surfaces* surfaces, const Media& media, Walk& walk,
                          WalkCounts& counts)
{
    depths.resize(queries.size());
    if (!surfaces) {
        walk(media, queries, depths, counts);
        return;
    }
    // Media are walked only where no surface is in the way.
    tracking_counts.surface_rays += static_cast<int64_t>(queries.size());
    std::vector<DepthQuery> open;
    std::vector<size_t> places;
    for (size_t i = 0; i < queries.size(); ++i) {
        const DepthQuery& q = queries[i];
        depths[i] = infinity;
        if (is_shadowed(*surfaces, {q.o, q.d, q.time}, q.t1)) continue;
        open.push_back(q);
        places.push_back(i);
    }
    std::vector<float> open_depths(open.size());
    walk(media, open, open_depths, counts);
    for (size_t i = 0; i < open.size(); ++i) depths[places[i]] = open_depths[i];
}

float depth_that_matters(Spectrum weight, float pixel_luminance)
{
    constexpr float shallowest = 18.0f;
    const float ratio = 1e7f * max_component(glm::abs(weight)) / pixel_luminance;
    if (!(ratio < 1e30f)) return deepest;  // as next to nothing
    return std::clamp(std::log(ratio), shallowest, deepest);
}

}  // namespace mote
