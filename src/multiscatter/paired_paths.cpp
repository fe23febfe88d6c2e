#include "multiscatter/paired_paths.h"

#include <cmath>

#include "volumes/media_at.h"

namespace mote {
namespace {

/// Segments side by side at most; then the paths are led to one place whatever the length.
constexpr int most_side_by_side = 4;

/// What the two events' contributions count with by the balance heuristic.
struct PairWeights {
    float own = 1.0f;
    float other = 0.0f;
};

/// Light that the event scatters, with `event_count` events behind it, the event included.
Spectrum scattered_light(const TraceContext& context, const ScatterEvent& event, int event_count,
                         float roulette, Rng& rng, bool& truncated)
{
    Spectrum sum = estimate_direct_light(context, event, rng);
    const std::optional<ScatteredDirection> s = sample_scattering(event, rng);
    if (!s) return sum;
    Spectrum beta = s->scattering.f / s->scattering.pdf_dir;
    const float size = max_component(glm::abs(beta));
    if (!(size > 0.0f)) return sum;
    const float survival = std::min(1.0f, size / roulette);
    if (rng.uniform() >= survival) return sum;
    beta /= survival;
    const LightRay light_ray{Ray{ray_origin(event, s->wi), s->wi, event.time},
                             s->scattering.pdf_dir, false};
    return sum + beta * trace_scattered_ray(context, light_ray, event_count, rng, truncated);
}

/// Albedo of all media at a point; black where nothing scatters.
Spectrum albedo_of(const Media& media, Vec3 x, float time)
{
    Spectrum sum(0.0f);
    for_each_scatterer(media, x, time, [&](const Volume& /*volume*/, float share, Spectrum albedo) {
        sum += share * albedo;
    });
    return sum;
}

/// Optical depth of a segment; infinite if a surface is in between.
float depth_between(const Scene& scene, Vec3 x, Vec3 wi, float distance, float time)
{
    const Ray ray{x, wi, time};
    if (scene.surfaces && is_shadowed(*scene.surfaces, ray, distance)) return infinity;
    return optical_depth(scene.media, ray, {0.0f, distance});
}

PathTracerParams with_exact_shadows(PathTracerParams params)
{
    params.transmittance = TransmittanceKind::Exact;
    return params;
}

/// A pair on its way.
struct Pair {
    PairedEvent own;     ///< of the path that is sampled
    PairedEvent other;   ///< of the one that is led along
    float start = 1.0f;  ///< probability with which own was the one to be sampled; > 0
    float ratio = 1.0f;  ///< density with which `other` leads to here, over own's

    [[nodiscard]] PairWeights weights_with(float new_ratio) const
    {
        if (new_ratio > 1e18f) return {0.0f, start < 1.0f ? 1.0f / (1.0f - start) : 0.0f};
        const float own_weight = 1.0f / (start + (1.0f - start) * new_ratio);
        return {own_weight, new_ratio * own_weight};
    }
};

/// What the path finds next.
struct Segment {
    Vec3 wi{0.0f};
    float pdf_dir = 0.0f;
    std::optional<Collision> collision;
    std::optional<SurfaceHit> hit;
    float length = 0.0f;
};

class PairTracer {
  public:
    PairTracer(const TraceContext& context, const PairedPathParams& params, float time, Rng& rng,
               bool& truncated)
        : context_(context),
          exact_params_(with_exact_shadows(context.params)),
          exact_{context.scene, context.lights, exact_params_, context.shadows, context.guide},
          scene_(context.scene),
          params_(params),
          time_(time),
          rng_(rng),
          truncated_(truncated)
    {
    }

    [[nodiscard]] Spectrum trace(Pair pair)
    {
        Spectrum sum(0.0f);
        for (int event_count = 1;; ++event_count) {
            const Segment segment = next_segment(pair.own);
            if (event_count > 1) sum += seen_light_of(pair, segment, event_count);
            const bool is_last = event_count == context_.params.max_bounces;
            if (!segment.collision && !segment.hit) return sum;
            if (is_last) {
                truncated_ = true;
                return sum;
            }
            const bool side_by_side =
                segment.collision &&
                rng_.uniform() < side_by_side_share(event_count, segment.length);
            if (!side_by_side) return sum + meet(pair, segment, event_count);
            step_side_by_side(pair, segment);
            if (pair.ratio == 0.0f) {
                return sum + follow_alone(pair, event_count + 1);
            }
            sum += direct_light_of(pair);
        }
    }

