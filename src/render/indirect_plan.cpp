#include "render/indirect_plan.h"

#include <algorithm>

#include "multiscatter/cached_lights.h"
#include "multiscatter/near_lamps.h"
#include "multiscatter/still_scene.h"
#include "restir/in_view.h"

namespace mote {
namespace {

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

RadianceCache trace_radiance(const IndirectInputs& inputs, const CachedGuesses& guesses, int share)
{
    const RenderDescription& render = inputs.render;
    const int64_t paths =
        int64_t{render.width} * render.height * render.samples * render.restir.indirect_paths;
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

bool knows_mean_radiance(const Scene& scene, const RenderDescription& render)
{
    return render.path.max_bounces >= enough_bounces && media_in_view(scene) &&
           !has_small_lamps(scene);
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
    if (!knows_mean_radiance(scene, render)) return out;
    const RadianceCache cache = trace_radiance(inputs, guesses, share_for_mean);
    out.cpu_seconds = cache.cpu_seconds;
    out.sharing = sharing_for(scene.media, cache.mean_events);
    out.known = mean_radiance(cache);
    const int frames = inputs.is_same ? frames_at_rest : frames_in_motion;
    if (inputs.before) blend_in(*inputs.before, frames - 1, *out.known);
    return out;
}

}  // namespace mote
