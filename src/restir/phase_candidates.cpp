#include "restir/phase_candidates.h"

#include <algorithm>

#include "restir/mixed_phase.h"
#include "scene/environment.h"
#include "volumes/emissive_line.h"

namespace mote {
namespace {

/// The two numbers for which sample_light returns a point of a quad.
Vec2 quad_numbers(const QuadLight& quad, Vec3 p)
{
    const Vec3 normal = glm::cross(quad.edge_u, quad.edge_v);
    const float inv = 1.0f / glm::dot(normal, normal);
    const Vec3 q = p - quad.corner;
    return {glm::dot(glm::cross(q, quad.edge_v), normal) * inv,
            glm::dot(glm::cross(quad.edge_u, q), normal) * inv};
}

}  // namespace

bool is_found_by_phase(const FrameDomain& frame, int light)
{
    const SampledLight& sampled = frame.lights[static_cast<size_t>(light)];
    if (sampled.kind == SampledLightKind::Lamp) {
        return std::holds_alternative<QuadLight>(
            frame.scene->lights[static_cast<size_t>(sampled.index)]);
    }
    return sampled.kind != SampledLightKind::Distant;
}

float phase_candidate_density(const FrameDomain& frame, Vec3 x, float time, Vec3 wo,
                              const PathSample& y, const Arrival& arrival)
{
    if (!frame.has_phase_candidates || !is_found_by_phase(frame, y.light)) return 0.0f;
    const float phase = mixed_phase_at(frame.scene->media, x, time).pdf(wo, arrival.wi);
    const SampledLight& light = frame.lights[static_cast<size_t>(y.light)];
    switch (light.kind) {
        case SampledLightKind::Environment:
            return phase;
        case SampledLightKind::EmissiveVolume: {
            const auto i = static_cast<size_t>(light.index);
            const float pdf =
                emissive_line_pdf(frame.scene->media.volumes[i], *frame.caches->emissive[i],
                                  {x, arrival.wi, time}, arrival.distance);
            const float density = phase * pdf / sqr(arrival.distance);
            return density < infinity ? density : 0.0f;
        }
        default: {
            const Light& lamp = frame.scene->lights[static_cast<size_t>(light.index)];
            const float pdf_dir = light_pdf(lamp, x, arrival.wi);
            return pdf_dir > 0.0f ? phase / pdf_dir : 0.0f;
        }
    }
}

void for_each_phase_hit(const FrameDomain& frame, Vec3 x, float time, Vec3 wo, Rng& rng,
                        const std::function<void(const PhaseHit&)>& f)
{
    const MixedPhase phase = mixed_phase_at(frame.scene->media, x, time);
    if (phase.empty()) return;
    const float choice = rng.uniform();
    const Vec3 wi = phase.sample(wo, choice, rng.uniform2());
    const auto report = [&](int light, Vec3 v, float light_density) {
        PhaseHit hit;
        hit.light = light;
        hit.v = v;
        const std::optional<Arrival> arrival = light_at(frame, {0.0f, light, v}, x, time);
        if (!arrival) return;
        hit.arrival = *arrival;
        hit.light_density = light_density;
        hit.phase_density =
            phase_candidate_density(frame, x, time, wo, {0.0f, light, v}, hit.arrival);
        if (hit.phase_density > 0.0f) f(hit);
    };
    for (const int index : frame.phase_lights) {
        const SampledLight& light = frame.lights[static_cast<size_t>(index)];
        switch (light.kind) {
            case SampledLightKind::Environment:
                report(index, wi, environment_pdf(*frame.scene->environment, wi));
                break;
            case SampledLightKind::EmissiveVolume: {
                const auto i = static_cast<size_t>(light.index);
                const Volume& volume = frame.scene->media.volumes[i];
                const std::optional<LineSample> sample = sample_emissive_line(
                    volume, *frame.caches->emissive[i], {x, wi, time}, rng.uniform());
                if (!sample) break;
                const Vec3 p = x + sample->t * wi;
                report(index, p,
                       emission_pdf(volume, *frame.caches->emissive[i], time,
                                    object_point(volume, p, time)));
                break;
            }
            default: {
                const auto& lamp = frame.scene->lights[static_cast<size_t>(light.index)];
                const std::optional<LightHit> hit = hit_light(lamp, x, wi);
                if (!hit) break;
                const Vec2 u = quad_numbers(std::get<QuadLight>(lamp), x + hit->distance * wi);
                const Vec2 inside = glm::clamp(u, Vec2(0.0f), Vec2(one_minus_epsilon));
                report(index, Vec3(inside.x, inside.y, 0.0f), 1.0f);
                break;
            }
        }
    }
}

}  // namespace mote
