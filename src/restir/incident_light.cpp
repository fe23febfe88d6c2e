#include "restir/incident_light.h"

#include <algorithm>
#include <variant>

#include "scene/environment.h"
#include "volumes/emission.h"
#include "volumes/media_at.h"

namespace mote {
namespace {

/// Share of the choice that is spread evenly over lights at infinity and the local lights
/// together, whatever the caches say.
constexpr float choice_floor = 0.05f;

std::optional<Arrival> arrival_of(const std::optional<LightSample>& sample)
{
    if (!sample || !(sample->pdf_dir > 0.0f)) return std::nullopt;
    return Arrival{sample->wi, sample->distance, sample->Li / sample->pdf_dir};
}

std::optional<Arrival> emission_arrival(const Volume& volume, Vec3 p, Vec3 x, float time)
{
    const Vec3 to_point = p - x;
    const float distance2 = glm::dot(to_point, to_point);
    if (!(distance2 > 0.0f)) return std::nullopt;
    const Spectrum j = emission_at(volume, object_point(volume, p, time));
    const float distance = std::sqrt(distance2);
    return Arrival{to_point / distance, distance, j / distance2};
}

/// Expected luminance of one light at infinity scattered at x.
float infinite_inscatter(const FrameDomain& frame, const SampledLight& light, Vec3 x, Vec3 wo)
{
    const LightCaches& caches = *frame.caches;
    float sum = 0.0f;
    const bool is_environment = light.kind == SampledLightKind::Environment;
    if (is_environment && caches.environment) {
        sum = luminance(caches.environment->inscatter(0, x));
    }
    for (const LightCaches::Distant& distant : caches.distant) {
        const bool belongs = is_environment ? distant.spot >= 0 : distant.light == light.index;
        if (!belongs) continue;
        const Phase& phase = frame.scene->media.volumes.front().phase;
        sum += luminance(distant.irradiance) * eval_phase(phase, wo, distant.direction) *
               distant.map->transmittance(x);
    }
    return sum;
}

float local_inscatter(const FrameDomain& frame, Vec3 x)
{
    return frame.samples_local ? frame.caches->cells->inscatter(x) : 0.0f;
}

/// The choice goes first between classes: all local lights together, and each light at infinity.
struct Classes {
    float sum = 0.0f;
    float floor = 0.0f;
    int count = 0;
};

float class_weight(const FrameDomain& frame, int index, Vec3 x, Vec3 wo)
{
    if (frame.samples_local && index-- == 0) return local_inscatter(frame, x);
    const int light = frame.infinite[static_cast<size_t>(index)];
    return infinite_inscatter(frame, frame.lights[static_cast<size_t>(light)], x, wo);
}

Classes make_classes(const FrameDomain& frame, Vec3 x, Vec3 wo)
{
    Classes out;
    out.count = static_cast<int>(frame.infinite.size()) + (frame.samples_local ? 1 : 0);
    for (int i = 0; i < out.count; ++i) out.sum += class_weight(frame, i, x, wo);
    const auto n = static_cast<float>(out.count);
    out.floor = choice_floor * out.sum / n;
    if (!(out.floor > 0.0f && out.floor < infinity)) {  // nothing is known, or out of range
        out.sum = 0.0f;
        out.floor = 1.0f;
    }
    out.sum += n * out.floor;
    return out;
}

float class_pmf(const FrameDomain& frame, const Classes& classes, int index, Vec3 x, Vec3 wo)
{
    const bool flat = classes.sum <= static_cast<float>(classes.count) * classes.floor;
    const float own = flat ? 0.0f : class_weight(frame, index, x, wo);
    return (own + classes.floor) / classes.sum;
}

bool is_infinite(const SampledLight& light)
{
    return light.kind == SampledLightKind::Distant || light.kind == SampledLightKind::Environment;
}

}  // namespace

std::optional<Arrival> light_at(const FrameDomain& frame, const PathSample& y, Vec3 x, float time)
{
    if (y.light < 0 || y.light >= static_cast<int>(frame.lights.size())) return std::nullopt;
    const SampledLight& light = frame.lights[static_cast<size_t>(y.light)];
    switch (light.kind) {
        case SampledLightKind::Lamp:
        case SampledLightKind::Distant:
            return arrival_of(sample_light(frame.scene->lights[static_cast<size_t>(light.index)], x,
                                           Vec2(y.v.x, y.v.y)));
        case SampledLightKind::Environment:
            return Arrival{y.v, infinity, environment_radiance(*frame.scene->environment, y.v)};
        case SampledLightKind::EmissiveVolume:
            return emission_arrival(frame.scene->media.volumes[static_cast<size_t>(light.index)],
                                    y.v, x, time);
    }
    return std::nullopt;
}

Spectrum scattering_at(const FrameDomain& frame, Vec3 x, float time, Vec3 wo, Vec3 wi)
{
    Spectrum sum(0.0f);
    for_each_scatterer(frame.scene->media, x, time,
                       [&](const Volume& volume, float share, Spectrum albedo) {
                           sum += (share * eval_phase(volume.phase, wo, wi)) * albedo;
                       });
    return sum;
}

float sampled_inscatter(const FrameDomain& frame, Vec3 x, Vec3 wo)
{
    float sum = local_inscatter(frame, x);
    for (const int light : frame.infinite) {
        sum += infinite_inscatter(frame, frame.lights[static_cast<size_t>(light)], x, wo);
    }
    return sum;
}

float cached_visibility(const FrameDomain& frame, const PathSample& y, Vec3 x,
                        const Arrival& arrival)
{
    constexpr float floor = 1e-3f;
    const SampledLight& light = frame.lights[static_cast<size_t>(y.light)];
    if (light.kind == SampledLightKind::Environment && frame.caches->directions) {
        return std::max(frame.caches->directions->transmittance(x, arrival.wi), floor);
    }
    if (light.kind != SampledLightKind::Distant) return 1.0f;
    for (const LightCaches::Distant& distant : frame.caches->distant) {
        if (distant.light == light.index) return std::max(distant.map->transmittance(x), floor);
    }
    return 1.0f;
}

SampledChoice choose_light(const FrameDomain& frame, Vec3 x, Vec3 wo, double u)
{
    int index = 0;
    float pmf = 1.0f;
    if (!frame.infinite.empty()) {
        const Classes classes = make_classes(frame, x, wo);
        double up_to = 0.0;
        for (;; ++index) {
            pmf = class_pmf(frame, classes, index, x, wo);
            up_to += static_cast<double>(pmf);
            if (u < up_to || index + 1 == classes.count) break;
        }
    }
    if (frame.samples_local && index-- == 0) {
        // The first class: u is below its share, so that the quotient is below 1.
        const LightPick pick = frame.caches->cells->sample(x, u / static_cast<double>(pmf));
        return {pick.light, pmf * pick.pmf};
    }
    return {frame.infinite[static_cast<size_t>(index)], pmf};
}

float light_pmf(const FrameDomain& frame, int light, Vec3 x, Vec3 wo)
{
    const bool infinite = is_infinite(frame.lights[static_cast<size_t>(light)]);
    int index = 0;
    if (infinite) {
        const auto found = std::find(frame.infinite.begin(), frame.infinite.end(), light);
        if (found == frame.infinite.end()) return 0.0f;
        index = static_cast<int>(found - frame.infinite.begin()) + (frame.samples_local ? 1 : 0);
    } else if (!frame.samples_local) {
        return 0.0f;
    }
    float pmf = 1.0f;
    if (!frame.infinite.empty()) {
        pmf = class_pmf(frame, make_classes(frame, x, wo), index, x, wo);
    }
    return infinite ? pmf : pmf * frame.caches->cells->pmf(light, x);
}

}  // namespace mote
