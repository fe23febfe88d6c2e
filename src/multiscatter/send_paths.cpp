#include "multiscatter/send_paths.h"

#include <algorithm>
#include <cmath>

#include "multiscatter/near_lamps.h"
#include "multiscatter/vertex_lanes.h"
#include "reference/path_tracer.h"
#include "reference/trace_segment.h"
#include "reference/visibility.h"
#include "volumes/media_at.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

/// How one group's paths are sent.
struct GroupScratch {
    LaneGroup lanes;
    std::vector<float> shares;
    std::vector<Vec3> wo;
    std::vector<float> way_shares;
};

/// What is known of the light that arrives at a place in a medium, from every direction alike; so
/// the medium scatters just as much, albedo apart.
Spectrum known_light(const SharingContext& context, Vec3 x)
{
    return context.known ? context.known->at(x) : Spectrum(0.0f);
}

class PathSender {
  public:
    PathSender(const SharingContext& context, int event_count, bool is_first, PathLevel& level,
               PathLevel& next, Rng& rng)
        : context_(context),
          event_count_(event_count),
          is_first_(is_first),
          level_(level),
          next_(next),
          rng_(rng)
    {
    }

    void send_group(const VertexGroup& group)
    {
        const std::span<const int> members = level_.members(group);
        level_.kernel_of.push_back(level_.kernels.size());
        const size_t before = next_.vertices.size();
        if (share_out(members)) {
            fill_lanes(level_.vertices, members, scratch_.shares, scratch_.lanes);
            look_for_lamps(members);
            // One place in every stratum of the shares: whole paths go where they are due.
            float left = is_first_ ? rng_.uniform() : 0.5f;
            for (size_t k = 0; k < members.size(); ++k) {
                const float expected = scratch_.shares[k] * static_cast<float>(members.size());
                left += expected;
                for (; left >= 1.0f; left -= 1.0f) send_path(members, members[k], expected);
            }
            near_.for_each_point(rng_, [&](Vec3 y) { look_at(members, y); });
        }
        level_.found.push_back({before, next_.vertices.size() - before});
    }

  private:
    /// Shares of a group's paths; false if nothing is scattered.
    bool share_out(std::span<const int> members)
    {
        scratch_.shares.resize(members.size());
        float sum = 0.0f;
        for (size_t i = 0; i < members.size(); ++i) {
            const PathVertex& v = level_.vertices[static_cast<size_t>(members[i])];
            scratch_.shares[i] = is_first_ ? v.drawn * max_component(v.weight) : 1.0f;
            sum += scratch_.shares[i];
        }
        for (float& share : scratch_.shares) share /= sum;
        return sum > 0.0f;
    }

    void look_for_lamps(std::span<const int> members)
    {
        near_.clear();
        const float count = context_.near_share * static_cast<float>(members.size());
        if (!(count > 0.0f)) return;
        Vec3 center(0.0f);
        for (const int i : members) center += level_.vertices[static_cast<size_t>(i)].x;
        center /= static_cast<float>(members.size());
        const Vec3 member = level_.vertices[static_cast<size_t>(members.front())].x;
        const float sigma_t = sigma_t_at(context_.trace.scene.media, member, context_.time);
        near_.choose(context_.trace, center, sigma_t, static_cast<int>(std::ceil(count)), rng_);
    }

    /// A place near a lamp: what scatters there, as paths would find it.
    void look_at(std::span<const int> members, Vec3 y)
    {
        PathVertex found;
        found.x = y;
        found.from = -1;
        found.goes_on = false;
        float sigma_t = 0.0f;
        for_each_medium_at(context_.trace.scene.media, y, context_.time,
                           [&](const Volume& volume, Vec3 local, float s) {
                               sigma_t += s;
                               if (rng_.uniform() * sigma_t >= s) return;
                               found.phase = &volume.phase;
                               found.weight =
                                   albedo_at(volume, object_from_local(volume).point(local));
                           });
        if (!found.phase || !(max_component(found.weight) > 0.0f)) return;
        connect(members, found, sigma_t);
    }

