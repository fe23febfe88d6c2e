#include "reference/path_tracer.h"

#include "reference/direct_light.h"

namespace mote {
namespace {

/// The part of the result that light after this many scattering events belongs to.
Spectrum& part_of(PathResult& result, int event_count)
{
    return event_count == 1 ? result.direct : result.indirect;
}

/// Follows a path from a ray on, `event_count` events after the camera, and adds what it brings.
/// `segment`: the camera ray, if equiangular sampling takes part.
void follow(const TraceContext& context, LightRay light_ray, Spectrum beta, int event_count,
            const std::optional<CameraSegment>& segment, Rng& rng, PathResult& result)
{
    const Scene& scene = context.scene;
    const PathTracerParams& params = context.params;
    const bool has_emission = !context.lights.emissive_volumes().empty();
    FirstEvent first;
    for (;; ++event_count) {
        const Ray& ray = light_ray.ray;
        const bool is_last = event_count == params.max_bounces;
        const bool needs_flight = event_count == 0 || !is_last || has_emission;
        // A ray after the last event only collects light: a transmittance estimate is less noisy
        // than asking whether a free flight gets there.
        std::optional<Collision> collision;
        std::optional<float> t_end;
        if (needs_flight) {
            collision = sample_free_flight(scene.media, ray, {0.0f, infinity}, rng);
            t_end = collision ? collision->t : infinity;
        }
        if (has_emission) {
            const Spectrum emission = beta * seen_emission(context, light_ray, *t_end, rng);
            (event_count == 0 ? result.emission : part_of(result, event_count)) += emission;
        }
        if (is_last && event_count > 0) t_end.reset();
        const Spectrum seen = beta * seen_light(context, light_ray, t_end, rng);
        (event_count == 0 ? result.background : part_of(result, event_count)) += seen;

        if (is_last) {
            result.truncated = event_count > 0 || collision;
        }
        if (event_count == 0 && collision) {
            result.transmittance = 0.0f;
            result.depth = collision->t;
        }
        if (!collision) return;
        const Volume& volume = scene.media.volumes[static_cast<size_t>(collision->volume)];
        const Spectrum albedo = albedo_at(volume, collision->p_object);
        if (event_count == 0) result.albedo = albedo;
        if (is_last) return;

        beta *= albedo;
        if (!(max_component(beta) > 0.0f)) return;
        const FirstEvent* competitor = nullptr;
        if (segment && event_count == 0) {
            first = make_first_event(scene.media, *segment, collision->t);
            competitor = &first;
        }
        const ScatterEvent event{ray.at(collision->t), -ray.d, ray.time, &volume.phase, competitor};
        part_of(result, event_count + 1) += beta * estimate_direct_light(context, event, rng);

        if (event_count + 1 > params.roulette_start) {
            const float survival = std::min(1.0f, max_component(beta));
            if (rng.uniform() >= survival) return;
            beta /= survival;
        }
        const Vec3 wi = sample_phase(volume.phase, event.wo, rng.uniform2());
        light_ray = {Ray{event.x, wi, event.time}, phase_pdf(volume.phase, event.wo, wi), false,
                     competitor};
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
        segment = make_camera_segment(scene.media, camera_ray);
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
