#include "reference/equiangular.h"

#include "reference/mis.h"
#include "reference/visibility.h"
#include "volumes/local_ray.h"

namespace mote {
namespace {

/// From lamps further away, all of the segment is about as far, and floats tell its distances apart
/// no better than to 0.1 %: such lamps attract nothing.
constexpr float least_angle = 1e-4f;

/// Distances t with density proportional to 1 / (closest^2 + (t - nearest)^2).
struct Equiangular {
    float nearest;
    float closest;
    float theta0;
    float theta1;
};

Equiangular make_equiangular(const CameraSegment& segment, const SmallLamp& lamp)
{
    const Vec3 to_lamp = lamp.position - segment.ray.o;
    const float nearest = glm::dot(to_lamp, segment.ray.d);
    const float miss = glm::length(to_lamp - nearest * segment.ray.d);
    // Any positive floor gives a valid density; this one keeps a ray through the lamp finite.
    const float floor = 1e-4f * (segment.range.t1 - segment.range.t0);
    const float closest = std::max({miss, lamp.radius, floor});
    return {nearest, closest, std::atan((segment.range.t0 - nearest) / closest),
            std::atan((segment.range.t1 - nearest) / closest)};
}

float pdf_dist(const Equiangular& e, float t)
{
    const float angle = e.theta1 - e.theta0;
    if (!(angle >= least_angle)) return 0.0f;
    return e.closest / (angle * (sqr(e.closest) + sqr(t - e.nearest)));
}

/// Extinction of each volume at a point, found through one of them drawn in proportion to it.
struct MediumSample {
    float sigma_t = 0.0f;  ///< of all volumes [1/m]
    const Volume* volume = nullptr;
    Vec3 p_object{0.0f};
};

MediumSample sample_medium(const Media& media, Vec3 x, float time, Rng* rng)
{
    MediumSample out;
    for (const Volume& volume : media.volumes) {
        if (!volume.density || volume.density->index_bounds.is_empty()) continue;
        const GridFrame frame =
            volume.at_rest ? volume.at_rest->density : frames_at(volume, time).density;
        const Vec3 local(frame.point(x));
        const float sigma_t = volume.density_scale * sample_local(*volume.density, local);
        if (!(sigma_t > 0.0f)) continue;
        out.sigma_t += sigma_t;
        if (rng && (!out.volume || rng->uniform() * out.sigma_t < sigma_t)) {
            out.volume = &volume;
            out.p_object = object_from_local(volume).point(local);
        }
    }
    return out;
}

float exact_transmittance(const Media& media, const Ray& ray, float t)
{
    return std::exp(-optical_depth(media, ray, {0.0f, t}));
}

}  // namespace

std::optional<SmallLamp> small_lamp(const Light& light)
{
    if (const auto* point = std::get_if<PointLight>(&light))
        return SmallLamp{point->position, 0.0f};
    if (const auto* spot = std::get_if<SpotLight>(&light)) return SmallLamp{spot->position, 0.0f};
    if (const auto* sphere = std::get_if<SphereLight>(&light)) {
        return SmallLamp{sphere->position, sphere->radius};
    }
    return std::nullopt;
}

std::optional<CameraSegment> make_camera_segment(const Media& media, const Ray& ray, float t_max)
{
    Interval range{infinity, 0.0f};
    for (const Volume& volume : media.volumes) {
        const Interval inside = volume_interval(volume, ray, {0.0f, t_max});
        if (inside.is_empty()) continue;
        range.t0 = std::min(range.t0, inside.t0);
        range.t1 = std::max(range.t1, inside.t1);
    }
    if (range.is_empty()) return std::nullopt;
    return CameraSegment{ray, range, ray.at(0.5f * (range.t0 + range.t1))};
}

FirstEvent make_first_event(const Media& media, const CameraSegment& segment, float t)
{
    const Ray& ray = segment.ray;
    const float sigma_t = sample_medium(media, ray.at(t), ray.time, nullptr).sigma_t;
    return {&segment, t, sigma_t * exact_transmittance(media, ray, t)};
}

float equiangular_ratio(const TraceContext& context, const FirstEvent& event, int lamp)
{
    const auto attractor = small_lamp(context.scene.lights[static_cast<size_t>(lamp)]);
    if (!attractor) return 0.0f;
    const CameraSegment& segment = *event.segment;
    const float pmf = context.lights.pmf(LightSource::Lamp, lamp, segment.middle);
    return pmf * pdf_dist(make_equiangular(segment, *attractor), event.t) / event.flight_pdf;
}

Spectrum estimate_equiangular(const TraceContext& context, const CameraSegment& segment, Rng& rng)
{
    const std::optional<LightChoice> choice = context.lights.choose(segment.middle, rng);
    if (!choice || choice->source != LightSource::Lamp) return Spectrum(0.0f);
    const Light& light = context.scene.lights[static_cast<size_t>(choice->index)];
    const std::optional<SmallLamp> attractor = small_lamp(light);
    if (!attractor) return Spectrum(0.0f);
    const Media& media = context.scene.media;
    const Ray& ray = segment.ray;
    const Equiangular distances = make_equiangular(segment, *attractor);
    const float theta = distances.theta0 + rng.uniform() * (distances.theta1 - distances.theta0);
    const float t = std::clamp(distances.nearest + distances.closest * std::tan(theta),
                               segment.range.t0, segment.range.t1);
    const float pdf = choice->pmf * pdf_dist(distances, t);  // [1/m]
    if (!(pdf > 0.0f)) return Spectrum(0.0f);

    const Vec3 x = ray.at(t);
    const MediumSample medium = sample_medium(media, x, ray.time, &rng);
    if (!medium.volume) return Spectrum(0.0f);
    const auto sample = sample_light(light, x, rng.uniform2());
    if (!sample || !(max_component(sample->Li) > 0.0f)) return Spectrum(0.0f);
    const float flight_pdf = medium.sigma_t * exact_transmittance(media, ray, t);
    if (!(flight_pdf > 0.0f)) return Spectrum(0.0f);

    const float phase = eval_phase(medium.volume->phase, -ray.d, sample->wi);
    const bool phase_competes =
        !sample->is_delta && context.params.light_strategy != LightStrategy::NextEvent;
    const float pmf_at_x = context.lights.pmf(LightSource::Lamp, choice->index, x);
    const float weight = mis_weight(context.params.mis, pdf * sample->pdf_dir,
                                    flight_pdf * pmf_at_x * sample->pdf_dir,
                                    phase_competes ? flight_pdf * phase : 0.0f);
    if (!(weight > 0.0f)) return Spectrum(0.0f);
    const Spectrum albedo = albedo_at(*medium.volume, medium.p_object);
    const ScatterEvent event{x, -ray.d, ray.time, &medium.volume->phase, nullptr, nullptr};
    return albedo * sample->Li * (weight * phase * (flight_pdf / pdf) / sample->pdf_dir) *
           estimate_visibility(context, event, sample->wi, sample->distance, rng);
}

}  // namespace mote
