#include "restir/candidates.h"

#include <algorithm>
#include <cmath>

#include "core/distribution.h"
#include "restir/direction_hits.h"
#include "restir/mixed_phase.h"
#include "scene/environment.h"

namespace mote {
namespace {

/// Fills f from point, arrival and domain; false if it brings nothing.
bool set_contribution(const FrameDomain& frame, const PixelDomain& domain, const RayPoint& point,
                      Candidate& c)
{
    const Spectrum scattering =
        scattering_at(frame, c.x, domain.ray.time, domain.wo(), c.arrival.wi);
    c.f = point.weight * scattering * c.arrival.L;
    return is_finite(c.f) && max_component(c.f) > 0.0f;
}

}  // namespace

std::optional<LightPoint> sample_light_point(const FrameDomain& frame, const SampledLight& light,
                                             float time, Rng& rng)
{
    switch (light.kind) {
        case SampledLightKind::Lamp: {
            const Vec2 u = rng.uniform2();
            return LightPoint{Vec3(u.x, u.y, 0.0f), 1.0f};
        }
        case SampledLightKind::Distant:
            return LightPoint{};
        case SampledLightKind::Environment: {
            const auto sample = sample_environment(*frame.scene->environment, rng);
            if (!sample) return std::nullopt;
            return LightPoint{sample->wi, sample->pdf_dir};
        }
        case SampledLightKind::EmissiveVolume: {
            const auto i = static_cast<size_t>(light.index);
            const EmissionSample sample = sample_emission(frame.scene->media.volumes[i],
                                                          *frame.caches->emissive[i], time, rng);
            return LightPoint{sample.p, sample.pdf_volume};
        }
    }
    return std::nullopt;
}

Candidate evaluate(const FrameDomain& frame, const PixelDomain& domain, const PathSample& y)
{
    Candidate c;
    c.y = y;
    const RayPoint point = point_at(frame, domain, y.u);
    if (!(point.weight > 0.0f)) return c;
    c.x = point.x;
    const std::optional<Arrival> arrival = light_at(frame, y, point.x, domain.ray.time);
    if (!arrival) return c;
    c.arrival = *arrival;
    if (!set_contribution(frame, domain, point, c)) c.f = Spectrum(0.0f);
    return c;
}

void draw_candidates(const FrameDomain& frame, const PixelDomain& domain, int count, Rng& rng,
                     std::vector<Candidate>& out)
{
    if (!(domain.Z() > 0.0f) || !frame.has_sampled_lights()) return;
    const float time = domain.ray.time;
    const Vec3 wo = domain.wo();
    const double u_light = uniform_double(rng);
    for (int i = 0; i < count; ++i) {
        const auto index = static_cast<float>(i);
        Candidate c;
        c.y.u = std::min((index + rng.uniform()) / static_cast<float>(count), one_minus_epsilon);
        const RayPoint point = point_at(frame, domain, c.y.u);
        if (!(point.weight > 0.0f)) continue;
        c.x = point.x;
        MixedPhase phase;
        if (frame.phase_finds.any()) phase = mixed_phase_at(frame.scene->media, point.x, time);

        // Golden-ratio steps: few lights per pixel, far apart in the cell's order. In double: among
        // thousands of lamps a float's steps are as large as the share of one.
        double u = u_light + 0.6180339887498949 * i;
        u -= std::floor(u);
        const SampledChoice choice = choose_light(frame, point.x, wo, u);
        if (choice.light >= 0 && choice.pmf > 0.0f) {
            const SampledLight& light = frame.lights[static_cast<size_t>(choice.light)];
            c.y.light = choice.light;
            const auto light_point = sample_light_point(frame, light, time, rng);
            if (light_point && light_point->density > 0.0f) {
                c.y.v = light_point->v;
                if (const auto arrival = light_at(frame, c.y, point.x, time)) {
                    c.arrival = *arrival;
                    c.density = choice.pmf * light_point->density;
                    if (!phase.empty()) {
                        c.density += phase.pdf(wo, arrival->wi) *
                                     density_per_direction(frame, frame.phase_finds, point.x, time,
                                                           c.y, *arrival);
                    }
                    c.density *= static_cast<float>(count);
                    if (set_contribution(frame, domain, point, c)) out.push_back(c);
                }
            }
        }
        if (phase.empty()) continue;
        const float u_phase = rng.uniform();
        const Vec3 wi = phase.sample(wo, u_phase, rng.uniform2());
        const float pdf_dir = phase.pdf(wo, wi);
        const auto add_hit = [&](const DirectionHit& hit) {
            Candidate p;
            p.y = {c.y.u, hit.light, hit.v};
            p.x = point.x;
            p.arrival = hit.arrival;
            const float pmf = light_pmf(frame, hit.light, point.x, wo);
            p.density =
                static_cast<float>(count) * (pmf * hit.light_density + pdf_dir * hit.per_direction);
            if (set_contribution(frame, domain, point, p)) out.push_back(p);
        };
        for_each_light_along(frame, frame.phase_finds, {point.x, wi, time}, rng.uniform(), add_hit);
    }
}

}  // namespace mote
