#include "multiscatter/residual_walk.h"

#include <cmath>

#include "multiscatter/next_event.h"
#include "reference/aimed_light.h"

namespace mote {
namespace {

/// An event that a direction has found.
struct FoundEvent {
    NextEvent next;
    float pdf_dir = 0.0f;  ///< of the way there [1/sr]
};

/// What the directions from one event find.
struct Fan {
    Spectrum seen{0.0f};      ///< mean of the light met on the way, which has scattered no more
    Spectrum surfaces{0.0f};  ///< mean of what surfaces scatter there
    int count = 0;
    std::array<FoundEvent, ResidualParams::most_directions> events;  ///< in media
};

/// The event that carries the residual on.
struct Carried {
    int index = -1;         ///< into the fan; -1: the residual ends
    Spectrum weight{0.0f};  ///< of what is carried on
};

class ResidualWalk {
  public:
    ResidualWalk(const TraceContext& context, const RadianceCache& cache,
                 const ResidualParams& params, Rng& rng)
        : context_(context), cache_(cache), params_(params), rng_(rng)
    {
    }

    PathResult from(ScatterEvent event)
    {
        const int max_bounces = context_.params.max_bounces;
        for (int event_count = 1; event_count < max_bounces; ++event_count) {
            const int directions = event_count == 1 ? params_.directions : params_.later_directions;
            const Fan fan = send_rays(event, directions, event_count + 1);
            result_.indirect += seen_weight_ * fan.seen + beta_ * fan.surfaces;
            const bool is_last = event_count + 1 == max_bounces;
            const Carried carried = is_last ? Carried{} : choose(fan, directions);
            const Aim aim = aim_at_lights(context_, event);
            result_.indirect += beta_ * estimate_aimed_light(context_, event, aim, rng_);
            light_events(fan, aim, carried, is_last, beta_ / static_cast<float>(directions));
            if (carried.index < 0) break;
            const FoundEvent& found = fan.events[static_cast<size_t>(carried.index)];
            seen_weight_ = beta_ / static_cast<float>(directions) * found.next.albedo;
            beta_ = carried.weight;
            event = found.next.event;
            result_.indirect -= beta_ * eval_cached_light(cache_, event);
        }
        return result_;
    }

  private:
    /// Free flights, stratified over the phase function.
    Fan send_rays(const ScatterEvent& event, int directions, int event_count)
    {
        constexpr float golden = 0.618034f;  // turns of neighbouring strata are spread evenly
        Fan fan;
        const float share = 1.0f / static_cast<float>(directions);
        for (int i = 0; i < directions; ++i) {
            const Vec2 u = rng_.uniform2();
            const float turn = u.y + golden * static_cast<float>(i);
            const float stratum =
                std::min((static_cast<float>(i) + u.x) * share, one_minus_epsilon);
            const Vec3 wi =
                sample_phase(*event.phase, event.wo, {stratum, turn - std::floor(turn)});
            const float pdf = phase_pdf(*event.phase, event.wo, wi);
            LightRay ray{Ray{event.x, wi, event.time}, pdf, false};
            const TracedSegment segment = trace_segment(context_, ray, false, rng_);
            fan.seen += share * segment.light();
            const std::optional<NextEvent> next = next_event(context_.scene, ray.ray, segment);
            if (!next) continue;
            if (next->event.surface) {
                float cut_behind = 0.0f;
                fan.surfaces +=
                    share * light_of_event(context_, next->event, event_count, rng_, cut_behind);
                result_.cut += share * max_component(beta_) * cut_behind;
            } else {
                fan.events[static_cast<size_t>(fan.count++)] = {*next, pdf};
            }
        }
        return fan;
    }

    /// One event of the fan, in proportion to its albedo, by Russian roulette.
    Carried choose(const Fan& fan, int directions)
    {
        float total = 0.0f;
        for (int i = 0; i < fan.count; ++i) total += albedo_of(fan, i);
        const float choice = rng_.uniform() * total;
        const float roulette = rng_.uniform();
        if (!(total > 0.0f)) return {};
        Carried carried;
        for (float before = 0.0f; carried.index + 1 < fan.count && before <= choice;) {
            before += albedo_of(fan, ++carried.index);
        }
        const Spectrum albedo = fan.events[static_cast<size_t>(carried.index)].next.albedo;
        carried.weight =
            beta_ * albedo * (total / (static_cast<float>(directions) * max_component(albedo)));
        const float survival = std::min(1.0f, params_.survival * max_component(carried.weight));
        if (roulette >= survival) return {};
        carried.weight /= survival;
        return carried;
    }

    /// Adds light scattered once at each event and, but for the last, what the cache knows of the
    /// rest. Rays that light may be met on leave all but the event whose own directions follow.
    void light_events(const Fan& fan, const Aim& aim, const Carried& carried, bool is_last,
                      Spectrum share)
    {
        for (int i = 0; i < fan.count; ++i) {
            const auto& [next, pdf_dir] = fan.events[static_cast<size_t>(i)];
            const Spectrum weight = share * next.albedo;
            Spectrum light = estimate_direct_light_after(context_, next.event, aim, pdf_dir, rng_);
            if (!is_last) light += eval_cached_light(cache_, next.event);
            if (i != carried.index) light += look_for_light(next.event);
            result_.indirect += weight * light;
            if (is_last) result_.cut += max_component(weight);
        }
    }

    Spectrum look_for_light(const ScatterEvent& event)
    {
        const std::optional<ScatteredDirection> s = sample_scattering(event, rng_);
        LightRay ray{Ray{event.x, s->wi, event.time}, s->scattering.pdf_dir, false};
        return trace_segment(context_, ray, true, rng_).light();
    }

    static float albedo_of(const Fan& fan, int i)
    {
        return max_component(fan.events[static_cast<size_t>(i)].next.albedo);
    }

    const TraceContext& context_;
    const RadianceCache& cache_;
    const ResidualParams& params_;
    Rng& rng_;
    PathResult result_;
    Spectrum beta_{1.0f};         ///< weight of the residual that is carried
    Spectrum seen_weight_{0.0f};  ///< of light scattered once where it is; the first's is not asked
};

}  // namespace

PathResult residual_light(const TraceContext& context, const RadianceCache& cache,
                          const ResidualParams& params, const ScatterEvent& first, Rng& rng)
{
    return ResidualWalk(context, cache, params, rng).from(first);
}

}  // namespace mote
