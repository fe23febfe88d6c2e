#include "render/indirect_plan.h"

#include <algorithm>

#include "multiscatter/cached_lights.h"
#include "multiscatter/near_lamps.h"
#include "multiscatter/still_scene.h"
#include "restir/in_view.h"

namespace mote {
namespace {

constexpr int coverage_tile = 16;  ///< [px] a side
/// One in so many of a frame's paths goes into what is known before.
constexpr int share_for_residuals = 10;
constexpr int share_for_mean = 50;
/// Frames that mean radiance is a mean of, at most: where nothing changes, and else.
constexpr int frames_at_rest = 32;
constexpr int frames_in_motion = 4;

/// Fewer events cut most paths before they have found the light that there is.
constexpr int enough_bounces = 8;

/// Whether there is a constant environment that paths find by scattered rays alone, and go on until
/// they do.
bool finds_sky_by_paths(const Scene& scene, const RenderDescription& render)
{
    return scene.environment && !scene.environment->map && render.restir.corrections &&
           render.restir.control_variate && render.path.max_bounces >= enough_bounces &&
           render.path.light_strategy == LightStrategy::Auto;
}

/// Whether it pays to leave the mean radiance out of paths that are shared: not around small lamps,
/// where no coarse guess is close, nor where walks are cut short.
bool leaves_mean_out(const Scene& scene, const RenderDescription& render)
{
    return render.path.max_bounces >= enough_bounces && !has_small_lamps(scene);
}

/// Share of the picture's tiles that may see media.
double share_in_view(const Scene& scene)
{
    int64_t tiles = 0;
    int64_t seen = 0;
    for (int y = 0; y < scene.camera.height; y += coverage_tile) {
        for (int x = 0; x < scene.camera.width; x += coverage_tile) {
            const Tile tile{x, y, std::min(x + coverage_tile, scene.camera.width),
                            std::min(y + coverage_tile, scene.camera.height)};
            ++tiles;
            if (media_in_view(scene, tile)) ++seen;
        }
    }
    return static_cast<double>(seen) / static_cast<double>(std::max<int64_t>(tiles, 1));
}

RadianceCache trace_radiance(const IndirectInputs& inputs, const CachedGuesses& guesses, int share)
{
    const RenderDescription& render = inputs.render;
    const auto most = static_cast<double>(int64_t{render.width} * render.height * render.samples *
                                          render.restir.indirect_paths);
    const auto paths = static_cast<int64_t>(share_in_view(inputs.scene) * most);
    return make_radiance_cache(
        {inputs.scene, inputs.lights, render.path, &guesses.shadows, guesses.guide(), &inputs.aims},
        share_of_paths(paths, share, render.seed));
}

}  // namespace

bool shares_paths(const Scene& scene, const RenderDescription& render)
{
    const RestirParams& params = render.restir;
    const bool may_share =
        params.indirect == IndirectLight::Auto || params.indirect == IndirectLight::Shared;
    return params.indirect_reuse == IndirectReuse::Off && may_share && params.corrections &&
           render.path.max_bounces > 1 && is_still_but_for_camera(scene) &&
           !paths_bring_sky(scene, render);
}

bool corrects_cache(const Scene& scene, const RenderDescription& render)
{
    return render.restir.indirect == IndirectLight::Cached && render.path.max_bounces > 1 &&
           media_in_view(scene);
}

bool paths_bring_sky(const Scene& scene, const RenderDescription& render)
{
    const RestirParams& params = render.restir;
    return finds_sky_by_paths(scene, render) && params.indirect == IndirectLight::Auto &&
           params.indirect_reuse == IndirectReuse::Off && scene.lights.empty() && !scene.surfaces &&
           std::none_of(scene.media.volumes.begin(), scene.media.volumes.end(),
                        [](const Volume& volume) { return volume.emission_params.is_on(); });
}

bool surface_paths_bring_sky(const Scene& scene, const RenderDescription& render)
{
    return scene.surfaces && finds_sky_by_paths(scene, render);
}

IndirectGuesses guess_indirect(const IndirectInputs& inputs)
{
    const Scene& scene = inputs.scene;
    const RenderDescription& render = inputs.render;
    const CachedGuesses guesses(inputs.caches);
    IndirectGuesses out;
    if (!render.restir.corrections && can_have_scatter_nodes(scene, render.path)) {
        out.nodes = make_scatter_nodes(
            {scene, inputs.lights, render.path, &guesses.shadows, guesses.guide()},
            {render.restir.node_paths, render.restir.node_spacing, render.samples, render.seed});
        out.cpu_seconds = out.nodes->cpu_seconds;
        return out;
    }
    if (!inputs.reuses_paths && corrects_cache(scene, render)) {
        out.radiance = trace_radiance(inputs, guesses, share_for_residuals);
        out.cpu_seconds = out.radiance->cpu_seconds;
    }
    if (!shares_paths(scene, render) || !inputs.caches.extinction) return out;
    out.sharing.emplace();
    out.leaves_mean_out = leaves_mean_out(scene, render);
    if (!media_in_view(scene) || !(out.leaves_mean_out || render.restir.indirect_guide)) return out;
    RadianceCache cache = trace_radiance(inputs, guesses, share_for_mean);
    out.cpu_seconds = cache.cpu_seconds;
    if (out.leaves_mean_out) out.sharing = sharing_for(scene.media, cache.mean_events);
    out.mean = mean_radiance(std::move(cache));
    const int frames = inputs.is_same ? frames_at_rest : frames_in_motion;
    if (inputs.before) blend_in(*inputs.before, frames - 1, *out.mean);
    return out;
}

void point_to_mean(const RestirParams& params, IndirectGuesses& guesses)
{
    if (!guesses.mean) return;
    if (guesses.leaves_mean_out) guesses.sharing->known = &*guesses.mean;
    if (params.indirect_guide) guesses.sharing->guide = &*guesses.mean;
}

}  // namespace mote
