#include "reference/trace_segment.h"

namespace mote {

TracedSegment trace_segment(const TraceContext& context, LightRay& light_ray, bool only_light,
                            Rng& rng)
{
    const Scene& scene = context.scene;
    const Ray& ray = light_ray.ray;
    TracedSegment segment;
    std::optional<SurfaceHit> hit;
    if (scene.surfaces) hit = intersect(*scene.surfaces, ray, {0.0f, infinity});
    if (hit) light_ray.t_surface = hit->t;
    const bool has_emission = !context.lights.emissive_volumes().empty();
    std::optional<float> t_end;
    if (!only_light || has_emission) {
        segment.collision = sample_free_flight(scene.media, ray, {0.0f, light_ray.t_surface}, rng);
        t_end = segment.collision ? segment.collision->t : light_ray.t_surface;
    }
    if (has_emission) segment.emission = seen_emission(context, light_ray, *t_end, rng);
    if (only_light) t_end.reset();
    segment.seen = seen_light(context, light_ray, t_end, rng);
    if (hit && (!segment.collision || !t_end)) {
        segment.vertex = make_vertex(*scene.surfaces, *hit, ray.time);
    }
    const std::optional<SurfaceVertex>& vertex = segment.vertex;
    if (vertex && vertex->material.is_emissive()) {
        const float arrives =
            t_end ? 1.0f
                  : estimate_transmittance(scene.media, ray, {0.0f, light_ray.t_surface},
                                           context.params.transmittance, rng);
        segment.surface_emission = arrives * seen_surface_light(context, light_ray, *vertex);
    }
    return segment;
}

}  // namespace mote