  private:
    /// Probability of going on side by side after a segment in a medium. Smooth: a limit would part
    /// pairs whose segments lie on either side of it.
    [[nodiscard]] float side_by_side_share(int event_count, float length) const
    {
        const bool may = params_.translates && params_.reach > 0.0f;
        if (!may || event_count > most_side_by_side) return 0.0f;
        return std::exp(-length / params_.reach);
    }

    [[nodiscard]] Segment next_segment(const PairedEvent& from)
    {
        Segment segment;
        segment.wi = sample_phase(*from.phase, from.wo, rng_.uniform2());
        segment.pdf_dir = phase_pdf(*from.phase, from.wo, segment.wi);
        const Ray ray{from.x, segment.wi, time_};
        float t_end = infinity;
        if (scene_.surfaces) segment.hit = intersect(*scene_.surfaces, ray, {0.0f, infinity});
        if (segment.hit) t_end = segment.hit->t;
        segment.collision = sample_free_flight(scene_.media, ray, {0.0f, t_end}, rng_);
        if (segment.collision) segment.hit.reset();
        segment.length = segment.collision ? segment.collision->t : t_end;
        return segment;
    }

    /// Moves both events along the segment.
    void step_side_by_side(Pair& pair, const Segment& segment)
    {
        const float s = segment.length;
        const float own_depth =
            optical_depth(scene_.media, Ray{pair.own.x, segment.wi, time_}, {0.0f, s});
        const float other_depth = depth_between(scene_, pair.other.x, segment.wi, s, time_);
        const float other_pdf =
            pair.other.phase ? phase_pdf(*pair.other.phase, pair.other.wo, segment.wi) : 0.0f;
        const Phase* phase =
            &scene_.media.volumes[static_cast<size_t>(segment.collision->volume)].phase;
        for (PairedEvent* event : {&pair.own, &pair.other}) {
            event->x += s * segment.wi;
            event->wo = -segment.wi;
            event->phase = phase;
        }
        const float own_sigma = sigma_t_at(scene_.media, pair.own.x, time_);
        const float other_sigma = sigma_t_at(scene_.media, pair.other.x, time_);
        const float own = segment.pdf_dir * own_sigma;
        const float other = other_pdf * other_sigma * std::exp(own_depth - other_depth);
        const float ratio = own > 0.0f ? pair.ratio * other / own : 0.0f;
        pair.ratio = std::isfinite(ratio) ? ratio : 0.0f;
        pair.own.weight *= albedo_of(scene_.media, pair.own.x, time_);
        pair.other.weight *= albedo_of(scene_.media, pair.other.x, time_);
    }

    /// Leads both paths to the segment's end and on from there.
    [[nodiscard]] Spectrum meet(const Pair& pair, const Segment& segment, int event_count)
    {
        ScatterEvent event{};
        event.time = time_;
        event.wo = -segment.wi;
        Spectrum albedo(1.0f);
        std::optional<SurfaceVertex> vertex;
        if (segment.collision) {
            const Collision& collision = *segment.collision;
            const Volume& volume = scene_.media.volumes[static_cast<size_t>(collision.volume)];
            event.x = pair.own.x + segment.length * segment.wi;
            event.phase = &volume.phase;
            albedo = albedo_at(volume, collision.p_object);
        } else {
            vertex = make_vertex(*scene_.surfaces, *segment.hit, time_);
            event.x = vertex->p;
            event.surface = &*vertex;
        }
        TwoWays ways;
        const float ratio = ratio_at(pair, segment, event, event_count, ways);
        const PairWeights w = pair.weights_with(ratio);
        ways.wo[0] = -segment.wi;
        ways.weight[0] = w.own * albedo * pair.own.weight;
        if (ratio > 0.0f) {
            ways.weight[1] = w.other * albedo * pair.other.weight;
            event.ways = &ways;
            return scattered_light(context_, event, event_count + 1, params_.roulette, rng_,
                                   truncated_);
        }
        const float roulette =
            params_.roulette / std::max(max_component(glm::abs(ways.weight[0])), 1e-30f);
        return ways.weight[0] *
               scattered_light(context_, event, event_count + 1, roulette, rng_, truncated_);
    }

