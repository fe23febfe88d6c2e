#include "reference/path_tracer.h"

#include "reference/direct_light.h"

namespace mote {
namespace {

/// The part of the result that light after this many scattering events belongs to.
Spectrum& part_of(PathResult& result, int event_count, bool first_is_surface)
{
    if (first_is_surface) {
        return event_count == 1 ? result.surface_direct : result.surface_indirect;
    }
    return event_count == 1 ? result.direct : result.indirect;
}

/// A surface at the end of a ray, unless a collision comes before it.
std::optional<SurfaceHit> find_surface(const Scene& scene, const Ray& ray)
{
    if (!scene.surfaces) return std::nullopt;
    return intersect(*scene.surfaces, ray, {0.0f, infinity});
}

/// Follows a path from a ray on, `event_count` events after the camera, and adds what it brings.
/// `segment`: the camera ray, if equiangular sampling takes part.
void follow(const TraceContext& context, LightRay light_ray, Spectrum beta, int event_count,
            const std::optional<CameraSegment>& segment, Rng& rng, PathResult& result)
{
    const Scene& scene = context.scene;
    const PathTracerParams& params = context.params;
    const bool has_emission = !context.lights.emissive_volumes().empty();
    bool first_is_surface = false;
    FirstEvent first;
    for (;; ++event_count) {
        const Ray& ray = light_ray.ray;
        const bool is_last = event_count == params.max_bounces;
        const bool needs_flight = event_count == 0 || !is_last || has_emission;
        const auto add = [&](Spectrum& camera_part, Spectrum light) {
            (event_count == 0 ? camera_part : part_of(result, event_count, first_is_surface)) +=
                beta * light;
        };
        const std::optional<SurfaceHit> hit = find_surface(scene, ray);
        if (hit) light_ray.t_surface = hit->t;
        // A ray after the last event only collects light: a transmittance estimate is less noisy
        // than asking whether a free flight gets there.
        std::optional<Collision> collision;
        std::optional<float> t_end;
        if (needs_flight) {
            collision = sample_free_flight(scene.media, ray, {0.0f, light_ray.t_surface}, rng);
            t_end = collision ? collision->t : light_ray.t_surface;
        }
        if (has_emission) add(result.emission, seen_emission(context, light_ray, *t_end, rng));
        if (is_last && event_count > 0) t_end.reset();
        add(result.background, seen_light(context, light_ray, t_end, rng));
        std::optional<SurfaceVertex> vertex;
        if (hit && (!collision || !t_end)) vertex = make_vertex(*scene.surfaces, *hit, ray.time);
        if (vertex && vertex->material.is_emissive()) {
            const float arrives =
                t_end ? 1.0f
                      : estimate_transmittance(scene.media, ray, {0.0f, light_ray.t_surface},
                                               params.transmittance, rng);
            add(result.surface_emission, arrives * seen_surface_light(context, light_ray, *vertex));
        }

        if (is_last) result.truncated = event_count > 0 || collision || vertex;
        if (!collision && !vertex) return;
        ScatterEvent event{Vec3(0.0f), -ray.d, ray.time, nullptr, nullptr, nullptr};
        Spectrum albedo(0.0f);
        if (collision) {
            const Volume& volume = scene.media.volumes[static_cast<size_t>(collision->volume)];
            event.x = ray.at(collision->t);
            event.phase = &volume.phase;
            albedo = albedo_at(volume, collision->p_object);
        } else {
            event.x = vertex->p;
            event.surface = &*vertex;
            albedo = surface_albedo(*vertex);
        }
        if (event_count == 0) {
            first_is_surface = !collision;
            result.transmittance = 0.0f;
            result.depth = collision ? collision->t : hit->t;
            result.albedo = albedo;
            result.object = collision ? -1 : hit->object;
        }
        if (is_last) return;

        if (collision) beta *= albedo;
        if (!(max_component(beta) > 0.0f)) return;
        if (segment && event_count == 0 && collision) {
            first = make_first_event(scene.media, *segment, collision->t);
            event.first = &first;
        }
        part_of(result, event_count + 1, first_is_surface) +=
            beta * estimate_direct_light(context, event, rng);

        std::optional<BsdfSample> scattered;
        if (vertex && !collision) {
            scattered = sample_bsdf(*vertex, event.wo, rng.uniform3());
            if (!scattered) return;
            beta *= scattered->value.f * (scattered->value.cosine / scattered->value.pdf_dir);
        }
        if (event_count + 1 > params.roulette_start) {
            const float survival = std::min(1.0f, max_component(beta));
            if (rng.uniform() >= survival) return;
            beta /= survival;
        }
        if (scattered) {
            const Vec3 wi = scattered->wi;
            light_ray = {Ray{ray_origin(event, wi), wi, event.time}, scattered->value.pdf_dir,
                         false, nullptr};
        } else {
            const Vec3 wi = sample_phase(*event.phase, event.wo, rng.uniform2());
            light_ray = {Ray{event.x, wi, event.time}, phase_pdf(*event.phase, event.wo, wi), false,
                         event.first};
        }
    }
}

}  // namespace

PathResult trace_path(const Scene& scene, const LightSampler& lights,
                      const PathTracerParams& params, const Ray& camera_ray, Rng& rng)
{
    const TraceContext context{scene, lights, params};
    PathResult result;
    std::optional<CameraSegment> segment;
    if (params.equiangular && params.max_bounces > 0) {
        const std::optional<SurfaceHit> hit = find_surface(scene, camera_ray);
        segment = make_camera_segment(scene.media, camera_ray, hit ? hit->t : infinity);
    }
    if (segment) result.direct += estimate_equiangular(context, *segment, rng);
    follow(context, {camera_ray, 0.0f, true, nullptr}, Spectrum(1.0f), 0, segment, rng, result);
    return result;
}

PathResult trace_after_event(const Scene& scene, const LightSampler& lights,
                             const PathTracerParams& params, const FirstScatter& first, Rng& rng)
{
    const TraceContext context{scene, lights, params};
    PathResult result;
    const Vec3 wi = sample_phase(*first.phase, first.wo, rng.uniform2());
    const float pdf_dir = phase_pdf(*first.phase, first.wo, wi);
    follow(context, {Ray{first.x, wi, first.time}, pdf_dir, false, nullptr}, Spectrum(1.0f), 1,
           std::nullopt, rng, result);
    result.direct = Spectrum(0.0f);  // the scattered ray's half of it alone
    return result;
}

}  // namespace mote
