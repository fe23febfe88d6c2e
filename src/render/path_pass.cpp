#include "render/path_pass.h"

#include "multiscatter/cached_lights.h"
#include "multiscatter/still_scene.h"
#include "render/indirect_pass.h"

namespace mote {
namespace {

/// A walk's name has its pass in the lower bits.
constexpr uint32_t first_walk_bit = 24;

/// Walks of all pixels of a tile, and what each chooses of them.
void walk_tile(const PassInputs& inputs, const PathWorld& world, const Tile& tile, uint32_t pass,
               const DomainStore* kept, DomainStore& domains, const PathOutput& out, PassCounts& n)
{
    PixelDomain domain;
    std::vector<DrawnPath> paths;
    const Scene& scene = *inputs.domain.scene;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const PassKey key{x, y, pass};
            if (kept) {
                kept->load(x, y, domain);
            } else {
                make_path_domain(inputs.domain, camera_ray(inputs, key), domain, n.bins);
            }
            domains.store(x, y, domain);
            out.pixels.at(x, y) = {};
            out.light.at(x, y) = Spectrum(0.0f);
            const float lost = -std::expm1(-domain.bins.depth());
            if (!(lost > 0.0f)) continue;
            Rng rng = pass_rng(inputs, key, Stream::Indirect);
            const float step = 1.0f / paths_worth(lost, inputs.domain.params.indirect_paths);
            paths.clear();
            float cut = 0.0f;
            WalkKey walk{static_cast<uint32_t>(scene.frame),
                         static_cast<uint32_t>(y * scene.camera.width + x), pass};
            for (float u = rng.uniform() * step; u < 1.0f; u += step) {
                draw_paths(world, domain, u, walk, paths, cut);
                walk.walk += 1u << first_walk_bit;
            }
            n.truncation.add(step * cut);
            n.candidates += static_cast<int64_t>(paths.size());
            Rng choices = pass_rng(inputs, key, Stream::PathChoice);
            out.pixels.at(x, y) =
                resample_paths({world, domain}, paths, step, choices, out.light.at(x, y));
        }
    }
}

/// Shadows are all asked for: guesses that are corrected now and then may be below 0, which
/// reservoirs cannot choose.
TraceContext context_of(const Scene& scene, const LightSampler& lights,
                        const RenderDescription& render, const CachedGuesses& guesses)
{
    return {scene, lights, render.path, nullptr, guesses.guide()};
}

}  // namespace

bool reuses_paths(const Scene& scene, const RenderDescription& render)
{
    const RestirParams& params = render.restir;
    return params.indirect_reuse != IndirectReuse::Off && params.corrections &&
           render.path.max_bounces > 1 && !scene.media.empty() && is_still_but_for_camera(scene);
}

void light_reused_paths(const PassInputs& inputs, uint32_t pass, const ForTiles& for_tiles,
                        FinishedPaths& history, Buffer2D<Spectrum>& light)
{
    const FrameDomain& frame = inputs.domain;
    const RenderDescription& render = inputs.render;
    const int width = frame.scene->camera.width;
    const int height = frame.scene->camera.height;
    const bool in_time = reuses_paths_in_time(frame.params);
    if (history.domains.width() != width || history.domains.height() != height) history = {};
    const CachedGuesses guesses(*frame.caches);
    const PathWorld world{frame, context_of(*frame.scene, inputs.lights, render, guesses),
                          render.seed};
    const auto rng = [&](Stream stream) {
        return [&inputs, stream, pass](int x, int y) {
            return pass_rng(inputs, {x, y, pass}, stream);
        };
    };
    Change change;
    if (!history.empty()) change = change_between(history.frame, frame);
    // As for light of one event: history is worth little on another ray through the pixel.
    const bool keeps_rays = in_time && !history.empty() && render.samples == 1 && !change.any();
    DomainStore domains(width, height);
    Buffer2D<PathPixel> current(width, height);
    Buffer2D<PathPixel> next(width, height);
    for_tiles([&](const Tile& tile, PassCounts& n) {
        walk_tile(inputs, world, tile, pass, keeps_rays ? &history.domains : nullptr, domains,
                  {current, light}, n);
    });
    if (in_time && !history.empty()) {
        const CachedGuesses earlier(*history.frame.caches);
        const PathWorld then{history.frame,
                             context_of(*history.frame.scene, history.lights, render, earlier),
                             render.seed};
        for_tiles([&](const Tile& tile, PassCounts& n) {
            reuse_paths_in_time({world, domains, current}, {history, then, change}, tile,
                                rng(Stream::PathTemporal), {next, light}, n.reuse);
        });
        std::swap(current, next);
    }
    Buffer2D<PathReservoir> kept;
    if (in_time) {
        kept = Buffer2D<PathReservoir>(width, height);
        for (size_t i = 0; i < kept.size(); ++i) kept.data()[i] = current.data()[i].r;
    }
    if (frame.params.indirect_reuse != IndirectReuse::Temporal) {
        for_tiles([&](const Tile& tile, PassCounts& n) {
            reuse_paths_in_space({world, domains, current}, tile, rng(Stream::PathSpatial),
                                 {next, light}, n.reuse);
        });
    }
    if (in_time) history = {frame, inputs.lights, std::move(domains), std::move(kept)};
}

}  // namespace mote
