#include "render/indirect_pass.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "multiscatter/cached_lights.h"
#include "multiscatter/residual_walk.h"
#include "multiscatter/scatter_along.h"
#include "multiscatter/shared_paths.h"
#include "reference/path_tracer.h"
#include "volumes/media_at.h"

namespace mote {
namespace {

/// Share of the ray's mean radiance that counts everywhere at least, where paths start by it.
constexpr float least_radiance = 0.2f;

/// Where paths start on a ray: in proportion to what collides there, or to that times what is known
/// to be scattered.
class FirstEvents {
  public:
    /// `lost`: share of what collides on the ray. `guide`: may be null.
    FirstEvents(const FrameDomain& frame, const PixelDomain& domain, float lost,
                const MeanRadiance* guide)
        : frame_(frame), domain_(domain), lost_(lost)
    {
        if (!guide) return;
        guided_ = domain;
        const RayBins& bins = domain.bins;
        float radiance[RayBins::capacity + 1];
        for (int k = 0; k <= bins.count; ++k) {
            radiance[k] = luminance(guide->at(domain.ray.at(bins.world_t(bins.s[k]))));
        }
        weigh_bins_by(radiance, least_radiance, *guided_);
    }

    /// The event of a number in [0, 1). Weight 0: there is none.
    [[nodiscard]] RayPoint at(float u) const
    {
        if (guided_) return point_at(frame_, *guided_, u);
        RayPoint point;
        const float tau = -std::log1p(-u * lost_);
        point.s = distance_at(frame_.scene->media, domain_.ray, domain_.bins, tau);
        point.x = domain_.ray.at(domain_.bins.world_t(point.s));
        point.weight = lost_;
        return point;
    }

