#include "restir/control_variate.h"

#include <algorithm>
#include <cmath>

#include "restir/correction_need.h"
#include "restir/incident_light.h"
#include "restir/media_mixture.h"
#include "restir/mixed_phase.h"
#include "restir/pixel_domain.h"
#include "restir/ray_flight.h"
#include "scene/environment.h"
#include "volumes/media_at.h"

namespace mote {
namespace {

/// Directions into an environment image: this share by the image, the rest by the phase function.
constexpr float image_share = 0.5f;
/// Rays into the environment that start at one point: directions make more noise than places.
/// Measured on bench_plume_g3: no more noise than with points of their own, 4 % less time.
constexpr int rays_per_point = 2;

struct EdgeLight {
    Vec3 x{0.0f};
    MediaMixture media;
    Spectrum distant{0.0f};      ///< cached in-scattered radiance, albedo included
    Spectrum environment{0.0f};  ///< likewise
};

class InfiniteLights {
  public:
    InfiniteLights(const FrameDomain& frame, const Ray& ray, const RayBins& bins)
        : frame_(frame), ray_(ray), bins_(bins), lost_(-std::expm1(-bins.depth()))
    {
        for (int k = 0; k <= bins.count; ++k) set_edge(k);
    }

    [[nodiscard]] KnownLight closed_form() const
    {
        KnownLight sum;
        for (int k = 0; k < bins_.count; ++k) {
            const Vec2 weights = std::exp(-bins_.tau[k]) * linear_weights(bins_.depth_of_bin(k));
            sum.distant += weights.x * edges_[k].distant + weights.y * edges_[k + 1].distant;
            sum.environment +=
                weights.x * edges_[k].environment + weights.y * edges_[k + 1].environment;
        }
        return sum;
    }

    [[nodiscard]] RayFlight free_flight(float u) const
    {
        return flight_at(frame_.scene->media, ray_, bins_, u);
    }

    [[nodiscard]] Spectrum correct_distant(float u, float u_light, float share, int owner,
                                           float pixel_luminance, Rng& rng, TileRays& rays) const;
    [[nodiscard]] Spectrum correct_environment(const RayFlight& flight, Vec2 u_direction,
                                               float u_choice, float share, int owner,
                                               float pixel_luminance, Rng& rng, float number,
                                               TileRays& rays) const;

  private:
    void set_edge(int k)
    {
        EdgeLight& edge = edges_[k];
        edge.x = ray_.at(bins_.world_t(bins_.s[k]));
        edge.media = mixture_at(frame_.scene->media, edge.x, ray_.time);
        // At the border of all media the mixture is that of the edge before.
        if (edge.media.count == 0 && k > 0) edge.media = edges_[k - 1].media;
        for (const LightCaches::Distant& distant : frame_.caches->distant) {
            edge.distant += distant.irradiance * cached_distant(edge, distant);
        }
        if (frame_.caches->environment) edge.environment = cached_environment(edge);
    }

    /// Per unit of irradiance.
    [[nodiscard]] Spectrum cached_distant(const EdgeLight& edge,
                                          const LightCaches::Distant& distant) const
    {
        Spectrum scattering(0.0f);
        for (int i = 0; i < edge.media.count; ++i) {
            const MediaMixture::Part& part = edge.media.parts[i];
            scattering +=
                (part.share * eval_phase(part.volume->phase, -ray_.d, distant.direction)) *
                part.albedo;
        }
        return scattering * distant.map->transmittance(edge.x);
    }

    [[nodiscard]] Spectrum cached_environment(const EdgeLight& edge) const
    {
        Spectrum sum(0.0f);
        for (int i = 0; i < edge.media.count; ++i) {
            const MediaMixture::Part& part = edge.media.parts[i];
            sum += part.share * part.albedo *
                   frame_.caches->environment->inscatter(phase_index(part), edge.x);
        }
        return sum;
    }

