#include "reference/visibility.h"

#include "volumes/tracking_counts.h"

namespace mote {
namespace {

bool is_blocked(const Surfaces& surfaces, const ScatterEvent& event, Vec3 wi, float distance)
{
    ++tracking_counts.surface_rays;
    Ray ray{ray_origin(event, wi), wi, event.time};
    if (distance < infinity) {
        // From where the ray really starts to where it is to end; distances are rounded, too.
        const Vec3 to_end = event.x + distance * wi - ray.o;
        const float length = glm::length(to_end);
        if (!(length > 0.0f)) return false;
        ray.d = to_end / length;
        distance = length;
    }
    return is_shadowed(surfaces, ray, distance);
}

}  // namespace

float estimate_visibility(const TraceContext& context, const ScatterEvent& event, Vec3 wi,
                          float distance, Rng& rng)
{
    const Scene& scene = context.scene;
    if (scene.surfaces && is_blocked(*scene.surfaces, event, wi, distance)) return 0.0f;
    return estimate_transmittance(scene.media, Ray{event.x, wi, event.time}, {0.0f, distance},
                                  context.params.transmittance, rng);
}

}  // namespace mote
