#include "render/restir_frame.h"

#include <atomic>
#include <mutex>

#include "core/parallel.h"
#include "multiscatter/cached_lights.h"
#include "render/indirect_pass.h"
#include "render/restir_reuse.h"
#include "render/surface_pass.h"
#include "restir/cache_stats.h"
#include "restir/candidates.h"
#include "restir/correction_need.h"

namespace mote {
namespace {

/// What one tile works with; allocated once per tile, reused over its passes.
struct TileScratch {
    TileRays rays;
    LightRays surface_rays;
    std::vector<Candidate> candidates;
    SurfaceChoice choice;
    std::vector<FilmSample> samples;
    std::vector<PixelFilm> pixels;
    PassDomain domain;
    std::vector<PathVertex> first;
};

void trace_tile_pass(const PassInputs& inputs, const Tile& tile, uint32_t pass,
                     TileScratch& scratch, PassCounts& counts)
{
    const FrameDomain& frame = inputs.domain;
    scratch.rays.clear();
    scratch.surface_rays.clear();
    int owner = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x, ++owner) {
            const PassKey key{x, y, pass};
            FilmSample& sample = scratch.samples[static_cast<size_t>(owner)];
            sample = {};
            begin_pass(inputs, key, camera_ray(inputs, key), owner, scratch.domain, scratch.rays,
                       scratch.first, sample, counts);
            if (inputs.render.path.max_bounces == 0) continue;
            if (scratch.domain.surface.is_sampled()) {
                const SurfaceDomain& surface = scratch.domain.surface;
                SurfaceChoice& choice = scratch.choice;
                resample_surface(inputs, key, surface, choice, counts);
                ask_for_light(frame, surface, choice.kept.r, owner, scratch.surface_rays);
                ask_for_lights_apart(surface, choice, owner, scratch.surface_rays);
                sample.work.x += static_cast<float>(choice.candidates.size());
            }
            PixelDomain& domain = scratch.domain.media;
            if (!frame.has_sampled_lights() || domain.bins.empty()) continue;
            weigh_bins(frame, domain);
            Rng rng = pass_rng(inputs, key, Stream::Initial);
            scratch.candidates.clear();
            draw_candidates(frame, domain, frame.params.candidates, rng, scratch.candidates);
            counts.candidates += static_cast<int64_t>(scratch.candidates.size());
            sample.work.x += static_cast<float>(scratch.candidates.size());
            for (const Candidate& c : scratch.candidates) {
                const Spectrum weight = c.f / c.density;
                scratch.rays.exact.add(owner, c.x, c.arrival.wi, c.arrival.distance,
                                       domain.ray.time, weight,
                                       depth_that_matters(weight, luminance(sample.L())));
            }
        }
    }
    const std::vector<Spectrum> shared =
        light_shared_paths(inputs, tile, pass, scratch.first, counts);
    for (size_t i = 0; i < shared.size(); ++i) scratch.samples[i].indirect += shared[i];
    scratch.rays.trace(frame, counts.guesses, counts.light_rays, [&](int of, Spectrum value) {
        FilmSample& sample = scratch.samples[static_cast<size_t>(of)];
        sample.direct += value;
        sample.exact_rays += 1.0f;
    });
    scratch.surface_rays.trace(*frame.scene, counts.light_rays);
    for (size_t i = 0; i < scratch.surface_rays.size(); ++i) {
        FilmSample& sample = scratch.samples[static_cast<size_t>(scratch.surface_rays.owners[i])];
        sample.surface_direct += scratch.surface_rays.value(i);
        sample.exact_rays += 1.0f;
    }
}

int64_t pixel_passes(const RenderDescription& render)
{
    return int64_t{render.width} * render.height * render.samples;
}

size_t history_bytes(const FrameHistory::Impl& history)
{
    const FinishedPass& pass = history.before;
    return pass.domains.memory_bytes() +
           (pass.reservoirs.size() + pass.surface_reservoirs.size()) * sizeof(Reservoir) +
           pass.surfaces.size() * sizeof(SurfaceDomain) + history.pixels.size() * sizeof(PixelFilm);
}

/// The scene for as long as the frame takes; with reuse its samples must outlive the frame.
std::shared_ptr<const Scene> share(const Scene& scene, bool is_kept)
{
    if (is_kept) return std::make_shared<const Scene>(scene);
    return {std::shared_ptr<const Scene>(), &scene};
}

}  // namespace