  private:
    const FrameDomain& frame_;
    const PixelDomain& domain_;
    float lost_;
    std::optional<PixelDomain> guided_;
};

/// Sets what scatters at an event in a medium; returns its albedo, black if there is none.
Spectrum choose_scatterer(const Scene& scene, float choice, ScatterEvent& event)
{
    Spectrum albedo(0.0f);
    float before = 0.0f;
    for_each_scatterer(scene.media, event.x, event.time,
                       [&](const Volume& volume, float share, Spectrum own) {
                           if (!event.phase || choice >= before) {
                               event.phase = &volume.phase;
                               albedo = own;
                           }
                           before += share;
                       });
    return albedo;
}

TraceContext context_with(const PassInputs& inputs, const CachedGuesses& guesses)
{
    return {*inputs.domain.scene, inputs.lights,   inputs.render.path,
            &guesses.shadows,     guesses.guide(), &inputs.aims};
}

PathVertex first_vertex(const ScatterEvent& event, Spectrum weight, float drawn, int owner)
{
    PathVertex v;
    v.x = event.x;
    v.phase = event.phase;
    v.weight = weight;
    v.drawn = drawn;
    v.wo = event.wo;
    v.lobe = *event.phase;
    v.from = owner;
    return v;
}

/// Paths whose first event is in a medium; where pixels share paths, that event joins `first`.
/// Returns the weight cut.
float add_paths_from_media(const PassInputs& inputs, const TraceContext& context,
                           const PixelDomain& domain, float lost, int owner, Rng& rng,
                           std::vector<PathVertex>& first, FilmSample& sample)
{
    const float step = 1.0f / paths_worth(lost, inputs.domain.params.indirect_paths);
    const FirstEvents events(inputs.domain, domain, lost,
                             inputs.sharing ? inputs.sharing->guide : nullptr);
    float cut = 0.0f;
    for (float u = rng.uniform() * step; u < 1.0f; u += step) {
        const RayPoint point = events.at(u);
        const float weight = step * point.weight;
        ScatterEvent event{point.x, domain.wo(), domain.ray.time};
        const Spectrum albedo = choose_scatterer(context.scene, rng.uniform(), event);
        if (!event.phase || !(weight > 0.0f)) continue;
        if (inputs.sharing) {
            first.push_back(first_vertex(event, weight * albedo, lost / point.weight, owner));
            continue;
        }
        const PathResult path = inputs.radiance
                                    ? residual_light(context, *inputs.radiance, {}, event, rng)
                                    : trace_after_event(context, event, rng);
        sample.indirect += weight * albedo * path.indirect;
        if (inputs.paths_bring_sky) sample.direct += weight * albedo * path.direct;
        cut += weight * max_component(albedo) * path.cut;
    }
    return cut;
}

/// Paths that a surface in view scatters first, for the share of light that media let through.
/// Returns the weight cut.
float add_paths_from_surface(const PassInputs& inputs, const TraceContext& context,
                             const SurfaceVertex& surface, const PixelDomain& domain, float share,
                             Rng& rng, FilmSample& sample)
{
    const float step = 1.0f / paths_worth(share, inputs.domain.params.surface.indirect_paths);
    const float weight = share * step;
    ScatterEvent event{surface.p, domain.wo(), domain.ray.time};
    event.surface = &surface;
    float cut = 0.0f;
    for (float u = rng.uniform() * step; u < 1.0f; u += step) {
        const PathResult path = trace_after_event(context, event, rng);
        sample.surface_indirect += weight * path.surface_indirect;
        if (inputs.surface_paths_bring_sky) sample.surface_direct += weight * path.sky;
        cut += weight * path.cut;
    }
    return cut;
}

}  // namespace

float paths_worth(float lost, int count)
{
    const float worth = std::max(lost * static_cast<float>(count), std::sqrt(lost));
    return worth > 1.0f ? std::round(worth) : worth;  // of 2.5 paths, 2 or 3 would be noise
}

void add_indirect(const PassInputs& inputs, const PassKey& key, const PixelDomain& domain,
                  const SurfaceVertex* surface, int owner, std::vector<PathVertex>& first,
                  FilmSample& sample, PassCounts& counts)
{
    const float depth = domain.bins.depth();
    const float lost = -std::expm1(-depth);
    const float reaches_surface = surface ? std::exp(-depth) : 0.0f;
    if (inputs.render.path.max_bounces < 2) {
        counts.truncation.add(lost + reaches_surface);
        return;
    }
    Rng rng = pass_rng(inputs, key, Stream::Indirect);
    const CachedGuesses guesses(*inputs.domain.caches);
    const TraceContext context = context_with(inputs, guesses);
    float cut = 0.0f;
    if (inputs.nodes) {
        sample.indirect =
            scatter_along(*inputs.nodes, inputs.domain.scene->media, domain.ray, domain.bins);
    } else if (inputs.path_light) {
        sample.indirect = inputs.path_light->at(key.x, key.y);
    } else if (lost > 0.0f) {
        cut += add_paths_from_media(inputs, context, domain, lost, owner, rng, first, sample);
    }
    if (reaches_surface > 0.0f) {
        cut +=
            add_paths_from_surface(inputs, context, *surface, domain, reaches_surface, rng, sample);
    }
    counts.truncation.add(cut);
}

std::vector<Spectrum> light_shared_paths(const PassInputs& inputs, const PassKey& key,
                                         std::vector<PathVertex>& first, PassCounts& counts)
{
    if (first.empty()) return {};
    std::vector<Spectrum> light(static_cast<size_t>(first.back().from) + 1, Spectrum(0.0f));
    Rng rng = pass_rng(inputs, key, Stream::SharedPaths);
    const CachedGuesses guesses(*inputs.domain.caches);
    float cut = 0.0f;
    share_paths(context_with(inputs, guesses), *inputs.domain.caches->extinction, *inputs.sharing,
                std::move(first), rng, light, counts.light_rays, cut);
    first.clear();
    if (cut > 0.0f) {
        counts.truncation.add({static_cast<int64_t>(light.size()), static_cast<double>(cut)});
    }
    return light;
}

}  // namespace mote
