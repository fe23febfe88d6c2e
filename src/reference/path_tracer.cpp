#include "reference/path_tracer.h"

#include "reference/direct_light.h"
#include "reference/trace_segment.h"

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

/// Where a path is followed from: the ray it goes on along, what it carries, and the events behind
/// it.
struct PathState {
    LightRay light_ray;
    Spectrum beta{1.0f};
    int event_count = 0;
    bool first_is_surface = false;
    Aim aim{};  ///< of the event that the ray has left
};

/// The ray on which light scattered at the event arrives; empty if nothing is scattered. What
/// becomes of it goes into beta.
std::optional<LightRay> scattered_ray(const ScatterEvent& event, Rng& rng, Spectrum& beta)
{
    const std::optional<ScatteredDirection> s = sample_scattering(event, rng);
    if (!s) return std::nullopt;
    beta *= s->scattering.f / s->scattering.pdf_dir;
    return LightRay{Ray{ray_origin(event, s->wi), s->wi, event.time}, s->scattering.pdf_dir, false,
                    event.first};
}

/// Follows a path and adds what it brings. `segment`: the camera ray, if equiangular sampling takes
/// part.
void follow(const TraceContext& context, const PathState& start,
            const std::optional<CameraSegment>& segment, Rng& rng, PathResult& result)
{
    LightRay light_ray = start.light_ray;
    Spectrum beta = start.beta;
    int event_count = start.event_count;
    bool first_is_surface = start.first_is_surface;
    Aim aim = start.aim;
    const Scene& scene = context.scene;
    const PathTracerParams& params = context.params;
    FirstEvent first;
    for (;; ++event_count) {
        const bool is_last = event_count == params.max_bounces;
        const auto add = [&](Spectrum& camera_part, Spectrum light) {
            (event_count == 0 ? camera_part : part_of(result, event_count, first_is_surface)) +=
                beta * light;
        };
        const TracedSegment found =
            trace_segment(context, light_ray, is_last && event_count > 0, rng);
        add(result.emission, found.emission);
        add(result.background, found.background());
        if (event_count == 1) result.sky += beta * found.seen.environment;
        add(result.surface_emission, found.surface_emission);
        const std::optional<Collision>& collision = found.collision;
        const std::optional<SurfaceVertex>& vertex = found.vertex;
        const Ray& ray = light_ray.ray;

        const bool goes_on = event_count > 0 || collision || vertex;
        if (is_last && goes_on) result.cut = max_component(beta);
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
            result.depth = collision ? collision->t : light_ray.t_surface;
            result.albedo = albedo;
            result.object = collision ? -1 : vertex->object;
        }
        if (is_last) return;

        if (collision) beta *= albedo;
        if (!(max_component(beta) > 0.0f)) return;
        if (segment && event_count == 0 && collision) {
            first = make_first_event(scene.media, *segment, collision->t);
            event.first = &first;
        }
        part_of(result, event_count + 1, first_is_surface) +=
            beta * estimate_direct_light_after(context, event, aim, light_ray.pdf_dir, rng);
        aim = event_count + 2 <= params.max_bounces ? aim_at_lights(context, event) : Aim{};
        part_of(result, event_count + 2, first_is_surface) +=
            beta * estimate_aimed_light(context, event, aim, rng);

        const std::optional<LightRay> scattered = scattered_ray(event, rng, beta);
        if (!scattered) return;
        if (event_count + 1 > params.roulette_start) {
            const float survival = std::min(1.0f, max_component(beta));
            if (rng.uniform() >= survival) return;
            beta /= survival;
        }
        light_ray = *scattered;
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
    follow(context, {{camera_ray}}, segment, rng, result);
    return result;
}

PathResult trace_after_event(const TraceContext& context, const ScatterEvent& first, Rng& rng)
{
    PathResult result;
    Spectrum beta(1.0f);
    const std::optional<LightRay> scattered = scattered_ray(first, rng, beta);
    if (!scattered) return result;
    const Aim aim = context.params.max_bounces > 1 ? aim_at_lights(context, first) : Aim{};
    result.indirect += estimate_aimed_light(context, first, aim, rng);
    follow(context, {*scattered, beta, 1, first.surface != nullptr, aim}, std::nullopt, rng,
           result);
    return result;
}

Spectrum trace_scattered_ray(const TraceContext& context, const LightRay& light_ray,
                             int event_count, const Aim& aim, Rng& rng, float& cut)
{
    PathResult result;
    follow(context, {light_ray, Spectrum(1.0f), event_count, false, aim}, std::nullopt, rng,
           result);
    cut += result.cut;
    return result.direct + result.indirect;
}

}  // namespace mote