    /// `expected`: paths that this vertex sends in the mean.
    void send_path(std::span<const int> members, int from, float expected)
    {
        PathVertex& v = level_.vertices[static_cast<size_t>(from)];
        const Vec3 wi = sample_phase(v.lobe, v.wo, rng_.uniform2());
        const float pdf = phase_pdf(v.lobe, v.wo, wi);
        LightRay light_ray{Ray{v.x, wi, context_.time}, pdf, false};
        const TracedSegment segment = trace_segment(context_.trace, light_ray, false, rng_);
        PathVertex found;
        found.from = from;
        found.carried = is_first_ ? max_component(v.weight) / expected : v.carried;
        Spectrum known(0.0f);
        if (segment.collision) {
            const Collision& c = *segment.collision;
            const Volume& volume =
                context_.trace.scene.media.volumes[static_cast<size_t>(c.volume)];
            found.x = light_ray.ray.at(c.t);
            found.phase = &volume.phase;
            found.weight = albedo_at(volume, c.p_object);
            found.carried *= max_component(found.weight);
            known = found.weight * known_light(context_, found.x);
        } else if (segment.vertex) {
            found.x = segment.vertex->p;
            found.surface = static_cast<int>(next_.surfaces.size());
            next_.surfaces.push_back(*segment.vertex);
        }
        // First vertices' light of one event comes from elsewhere.
        if (is_first_) {
            v.known += known / expected;
        } else {
            v.add({wi, (segment.light() + known - known_light(context_, v.x)) / pdf});
        }
        if (!found.phase && found.surface < 0) return;
        if (!(max_component(found.weight) > 0.0f)) return;
        const float sigma_t = found.surface < 0 && near_.density(found.x) > 0.0f
                                  ? sigma_t_at(context_.trace.scene.media, found.x, context_.time)
                                  : 0.0f;
        connect(members, found, sigma_t);
    }

    /// Shares a vertex out among the group that it was found by. `sigma_t`: there, in a medium; not
    /// needed away from lamps.
    void connect(std::span<const int> members, PathVertex& found, float sigma_t)
    {
        const size_t first = level_.kernels.size();
        level_.kernels.resize(first + scratch_.lanes.width());
        const std::span<float> kernel = std::span(level_.kernels).subspan(first);
        const Vec3* normal =
            found.surface >= 0 ? &next_.surfaces[static_cast<size_t>(found.surface)].ng : nullptr;
        eval_kernels(scratch_.lanes, context_.extinction, found.x, normal, kernel);
        hide_shadowed(members, found, kernel);
        const GroupView view = view_of(scratch_.lanes, found.x, kernel);
        const float by_paths = view.density * static_cast<float>(members.size());
        if (!std::isfinite(1.0f / by_paths)) {  // out of sight, for floats
            level_.kernels.resize(first);
            return;
        }
        // Where lamps' light is looked for both ways, both weights sum to 1.
        const float near = sigma_t > 0.0f ? near_.density(found.x) / sigma_t : 0.0f;
        if (found.surface >= 0) {
            light_surface(members, kernel, found);
        } else {
            aim_lobe(view, found);
            const float share = found.goes_on ? by_paths / (by_paths + near) : 1.0f;
            add_shadow_ray(next_.event(found, context_.time), share, found);
            if (!found.goes_on && found.arrival_count == 0) {
                level_.kernels.resize(first);
                return;
            }
        }
        const float scale = 1.0f / (found.goes_on ? by_paths : by_paths + near);
        for (float& k : kernel) k *= scale;
        next_.vertices.push_back(found);
    }

    /// Vertices that a surface parts from the one found could not have found it: were they to
    /// count, its light would go to nobody. From the far end, as surfaces do not shadow rays that
    /// leave them.
    void hide_shadowed(std::span<const int> members, const PathVertex& found,
                       std::span<float> kernel)
    {
        const Scene& scene = context_.trace.scene;
        if (!scene.surfaces) return;
        const ScatterEvent event = next_.event(found, context_.time);
        for (size_t i = 0; i < members.size(); ++i) {
            if (members[i] == found.from) continue;
            const Vec3 x = level_.vertices[static_cast<size_t>(members[i])].x;
            const Vec3 o = ray_origin(event, x - found.x);
            const float distance = glm::length(x - o);
            if (!(distance > 0.0f)) continue;
            const Ray ray{o, (x - o) / distance, context_.time};
            if (is_shadowed(*scene.surfaces, ray, distance)) kernel[i] = 0.0f;
        }
    }

