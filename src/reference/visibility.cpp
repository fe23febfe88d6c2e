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

/// The guess, if there is one, corrected by exact() now and then.
template <class F>
float with_guess(const TraceContext& context, const Ray& ray, float distance, Rng& rng, F&& exact)
{
    if (!context.shadows || distance < infinity) return exact();
    const std::optional<float> guess = context.shadows->to_infinity(ray.o, ray.d);
    if (!guess) return exact();
    constexpr float share = 1.0f / 4;
    if (rng.uniform() >= share) return *guess;
    return *guess + (exact() - *guess) / share;
}

}  // namespace

float estimate_visibility(const TraceContext& context, const ScatterEvent& event, Vec3 wi,
                          float distance, Rng& rng)
{
    const Scene& scene = context.scene;
    const Ray ray{event.x, wi, event.time};
    if (!scene.surfaces) return estimate_attenuation(context, ray, distance, rng);
    const auto exact = [&] {
        if (is_blocked(*scene.surfaces, event, wi, distance)) return 0.0f;
        return estimate_transmittance(scene.media, ray, {0.0f, distance},
                                      context.params.transmittance, rng);
    };
    // Next to surfaces guesses are too far off.
    return event.surface ? exact() : with_guess(context, ray, distance, rng, exact);
}

float estimate_attenuation(const TraceContext& context, const Ray& ray, float distance, Rng& rng)
{
    return with_guess(context, ray, distance, rng, [&] {
        return estimate_transmittance(context.scene.media, ray, {0.0f, distance},
                                      context.params.transmittance, rng);
    });
}

}  // namespace mote
