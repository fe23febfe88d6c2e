#include "reference/direct_light.h"

#include "reference/mis.h"
#include "reference/visibility.h"
#include "scene/environment.h"

namespace mote {
namespace {

/// MIS weight of a shadow ray of density `pdf_light` against a scattered ray of density `pdf_phase`
/// and against equiangular sampling.
float shadow_ray_weight(const PathTracerParams& params, float pdf_light, float pdf_phase,
                        float pdf_equiangular = 0.0f)
{
    if (params.light_strategy == LightStrategy::NextEvent) pdf_phase = 0.0f;
    return mis_weight(params.mis, pdf_light, pdf_phase, pdf_equiangular);
}

/// MIS weight of light met by a ray that a shadow ray would have found with `pdf_light`.
float seen_weight(const PathTracerParams& params, float pdf_ray, float pdf_light,
                  float pdf_equiangular = 0.0f)
{
    if (!(pdf_light > 0.0f)) return 1.0f;
    if (params.light_strategy == LightStrategy::NextEvent) return 0.0f;
    return mis_weight(params.mis, pdf_ray, pdf_light, pdf_equiangular);
}

/// Density of meeting a point of an emissive volume along a scattered ray [1/m^3]: distances count
/// as uniform over the volume's size. Any positive function gives weights that sum to 1.
float seen_emission_pdf(const EmissiveVolume& emissive, float pdf_dir, float distance2)
{
    return pdf_dir / (distance2 * emissive.length);
}

std::optional<ShadowRay> sample_emission_ray(const TraceContext& context, const ScatterEvent& event,
                                             const LightChoice& choice, Rng& rng)
{
    const EmissiveVolume& emissive =
        context.lights.emissive_volumes()[static_cast<size_t>(choice.index)];
    const Media& media = context.scene.media;
    const Volume& volume = media.volumes[static_cast<size_t>(emissive.volume)];
    const EmissionSample sample = sample_emission(volume, emissive.bricks, event.time, rng);
    const Vec3 to_point = sample.p - event.x;
    const float distance2 = glm::dot(to_point, to_point);
    if (!(distance2 > 0.0f) || !(max_component(sample.j) > 0.0f)) return std::nullopt;
    const float distance = std::sqrt(distance2);
    const Vec3 wi = to_point / distance;
    const Scattering scattering = eval_scattering(event, wi);
    const float pdf = choice.pmf * sample.pdf_volume;  // [1/m^3]
    const float weight = shadow_ray_weight(
        context.params, pdf, seen_emission_pdf(emissive, scattering.pdf_dir, distance2));
    return ShadowRay{wi, distance, sample.j * (weight / (distance2 * pdf)), scattering};
}

}  // namespace

std::optional<ShadowRay> sample_shadow_ray(const TraceContext& context, const ScatterEvent& event,
                                           Rng& rng)
{
    const std::optional<LightChoice> choice = context.lights.choose(event.x, rng, context.guide);
    if (!choice) return std::nullopt;
    if (choice->source == LightSource::EmissiveVolume) {
        return sample_emission_ray(context, event, *choice, rng);
    }
    const std::optional<LightSample> sample =
        choice->source == LightSource::Environment
            ? sample_environment(*context.scene.environment, rng)
            : sample_light(context.scene.lights[static_cast<size_t>(choice->index)], event.x,
                           rng.uniform2());
    if (!sample) return std::nullopt;
    const Scattering scattering = eval_scattering(event, sample->wi);
    const float pdf = choice->pmf * sample->pdf_dir;
    float pdf_equiangular = 0.0f;
    if (event.first && choice->source == LightSource::Lamp) {
        pdf_equiangular = equiangular_ratio(context, *event.first, choice->index) * sample->pdf_dir;
    }
    const float weight = shadow_ray_weight(
        context.params, pdf, sample->is_delta ? 0.0f : scattering.pdf_dir, pdf_equiangular);
    if (!(weight > 0.0f) || !(max_component(sample->Li) > 0.0f)) return std::nullopt;
    return ShadowRay{sample->wi, sample->distance, sample->Li * (weight / pdf), scattering};
}

Spectrum estimate_direct_light(const TraceContext& context, const ScatterEvent& event, Rng& rng)
{
    const std::optional<ShadowRay> ray = sample_shadow_ray(context, event, rng);
    if (!ray || ray->scattering.f == Spectrum(0.0f)) return Spectrum(0.0f);
    return ray->light * ray->scattering.f *
           estimate_visibility(context, event, ray->wi, ray->distance, rng);
}

SeenLight seen_light(const TraceContext& context, const LightRay& light_ray,
                     std::optional<float> t_end, Rng& rng)
{
    const Ray& ray = light_ray.ray;
    const auto visibility = [&](float t) {
        if (t_end) return *t_end >= t ? 1.0f : 0.0f;
        if (t > light_ray.t_surface) return 0.0f;
        return estimate_attenuation(context, ray, t, rng);
    };
    SeenLight seen;
    if (context.lights.has_surfaces()) {
        context.lights.for_each_lamp_on_ray(ray, [&](int index) {
            const Light& light = context.scene.lights[static_cast<size_t>(index)];
            const std::optional<LightHit> hit = hit_light(light, ray.o, ray.d);
            if (!hit) return;
            float weight = 1.0f;
            if (!light_ray.is_camera) {
                const float pdf_dir = light_pdf(light, ray.o, ray.d);
                const float pmf =
                    context.lights.pmf(LightSource::Lamp, index, ray.o, context.guide);
                const float ratio =
                    light_ray.first ? equiangular_ratio(context, *light_ray.first, index) : 0.0f;
                weight =
                    seen_weight(context.params, light_ray.pdf_dir, pmf * pdf_dir, ratio * pdf_dir);
            }
            if (weight > 0.0f)
                seen.lamps += hit->Le * (weight * visibility(clear_distance(hit->distance)));
        });
    }
    const auto& environment = context.scene.environment;
    if (!environment || (t_end && *t_end < infinity)) return seen;
    if (light_ray.t_surface < infinity) return seen;
    float weight = 1.0f;
    if (!light_ray.is_camera) {
        const float pmf = context.lights.pmf(LightSource::Environment, 0, ray.o);
        const float pdf_light = pmf * environment_pdf(*environment, ray.d);
        weight = seen_weight(context.params, light_ray.pdf_dir, pdf_light);
    }
    if (weight > 0.0f) {
        seen.environment =
            environment_radiance(*environment, ray.d) * (weight * visibility(infinity));
    }
    return seen;
}

Spectrum seen_surface_light(const TraceContext& context, const LightRay& light_ray,
                            const SurfaceVertex& vertex)
{
    const Spectrum Le = surface_emission(vertex, -light_ray.ray.d);
    if (light_ray.is_camera || !(max_component(Le) > 0.0f)) return Le;
    const auto object = static_cast<size_t>(vertex.object);
    const int index = context.scene.first_light_of_object[object] + vertex.triangle;
    const Light& light = context.scene.lights[static_cast<size_t>(index)];
    const Ray& ray = light_ray.ray;
    const float pmf = context.lights.pmf(LightSource::Lamp, index, ray.o, context.guide);
    const float pdf_light = pmf * light_pdf(light, ray.o, ray.d);
    return seen_weight(context.params, light_ray.pdf_dir, pdf_light) * Le;
}

Spectrum seen_emission(const TraceContext& context, const LightRay& light_ray, float t_end,
                       Rng& rng)
{
    Spectrum sum(0.0f);
    const Ray& ray = light_ray.ray;
    const std::vector<EmissiveVolume>& emissive_volumes = context.lights.emissive_volumes();
    for (size_t i = 0; i < emissive_volumes.size(); ++i) {
        const EmissiveVolume& emissive = emissive_volumes[i];
        const Volume& volume = context.scene.media.volumes[static_cast<size_t>(emissive.volume)];
        const float pmf = light_ray.is_camera ? 0.0f
                                              : context.lights.pmf(LightSource::EmissiveVolume,
                                                                   static_cast<int>(i), ray.o);
        if (!(pmf > 0.0f)) {
            sum += estimate_emission(volume, ray, {0.0f, t_end}, rng);
            continue;
        }
        const auto weight = [&](float t, Vec3 p_object) {
            const float pdf_light = pmf * emission_pdf(volume, emissive.bricks, ray.time, p_object);
            const float pdf_ray = seen_emission_pdf(emissive, light_ray.pdf_dir, t * t);
            return seen_weight(context.params, pdf_ray, pdf_light);
        };
        sum += estimate_emission(volume, ray, {0.0f, t_end}, rng, weight);
    }
    return sum;
}

}  // namespace mote