    /// Density with which `other` leads to the event, over that of `own`; 0 if it never does. Fills
    /// in the way to `other`.
    [[nodiscard]] float ratio_at(const Pair& pair, const Segment& segment,
                                 const ScatterEvent& event, int event_count, TwoWays& ways) const
    {
        if (!pair.other.phase) return 0.0f;
        const Vec3 to_event = event.x - pair.other.x;
        const float length = glm::length(to_event);
        if (!(length > 0.0f)) return 0.0f;
        const Vec3 wi = to_event / length;
        ways.wo[1] = -wi;
        const float other_depth = depth_between(scene_, pair.other.x, wi, length, time_);
        if (!(other_depth < infinity)) return 0.0f;
        const float own_depth =
            optical_depth(scene_.media, Ray{pair.own.x, segment.wi, time_}, {0.0f, segment.length});
        const Vec3* normal = event.surface ? &event.surface->ng : nullptr;
        float ratio = pair.ratio * phase_pdf(*pair.other.phase, pair.other.wo, wi) /
                      segment.pdf_dir *
                      solid_angle_ratio(pair.own.x, pair.other.x, event.x, normal) *
                      std::exp(own_depth - other_depth);
        if (!event.surface) {
            ratio *= (1.0f - side_by_side_share(event_count, length)) /
                     (1.0f - side_by_side_share(event_count, segment.length));
        }
        return std::isfinite(ratio) ? ratio : 0.0f;
    }

    /// The sampled path alone, where the other one cannot follow.
    [[nodiscard]] Spectrum follow_alone(const Pair& pair, int event_count)
    {
        const ScatterEvent event{pair.own.x, pair.own.wo, time_, pair.own.phase};
        const Spectrum weight = pair.weights_with(0.0f).own * pair.own.weight;
        const float size = max_component(glm::abs(weight));
        if (!(size > 0.0f)) return Spectrum(0.0f);
        return weight * scattered_light(context_, event, event_count, params_.roulette / size, rng_,
                                        truncated_);
    }

    /// Both paths with the same random numbers: what they see alike cancels out.
    template <class F>
    [[nodiscard]] Spectrum for_both(const Pair& pair, F&& light_of)
    {
        const PairWeights w = pair.weights_with(pair.ratio);
        Rng other_rng = rng_;
        const Spectrum own = w.own * pair.own.weight * light_of(pair.own, rng_);
        return own + w.other * pair.other.weight * light_of(pair.other, other_rng);
    }

    [[nodiscard]] Spectrum direct_light_of(const Pair& pair)
    {
        return for_both(pair, [&](const PairedEvent& at, Rng& rng) {
            return estimate_direct_light(exact_, {at.x, at.wo, time_, at.phase}, rng);
        });
    }

    /// Light that shines along the segment's direction, at both: the scattered ray's half of it.
    [[nodiscard]] Spectrum seen_light_of(const Pair& pair, const Segment& segment, int event_count)
    {
        PathTracerParams last = exact_params_;
        last.max_bounces = event_count;
        const TraceContext context{scene_, context_.lights, last, context_.shadows, context_.guide};
        return for_both(pair, [&](const PairedEvent& at, Rng& rng) {
            bool ignored = false;
            const LightRay light_ray{Ray{at.x, segment.wi, time_}, segment.pdf_dir, false};
            return trace_scattered_ray(context, light_ray, event_count, rng, ignored);
        });
    }

    const TraceContext& context_;
    PathTracerParams exact_params_;
    TraceContext exact_;  ///< what two paths see alike cancels out only if it has no noise
    const Scene& scene_;
    const PairedPathParams& params_;
    float time_;
    Rng& rng_;
    bool& truncated_;
};

}  // namespace

float solid_angle_ratio(Vec3 a, Vec3 b, Vec3 y, const Vec3* normal)
{
    const Vec3 from_a = y - a;
    const Vec3 from_b = y - b;
    const float a2 = glm::dot(from_a, from_a);
    const float b2 = glm::dot(from_b, from_b);
    if (!(b2 > 0.0f)) return 0.0f;
    if (!normal) return a2 / b2;
    // cos_b / b^2 over cos_a / a^2, with cos = dot / length.
    const float dot_a = std::abs(glm::dot(*normal, from_a));
    const float dot_b = std::abs(glm::dot(*normal, from_b));
    return dot_b / std::max(dot_a, 1e-30f) * (a2 / b2) * std::sqrt(a2 / b2);
}

Spectrum estimate_difference(const TraceContext& context, const PairedEvent& here,
                             const PairedEvent& there, float time, const PairedPathParams& params,
                             Rng& rng, bool& truncated)
{
    PairTracer tracer(context, params, time, rng, truncated);
    PairedEvent minus = there;
    minus.weight = -there.weight;
    const float size_here = max_component(here.weight);
    const float size = size_here + max_component(there.weight);
    if (!(size > 0.0f)) return Spectrum(0.0f);
    const float start_here = size_here / size;
    if (rng.uniform() < start_here) return tracer.trace({here, minus, start_here});
    return tracer.trace({minus, here, 1.0f - start_here});
}

}  // namespace mote
