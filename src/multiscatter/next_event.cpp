#include "multiscatter/next_event.h"

#include "reference/path_tracer.h"

namespace mote {

std::optional<NextEvent> next_event(const Scene& scene, const Ray& ray,
                                    const TracedSegment& segment)
{
    NextEvent next{{Vec3(0.0f), -ray.d, ray.time}};
    if (segment.collision) {
        const Collision& collision = *segment.collision;
        const Volume& volume = scene.media.volumes[static_cast<size_t>(collision.volume)];
        next.event.x = ray.at(collision.t);
        next.event.phase = &volume.phase;
        next.albedo = albedo_at(volume, collision.p_object);
        if (!(max_component(next.albedo) > 0.0f)) return std::nullopt;
        return next;
    }
    if (!segment.vertex) return std::nullopt;
    next.event.x = segment.vertex->p;
    next.event.surface = &*segment.vertex;
    return next;
}

Spectrum light_of_event(const TraceContext& context, const ScatterEvent& event, int event_count,
                        Rng& rng, float& cut)
{
    Spectrum light = estimate_direct_light(context, event, rng);
    const std::optional<ScatteredDirection> s = sample_scattering(event, rng);
    if (!s) return light;
    const Spectrum weight = s->scattering.f / s->scattering.pdf_dir;
    const LightRay ray{Ray{ray_origin(event, s->wi), s->wi, event.time}, s->scattering.pdf_dir,
                       false};
    float cut_behind = 0.0f;
    light += weight * trace_scattered_ray(context, ray, event_count, Aim{}, rng, cut_behind);
    cut += max_component(weight) * cut_behind;
    return light;
}

}  // namespace mote