bool render_restir(const Scene& scene, const RenderDescription& render, const AovSet& aovs,
                   const LightSampler& lights, const FrameControl& control,
                   FrameHistory::Impl& history, Film& film, FrameStats& stats)
{
    const double cpu_start = process_cpu_seconds();
    const bool may_share =
        render.path.max_bounces > 1 && render.restir.indirect != IndirectLight::Paths;
    history.caches = make_light_caches(scene, {pixel_passes(render), may_share}, history.caches);
    stats.cache_cpu_seconds = process_cpu_seconds() - cpu_start;
    const bool keeps_history = uses_history(render);
    FrameDomain domain = make_frame_domain(
        share(scene, keeps_history), history.caches,
        settle_corrections(render.restir, render.path.max_bounces), &history.last);
    domain.mean_known = mean_known_light(domain);
    std::optional<Change> change;
    if (history.last.scene) change = change_between(history.last, domain);
    const ReusePlan plan = plan_reuse(domain, render, change);
    std::optional<ScatterNodes> nodes;
    const bool is_preview = !render.restir.corrections;
    if (is_preview && can_have_scatter_nodes(scene, render.path)) {
        const CachedGuesses guesses(*history.caches);
        nodes = make_scatter_nodes(
            {scene, lights, render.path, &guesses.shadows, guesses.guide()},
            {render.restir.node_paths, render.restir.node_spacing, render.samples, render.seed});
        stats.cache_cpu_seconds += nodes->cpu_seconds;
    }
    const PassInputs inputs{
        domain, render, aovs, lights, nodes ? &*nodes : nullptr, shares_paths(domain, render.path)};
    PassCounts counts;
    bool finished = false;
    if (plan.reuses_samples()) {
        history.pixels = {};
        finished = render_reusing_passes(inputs, plan, control, history.before, film, counts,
                                         stats.dropped_non_finite, history.pixels);
    } else {
        history.before = {};
        const Camera& camera = scene.camera;
        if (!plan.accumulates) history.pixels = {};
        const bool keeps_passes = plan.accumulates || (plan.keeps_passes && !history.is_last);
        if (keeps_passes && !plan.accumulates) {
            history.pixels = Buffer2D<PixelFilm>(camera.width, camera.height);
        }
        finished =
            render_independent_passes(inputs, control, film, counts, stats.dropped_non_finite,
                                      keeps_passes ? &history.pixels : nullptr);
    }
    history.last = keeps_history ? domain : FrameDomain{};
    stats.truncated_paths = counts.truncated;
    stats.camera_rays = counts.bins.rays;
    stats.missed_rays = counts.bins.misses;
    stats.light_rays = static_cast<int64_t>(counts.light_rays.rays);
    stats.cells = counts.bins.cells + static_cast<int64_t>(counts.light_rays.cells);
    stats.light_ray_cells = static_cast<int64_t>(counts.light_rays.cells);
    stats.coarse_rays = static_cast<int64_t>(counts.guesses.rays);
    stats.coarse_ray_cells = static_cast<int64_t>(counts.guesses.cells);
    stats.uniform_bricks =
        counts.bins.uniform_bricks + static_cast<int64_t>(counts.light_rays.uniform_bricks);
    stats.candidates = counts.candidates;
    stats.surfaces = counts.surfaces;
    stats.emission_integrals = counts.emission_integrals;
    stats.histories_used = counts.reuse.histories;
    stats.neighbours_used = counts.reuse.neighbours;
    stats.caches_built = history.caches->built;
    stats.caches_reused = history.caches->reused;
    stats.caches = parts_of(*history.caches);
    stats.tracking = counts.tracking;
    stats.memory.history = history_bytes(history);
    return finished;
}

bool render_independent_passes(const PassInputs& inputs, const FrameControl& control, Film& film,
                               PassCounts& counts, int64_t& dropped,
                               Buffer2D<PixelFilm>* accumulated)
{
    std::atomic<bool> stopped{false};
    std::mutex mutex;
    const Camera& camera = inputs.domain.scene->camera;
    const auto passes = static_cast<size_t>(inputs.render.samples);
    for_each_tile(camera.width, camera.height, [&](const Tile& tile) {
        const auto pixels =
            static_cast<size_t>(tile.x1 - tile.x0) * static_cast<size_t>(tile.y1 - tile.y0);
        TileScratch scratch;
        const std::optional<FilmSample> uniform = uniform_tile(inputs, tile);
        scratch.samples.resize(pixels, uniform.value_or(FilmSample{}));
        scratch.pixels.resize(pixels);
        const auto for_pixels = [&](auto&& f) {
            size_t i = 0;
            for (int y = tile.y0; y < tile.y1; ++y) {
                for (int x = tile.x0; x < tile.x1; ++x) f(x, y, scratch.pixels[i++]);
            }
        };
        if (accumulated) {
            for_pixels([&](int x, int y, PixelFilm& p) { p = accumulated->at(x, y); });
        }
        PassCounts tile_counts;
        int64_t tile_dropped = 0;
        const TrackingCounts tracking_before = tracking_counts;
        for (int pass = 0; pass < inputs.render.samples; ++pass) {
            if (control.stop && control.stop()) stopped.store(true, std::memory_order_relaxed);
            if (stopped.load(std::memory_order_relaxed)) return;
            if (!uniform) {
                trace_tile_pass(inputs, tile, static_cast<uint32_t>(pass), scratch, tile_counts);
            }
            for (size_t i = 0; i < pixels; ++i) {
                tile_dropped += scratch.pixels[i].add(scratch.samples[i]) ? 0 : 1;
            }
        }
        for_pixels([&](int x, int y, const PixelFilm& p) { film.store(x, y, p); });
        if (accumulated) {
            for_pixels([&](int x, int y, const PixelFilm& p) { accumulated->at(x, y) = p; });
        }
        if (uniform) tile_counts.bins.misses += static_cast<int64_t>(pixels * passes);
        tile_counts.tracking = tracking_counts.since(tracking_before);
        {
            const std::lock_guard<std::mutex> lock(mutex);
            counts.add(tile_counts);
            dropped += tile_dropped;
        }
        if (control.tile_done) control.tile_done();
    });
    return !stopped;
}

}  // namespace mote
