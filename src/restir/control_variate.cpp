#include "restir/control_variate.h"

#include <algorithm>
#include <cmath>

#include "restir/correction_need.h"
#include "restir/edge_weights.h"
#include "restir/incident_light.h"
#include "restir/media_mixture.h"
#include "restir/mixed_phase.h"
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
constexpr int edge_capacity = EdgeWeights::capacity;

/// Cached in-scattered radiance at the edges of a ray's bins, albedo included, and the closed form
/// of what they bring.
class InfiniteLights {
  public:
    InfiniteLights(const FrameDomain& frame, const Ray& ray, const RayBins& bins)
        : frame_(frame), ray_(ray), bins_(bins), lost_(-std::expm1(-bins.depth()))
    {
        find_media();
        for (int k = 0; k <= bins.count; ++k) edges_[k] = Float8{};
        for (const LightCaches::Distant& distant : frame_.caches->distant) add_distant(distant);
        if (frame_.caches->environment) add_environment();
    }

    [[nodiscard]] KnownLight closed_form() const
    {
        EdgeWeights weights;
        weigh_edges(bins_, weights);
        Float8 sum{};
        for (int k = 0; k <= bins_.count; ++k) sum += weights.of[k] * edges_[k];
        return {distant_of(sum), environment_of(sum)};
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
    // Red, green, blue of distant lights in the lower half, of the environment in the upper one.
    static Spectrum distant_of(const Float8& v) { return {v[0], v[1], v[2]}; }
    static Spectrum environment_of(const Float8& v) { return {v[4], v[5], v[6]}; }
    /// Between the edges of the flight's bin.
    [[nodiscard, gnu::always_inline]] inline Float8 known_at(const RayFlight& flight) const
    {
        const Float8 near = edges_[flight.bin];
        return near + flight.lambda * (edges_[flight.bin + 1] - near);
    }

    [[nodiscard]] Vec3 position(int k) const { return ray_.at(bins_.world_t(bins_.s[k])); }

    /// One medium of one colour is the same mixture everywhere; else one per edge.
    void find_media()
    {
        const Media& media = frame_.scene->media;
        if (media.volumes.size() == 1 && !media.volumes.front().color) {
            everywhere_ = mixture_at(media, position(0), ray_.time);
            return;
        }
        for (int k = 0; k <= bins_.count; ++k) {
            media_.push_back(mixture_at(media, position(k), ray_.time));
            // At the border of all media the mixture is that of the edge before.
            if (media_.back().count == 0 && k > 0) media_.back() = media_[media_.size() - 2];
        }
    }
    [[nodiscard]] const MediaMixture& media_at_edge(int k) const
    {
        return media_.empty() ? everywhere_ : media_[static_cast<size_t>(k)];
    }

    /// Albedo times phase function.
    [[nodiscard]] Spectrum scattering(const MediaMixture& media, Vec3 wi) const
    {
        Spectrum sum(0.0f);
        for (int i = 0; i < media.count; ++i) {
            const MediaMixture::Part& part = media.parts[i];
            sum += (part.share * eval_phase(part.volume->phase, -ray_.d, wi)) * part.albedo;
        }
        return sum;
    }

    void add_distant(const LightCaches::Distant& distant)
    {
        alignas(32) float depth[edge_capacity];
        const int padded = (bins_.count + lane_count) / lane_count * lane_count;
        for (int k = 0; k <= bins_.count; ++k) depth[k] = distant.map->optical_depth(position(k));
        for (int k = bins_.count + 1; k < padded; ++k) depth[k] = 0.0f;
        for (int k = 0; k < padded; k += lane_count) {
            store(depth + k, exp_of_negative(-load(depth + k)));
        }
        const auto add = [&](int k, Spectrum light) {
            edges_[k] += depth[k] * Float8{light.x, light.y, light.z};
        };
        if (media_.empty()) {
            const Spectrum light = distant.irradiance * scattering(everywhere_, distant.direction);
            for (int k = 0; k <= bins_.count; ++k) add(k, light);
        } else {
            for (int k = 0; k <= bins_.count; ++k) {
                add(k, distant.irradiance * scattering(media_at_edge(k), distant.direction));
            }
        }
    }

    void add_environment()
    {
        const EnvironmentCache& cache = *frame_.caches->environment;
        for (int k = 0; k <= bins_.count; ++k) {
            const MediaMixture& media = media_at_edge(k);
            const Vec3 x = position(k);
            Spectrum sum(0.0f);
            for (int i = 0; i < media.count; ++i) {
                const MediaMixture::Part& part = media.parts[i];
                sum += part.share * part.albedo * cache.inscatter(phase_index(part), x);
            }
            edges_[k] += Float8{0.0f, 0.0f, 0.0f, 0.0f, sum.x, sum.y, sum.z};
        }
    }

    /// Of one light per unit of its irradiance.
    [[nodiscard]] Spectrum cached_distant(int k, const LightCaches::Distant& distant) const
    {
        const float depth = distant.map->optical_depth(position(k));
        // The same exponential as at all edges.
        return exp_of_negative(splat(-depth))[0] * scattering(media_at_edge(k), distant.direction);
    }

    /// Environment light per solid angle at both edges of the flight's bin, interpolated; its
    /// integral over wi is known_at.
    [[nodiscard]] Spectrum cached_environment(const RayFlight& flight, Vec3 wi) const
    {
        const EnvironmentCache& cache = *frame_.caches->environment;
        EnvironmentCache::Towards towards{-1, {}, 0.0f};
        const auto at = [&](int k) {
            const MediaMixture& media = media_at_edge(k);
            Spectrum sum(0.0f);
            for (int i = 0; i < media.count; ++i) {
                const MediaMixture::Part& part = media.parts[i];
                const int phase = phase_index(part);
                if (towards.phase != phase) towards = cache.towards(phase, -ray_.d, wi);
                sum += part.share * part.albedo * cache.directional(towards, position(k));
            }
            return sum;
        };
        const Spectrum near = at(flight.bin);
        return near + flight.lambda * (at(flight.bin + 1) - near);
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
    MediaMixture everywhere_;
    std::vector<MediaMixture> media_;  ///< per edge; empty: `everywhere_`
    /// Filled up to bins.count: clearing all of it would cost more than many a ray.
    Float8 edges_[edge_capacity];
};

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
    if (distant.size() == 1 && distant[i].spot < 0) {
        return -per_irradiance * distant_of(known_at(flight));
    }
    // The same irradiance on both sides: how it varies over a spot makes no noise.
    const Spectrum near = cached_distant(flight.bin, distant[i]);
    const Spectrum far = cached_distant(flight.bin + 1, distant[i]);
    return -weight * (near + flight.lambda * (far - near));
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
    return -weight * cached_environment(flight, wi);
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
