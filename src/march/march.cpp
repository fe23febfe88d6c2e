#include "march/march.h"

#include <algorithm>

#include "scene/environment.h"
#include "volumes/emission.h"
#include "volumes/media_at.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

/// Light behind this transmittance is left out.
constexpr float opaque = 1e-4f;
/// Steps of one ray at most: a grid of tiny voxels in a huge scene must end.
constexpr float most_steps = 1e5f;

/// Where a ray may meet media.
Interval media_interval(const std::vector<Bounds3>& volumes, const Ray& ray)
{
    Interval all{infinity, -infinity};
    for (const Bounds3& bounds : volumes) {
        if (bounds.is_empty()) continue;
        const Interval part = clip(ray.o, ray.d, bounds, {0.0f, infinity});
        if (part.is_empty()) continue;
        all.t0 = std::min(all.t0, part.t0);
        all.t1 = std::max(all.t1, part.t1);
    }
    return all;
}

/// Lamps that the ray meets, nearest first.
std::vector<LightHit> lamps_on_ray(const Scene& scene, const Ray& ray)
{
    std::vector<LightHit> hits;
    for (const Light& light : scene.lights) {
        const std::optional<LightHit> hit = hit_light(light, ray.o, ray.d);
        if (hit) hits.push_back(*hit);
    }
    std::sort(hits.begin(), hits.end(),
              [](const LightHit& a, const LightHit& b) { return a.distance < b.distance; });
    return hits;
}

}  // namespace

Marcher::Marcher(const Scene& scene, const MarchParams& params, std::vector<MarchLight> lights,
                 std::shared_ptr<const ShadowGrid> shadows)
    : scene_(&scene),
      lights_(std::move(lights)),
      shadows_(std::move(shadows)),
      step_(params.step * finest_voxel(scene.media))
{
    for (const Volume& volume : scene.media.volumes) bounds_.push_back(world_bounds(volume));
}

Marcher::Marcher(const Scene& scene, const MarchParams& params)
    : Marcher(scene, params, march_lights(scene, params.sky_bands),
              std::make_shared<const ShadowGrid>(scene.media, march_lights(scene, params.sky_bands),
                                                 params))
{
}

Spectrum Marcher::in_scatter(Vec3 x, Vec3 wo, float& sigma_t, Spectrum& emitted) const
{
    Spectrum sum(0.0f);
    std::optional<ShadowGrid::Place> place;
    for_each_medium_at(
        scene_->media, x, cache_time, [&](const Volume& volume, Vec3 local, float s) {
            sigma_t += s;
            if (!place) place = shadows_->place(x);
            const Spectrum sigma_s = s * albedo_at(volume, object_from_local(volume).point(local));
            for (size_t i = 0; i < lights_.size(); ++i) {
                const MarchArrival a = arrival(lights_[i], x);
                sum += sigma_s * a.Li *
                       (eval_phase(volume.phase, wo, a.wi) * shadows_->transmittance(*place, i));
            }
        });
    for (const Volume& volume : scene_->media.volumes) {
        if (!volume.emission_params.is_on()) continue;
        emitted += emission_at(volume, object_point(volume, x, cache_time));
    }
    return sum;
}

MarchResult Marcher::march(const Ray& ray) const
{
    MarchResult result;
    const Interval range = media_interval(bounds_, ray);
    const std::vector<LightHit> lamps = lamps_on_ray(*scene_, ray);
    size_t next_lamp = 0;
    const auto add_lamps_before = [&](float t) {
        for (; next_lamp < lamps.size() && lamps[next_lamp].distance <= t; ++next_lamp) {
            result.background += result.transmittance * lamps[next_lamp].Le;
        }
    };
    if (!range.is_empty()) {
        const float length = range.t1 - range.t0;
        const float count = std::clamp(std::ceil(length / step_), 1.0f, most_steps);
        const float step = length / count;
        for (float i = 0.0f; i < count && result.transmittance > opaque; i += 1.0f) {
            const float t = range.t0 + step * (i + 0.5f);
            add_lamps_before(t);
            float sigma_t = 0.0f;
            Spectrum emitted(0.0f);
            const Spectrum scattered = in_scatter(ray.at(t), -ray.d, sigma_t, emitted);
            ++result.steps;
            // Both sources and extinction as constant over the step.
            const float tau = sigma_t * step;
            const float lost = -std::expm1(-tau);
            const float seen = result.transmittance * (tau > 0.0f ? lost / sigma_t : step);
            result.direct += seen * scattered;
            result.emission += seen * emitted;
            result.transmittance *= 1.0f - lost;
        }
    }
    add_lamps_before(infinity);
    if (scene_->environment) {
        result.background +=
            result.transmittance * environment_radiance(*scene_->environment, ray.d);
    }
    return result;
}

}  // namespace mote