    void add_shadow_ray(const ScatterEvent& event, float share, PathVertex& v)
    {
        const TraceContext& trace = context_.trace;
        const std::optional<ShadowRay> ray = sample_shadow_ray(trace, event, rng_);
        if (!ray || ray->scattering.f == Spectrum(0.0f)) return;
        const Spectrum light =
            ray->light * estimate_visibility(trace, event, ray->wi, ray->distance, rng_);
        v.add({ray->wi, share * light});
    }

    /// Surfaces may scatter in peaks: directions are drawn for one of the ways to it, as likely as
    /// it counts.
    void light_surface(std::span<const int> members, std::span<const float> kernel, PathVertex& v)
    {
        scratch_.wo.clear();
        scratch_.way_shares.clear();
        float sum = 0.0f;
        for (size_t i = 0; i < members.size(); ++i) {
            const Vec3 to = level_.vertices[static_cast<size_t>(members[i])].x - v.x;
            scratch_.wo.push_back(glm::normalize(to));
            scratch_.way_shares.push_back(scratch_.lanes.share(i) * kernel[i]);
            sum += scratch_.way_shares.back();
        }
        for (float& share : scratch_.way_shares) share /= sum;
        const WayMixture mixture{scratch_.wo, scratch_.way_shares};
        ScatterEvent event = next_.event(v, context_.time);
        event.mixture = &mixture;
        add_shadow_ray(event, 1.0f, v);
        follow_own_path(context_, event, event_count_ + 1, v, rng_);
    }

    const SharingContext& context_;
    int event_count_;
    bool is_first_;
    PathLevel& level_;
    PathLevel& next_;
    Rng& rng_;
    NearLamps near_;
    GroupScratch scratch_;
};

/// Compares true and assumed transmittances of the segments that were traced.
void measure_excess(const SharingContext& context, const PathLevel& level, PathLevel& next)
{
    std::vector<DepthQuery> queries;
    std::vector<PathVertex*> traced;
    queries.reserve(next.vertices.size());
    for (PathVertex& v : next.vertices) {
        if (v.from < 0) continue;
        const Vec3 x = level.vertices[static_cast<size_t>(v.from)].x;
        const float distance = glm::length(v.x - x);
        queries.push_back({x, distance, (v.x - x) / distance, context.time, infinity});
        traced.push_back(&v);
    }
    std::vector<float> taus(queries.size());
    optical_depths(context.trace.scene.media, queries, taus, context.counts);
    for (size_t j = 0; j < taus.size(); ++j) {
        PathVertex& v = *traced[j];
        const float assumed = assumed_transmittance(context.extinction, v.x, queries[j].o);
        v.log_excess = std::log(assumed) + taus[j];
    }
}

}  // namespace

void send_paths(const SharingContext& context, int event_count, bool is_first, PathLevel& level,
                PathLevel& next, Rng& rng)
{
    for (size_t i = 0; i < level.vertices.size(); ++i) {
        const PathVertex& v = level.vertices[i];
        if (v.surface < 0 && v.goes_on) level.order.push_back(static_cast<int>(i));
    }
    level.groups = make_groups(level.vertices, context.group_size, level.order);
    PathSender sender(context, event_count, is_first, level, next, rng);
    for (const VertexGroup& group : level.groups) sender.send_group(group);
    measure_excess(context, level, next);
}

void follow_own_path(const SharingContext& context, const ScatterEvent& event, int event_count,
                     PathVertex& v, Rng& rng)
{
    const TraceContext& trace = context.trace;
    const Aim aim = event_count < trace.params.max_bounces ? aim_at_lights(trace, event) : Aim{};
    for (int i = 0; trace.aims && i < trace.aims->count; ++i) {
        const AimedArrival arrival = seek_light(trace, event, aim, i, rng);
        v.add({arrival.wi, arrival.E});
    }
    const std::optional<ScatteredDirection> s = sample_scattering(event, rng);
    if (!s) return;
    const float pdf = s->scattering.pdf_dir;
    const LightRay light_ray{Ray{ray_origin(event, s->wi), s->wi, event.time}, pdf, false};
    float cut = 0.0f;
    const Spectrum arrives = trace_scattered_ray(trace, light_ray, event_count, aim, rng, cut);
    context.cut += v.carried * max_component(s->scattering.f) / pdf * cut;
    const Spectrum known = event.surface ? Spectrum(0.0f) : known_light(context, event.x);
    v.add({s->wi, (arrives - known) / pdf});
}

}  // namespace mote