    /// Per solid angle; its integral over wi is cached_environment.
    [[nodiscard]] Spectrum cached_environment(const EdgeLight& edge, Vec3 wi) const
    {
        Spectrum sum(0.0f);
        for (int i = 0; i < edge.media.count; ++i) {
            const MediaMixture::Part& part = edge.media.parts[i];
            sum += part.share * part.albedo *
                   frame_.caches->environment->directional(phase_index(part), edge.x, -ray_.d, wi);
        }
        return sum;
    }

    [[nodiscard]] int phase_index(const MediaMixture::Part& part) const
    {
        const auto volume = part.volume - frame_.scene->media.volumes.data();
        return frame_.caches->environment->phase_of(static_cast<size_t>(volume));
    }

    const FrameDomain& frame_;
    const Ray& ray_;
    const RayBins& bins_;
    float lost_;  ///< share of the light that collides on the ray
    EdgeLight edges_[RayBins::capacity + 1];
};

/// Between the values at the near and the far edge.
Spectrum between(Spectrum near, Spectrum far, float lambda)
{
    return near + lambda * (far - near);
}

Spectrum InfiniteLights::correct_distant(float u, float u_light, float share, int owner,
                                         float pixel_luminance, Rng& rng, TileRays& rays) const
{
    const auto& distant = frame_.caches->distant;
    // One light per ray, in proportion to its irradiance.
    float total = 0.0f;
    for (const auto& d : distant) total += luminance(d.irradiance);
    if (!(total > 0.0f)) return Spectrum(0.0f);
    size_t i = 0;
    float pmf = luminance(distant[0].irradiance) / total;
    for (float before = 0.0f; i + 1 < distant.size() && u_light >= before + pmf;) {
        before += pmf;
        pmf = luminance(distant[++i].irradiance) / total;
    }
    if (!(pmf > 0.0f)) return Spectrum(0.0f);
    Vec3 wi = distant[i].direction;
    Spectrum irradiance = distant[i].irradiance;
    if (distant[i].spot >= 0) {
        const EnvironmentParts& parts = *frame_.caches->parts;
        const float u_pixel = rng.uniform();
        const LightSample sample = sample_spot(
            parts, parts.spots[static_cast<size_t>(distant[i].spot)], u_pixel, rng.uniform2());
        wi = sample.wi;
        irradiance = sample.Li / sample.pdf_dir;
    }
    const RayFlight flight = free_flight(u);
    const float per_irradiance = share * lost_ / pmf;
    const Spectrum weight = per_irradiance * irradiance;
    const Spectrum f = weight * scattering_at(frame_, flight.x, ray_.time, -ray_.d, wi);
    rays.exact.add(owner, flight.x, wi, infinity, ray_.time, f,
                   depth_that_matters(f, pixel_luminance));
    const EdgeLight& near = edges_[flight.bin];
    const EdgeLight& far = edges_[flight.bin + 1];
    if (distant.size() == 1 && distant[i].spot < 0) {
        return -per_irradiance * between(near.distant, far.distant, flight.lambda);
    }
    // The same irradiance on both sides: how it varies over a spot makes no noise.
    return -weight * between(cached_distant(near, distant[i]), cached_distant(far, distant[i]),
                             flight.lambda);
}

Spectrum InfiniteLights::correct_environment(const RayFlight& flight, Vec2 u_direction,
                                             float u_choice, float share, int owner,
                                             float pixel_luminance, Rng& rng, float number,
                                             TileRays& rays) const
{
    const EnvironmentLight& environment = frame_.caches->parts->rest;
    const Vec3 wo = -ray_.d;
    const MixedPhase phase = mixed_phase_at(frame_.scene->media, flight.x, ray_.time);
    if (phase.empty()) return Spectrum(0.0f);
    const float by_image = environment.map ? image_share : 0.0f;
    Vec3 wi;
    if (u_choice < by_image) {
        const std::optional<LightSample> sample = sample_environment(environment, rng);
        if (!sample) return Spectrum(0.0f);
        wi = sample->wi;
    } else {
        wi = phase.sample(wo, (u_choice - by_image) / (1.0f - by_image), u_direction);
    }
    const float pdf = (1.0f - by_image) * phase.pdf(wo, wi) +
                      (by_image > 0.0f ? by_image * environment_pdf(environment, wi) : 0.0f);
    if (!(pdf > 0.0f)) return Spectrum(0.0f);
    const float weight = share * lost_ / pdf;
    const Spectrum f = weight * environment_radiance(environment, wi) *
                       scattering_at(frame_, flight.x, ray_.time, wo, wi);
    const float tau_max = depth_that_matters(f, pixel_luminance);
    if (!frame_.caches->guess || frame_.caches->guess->empty()) {
        rays.exact.add(owner, flight.x, wi, infinity, ray_.time, f, tau_max);
    } else {
        rays.guessed.add(owner, flight.x, wi, ray_.time, f, tau_max, number);
    }
    return -weight * between(cached_environment(edges_[flight.bin], wi),
                             cached_environment(edges_[flight.bin + 1], wi), flight.lambda);
}

}  // namespace

Spectrum scatter_infinite_lights(const FrameDomain& frame, const Ray& ray, const RayBins& bins,
                                 const PassSequence& numbers, const CorrectionPairs& pairs,
                                 Rng& rng, int owner, TileRays& rays)
{
    const LightCaches& caches = *frame.caches;
    if (bins.empty() || (caches.distant.empty() && !caches.environment)) return Spectrum(0.0f);
    const InfiniteLights lights(frame, ray, bins);
    const KnownLight light = lights.closed_form();
    Spectrum sum = light.distant + light.environment;
    if (!frame.params.corrections) return sum;
    const float known = luminance(sum);
    const Vec2 distance = numbers.pair(pairs.distances);
    const Vec2 direction = numbers.pair(pairs.directions);
    // One light, no image: nothing to choose.
    const bool chooses =
        caches.distant.size() > 1 || (frame.scene->environment && frame.scene->environment->map);
    const Vec2 choice = chooses ? numbers.pair(pairs.choices) : Vec2(0.5f);
    // Several rays of one pass form a lattice, shifted by the pass's own numbers.
    const auto shifted = [](float u, float step) {
        const float v = u + step;
        return std::min(v - std::floor(v), one_minus_epsilon);
    };
    const Vec2 counts = numbers.pair(pairs.counts);
    const RayCount distant_rays =
        caches.distant.empty()
            ? RayCount{}
            : rays_needed(distant_rays_of(frame.params), luminance(light.distant),
                          frame.mean_known.x, counts.x);
    for (int i = 0; i < distant_rays.count; ++i) {
        const float step = static_cast<float>(i) / static_cast<float>(distant_rays.count);
        sum += lights.correct_distant(shifted(distance.x, step),
                                      shifted(choice.x, 0.618034f * static_cast<float>(i)),
                                      distant_rays.share, owner, known, rng, rays);
    }
    const float number = numbers.pair(pairs.guesses).x;
    const RayCount environment_rays =
        caches.environment ? rays_needed(environment_rays_of(frame.params),
                                         luminance(light.environment), frame.mean_known.y, counts.y)
                           : RayCount{};
    const int points = (environment_rays.count + rays_per_point - 1) / rays_per_point;
    RayFlight flight;
    for (int i = 0; i < environment_rays.count; ++i) {
        if (i % rays_per_point == 0) {
            const float step = static_cast<float>(i / rays_per_point) / static_cast<float>(points);
            flight = lights.free_flight(shifted(distance.y, step));
        }
        const auto n = static_cast<float>(i);
        const Vec2 u(shifted(direction.x, 0.754877666f * n),
                     shifted(direction.y, 0.569840296f * n));
        sum += lights.correct_environment(flight, u, shifted(choice.y, 0.618034f * n),
                                          environment_rays.share, owner, known, rng, number, rays);
    }
    return sum;
}

KnownLight known_infinite_lights(const FrameDomain& frame, const Ray& ray, const RayBins& bins)
{
    const LightCaches& caches = *frame.caches;
    if (bins.empty() || (caches.distant.empty() && !caches.environment)) return {};
    return InfiniteLights(frame, ray, bins).closed_form();
}

}  // namespace mote
