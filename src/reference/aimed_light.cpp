#include "reference/aimed_light.h"

#include <algorithm>
#include <cmath>

#include "reference/direct_light.h"
#include "reference/visibility.h"

namespace mote {
namespace {

/// Narrower peaks alone are worth it (mean cosine).
constexpr float least_g = 0.4f;

/// Rays sought where a light scatters twice as much towards wo as if it did so evenly, were there
/// no smoke in its way. Measured on a cloud of optical depth 40: flat between 2 and 10.
constexpr float eagerness = 5.0f;

/// Where nothing is known of shadows.
constexpr float unknown_transmittance = 0.4f;

/// Of the lobes that a phase function has, the one that looks ahead most.
float forward_g(const Phase& phase)
{
    return phase.weight_b > 0.0f ? std::max(phase.g, phase.g_b) : phase.g;
}

/// About the share of the light that a ray towards it would find at its next event: in even smoke
/// exactly this, as transmittance grows on the way by as much as the ray's own falls.
float light_ahead(const TraceContext& context, Vec3 x, Vec3 to_light)
{
    constexpr float least = 1e-6f;
    constexpr float never_none = 0.01f;
    std::optional<float> guess;
    if (context.shadows) guess = context.shadows->to_infinity(x, to_light);
    const float T = std::max(guess.value_or(unknown_transmittance), least);
    return never_none - T * std::log(T);
}

}  // namespace

AimedLights find_aimed_lights(const Scene& scene)
{
    std::vector<DistantLight> found;
    for (const Light& light : scene.lights) {
        const auto* distant = std::get_if<DistantLight>(&light);
        if (!distant || !(max_component(distant->irradiance) > 0.0f)) continue;
        const auto same = [&](const DistantLight& l) { return l.direction == distant->direction; };
        const auto at = std::find_if(found.begin(), found.end(), same);
        if (at == found.end()) {
            found.push_back(*distant);
        } else {
            at->irradiance += distant->irradiance;
        }
    }
    const auto brightness = [](const DistantLight& l) { return luminance(l.irradiance); };
    std::stable_sort(found.begin(), found.end(),
                     [&](const auto& a, const auto& b) { return brightness(a) > brightness(b); });
    AimedLights out;
    out.count = static_cast<int>(std::min<size_t>(found.size(), AimedLights::most));
    for (int i = 0; i < out.count; ++i) {
        const DistantLight& light = found[static_cast<size_t>(i)];
        out.direction[i] = light.direction;
        out.irradiance[i] = light.irradiance;
        out.share[i] = brightness(light) / brightness(found.front());
    }
    return out;
}

Aim aim_at_lights(const TraceContext& context, const ScatterEvent& event)
{
    Aim aim;
    if (!context.aims || !event.phase || event.mixture) return aim;
    const float g = forward_g(*event.phase);
    if (!(g >= least_g)) return aim;
    aim.g = g;
    for (int i = 0; i < context.aims->count; ++i) {
        const Vec3 to_light = context.aims->direction[i];
        // Two lobes one after the other make one of the product of their mean cosines.
        const float lobes = 4.0f * pi * eval_hg(-glm::dot(event.wo, to_light), g * g);
        const float worth =
            context.aims->share[i] * lobes * light_ahead(context, event.x, to_light);
        aim.q[i] = std::min(1.0f, eagerness * worth);
    }
    return aim;
}

AimedArrival seek_light(const TraceContext& context, const ScatterEvent& event, const Aim& aim,
                        int light, Rng& rng)
{
    AimedArrival out;
    if (!(aim.q[light] > 0.0f) || rng.uniform() >= aim.q[light]) return out;
    const Scene& scene = context.scene;
    const Vec3 to_light = context.aims->direction[light];
    out.wi = sample_phase(Phase{aim.g}, -to_light, rng.uniform2());
    const Ray ray{event.x, out.wi, event.time};
    Interval range{0.0f, infinity};
    if (scene.surfaces) {
        const std::optional<SurfaceHit> hit = intersect(*scene.surfaces, ray, range);
        if (hit) range.t1 = hit->t;
    }
    const std::optional<Collision> collision = sample_free_flight(scene.media, ray, range, rng);
    if (!collision) return out;
    const Volume& volume = scene.media.volumes[static_cast<size_t>(collision->volume)];
    const ScatterEvent next{ray.at(collision->t), -out.wi, event.time, &volume.phase};
    const float pdf_dir = phase_pdf(*event.phase, event.wo, out.wi);
    const float scattered = eval_phase(volume.phase, next.wo, to_light) /
                            (pdf_dir + aim.density(light, to_light, out.wi));
    out.E = albedo_at(volume, collision->p_object) * context.aims->irradiance[light] *
            (scattered * estimate_visibility(context, next, to_light, infinity, rng));
    return out;
}

Spectrum estimate_aimed_light(const TraceContext& context, const ScatterEvent& event,
                              const Aim& aim, Rng& rng)
{
    Spectrum sum(0.0f);
    if (!context.aims) return sum;
    for (int i = 0; i < context.aims->count; ++i) {
        const AimedArrival arrival = seek_light(context, event, aim, i, rng);
        if (arrival.E == Spectrum(0.0f)) continue;
        sum += eval_phase(*event.phase, event.wo, arrival.wi) * arrival.E;
    }
    return sum;
}

Spectrum estimate_direct_light_after(const TraceContext& context, const ScatterEvent& event,
                                     const Aim& before, float pdf_dir, Rng& rng)
{
    const std::optional<ShadowRay> ray = sample_shadow_ray(context, event, rng);
    if (!ray || ray->scattering.f == Spectrum(0.0f)) return Spectrum(0.0f);
    float weight = 1.0f;
    const int count = context.aims && event.phase ? context.aims->count : 0;
    for (int i = 0; i < count; ++i) {
        if (ray->wi != context.aims->direction[i]) continue;
        weight = pdf_dir / (pdf_dir + before.density(i, ray->wi, -event.wo));
    }
    return ray->light * ray->scattering.f *
           (weight * estimate_visibility(context, event, ray->wi, ray->distance, rng));
}

}  // namespace mote
