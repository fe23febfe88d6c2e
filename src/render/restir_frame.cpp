#include "render/restir_frame.h"

#include <atomic>
#include <mutex>

#include "core/parallel.h"
#include "render/indirect_plan.h"
#include "render/part_pass.h"
#include "render/restir_reuse.h"
#include "render/seen_lamps.h"
#include "restir/cache_stats.h"
#include "restir/correction_need.h"

namespace mote {
namespace {

/// What one tile works with; allocated once per tile, reused over its passes.
struct TileScratch {
    PartScratch traced;
    std::vector<PixelPart> parts;
    std::vector<DuePart> due;
    std::vector<size_t> first;  ///< of each pixel's parts in `traced`, and their end
    std::vector<PixelFilm> pixels;
};

void trace_tile_pass(const PassInputs& inputs, const Tile& tile, uint32_t pass,
                     TileScratch& scratch, PassCounts& counts)
{
    scratch.traced.clear();
    scratch.due.clear();
    scratch.first.clear();
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            scratch.first.push_back(scratch.due.size());
            PassKey key{x, y, pass};
            split_pixel(inputs, key, camera_ray(inputs, key), scratch.parts);
            look_for_lamps(inputs, key, static_cast<int>(scratch.first.back()),
                           1.0f / scratch.parts[0].weight, scratch.traced.lamp_rays);
            for (const PixelPart& part : scratch.parts) {
                scratch.due.push_back({key, part});
                ++key.part;
            }
        }
    }
    trace_parts(inputs, scratch.due, scratch.traced, counts);
    scratch.first.push_back(scratch.traced.samples.size());
    shade_parts(inputs, {tile.x0, tile.y0, pass}, scratch.traced, counts);
}

int64_t pixel_passes(const RenderDescription& render)
{
    return int64_t{render.width} * render.height * render.samples;
}

size_t history_bytes(const FrameHistory::Impl& history)
{
    const FinishedPass& pass = history.before;
    return pass.domains.memory_bytes() + history.paths.memory_bytes() +
           (pass.reservoirs.size() + pass.surface_reservoirs.size()) * sizeof(Reservoir) +
           pass.surfaces.size() * sizeof(SurfaceDomain) +
           history.pixels.size() * sizeof(PixelFilm) +
           (history.known ? history.known->memory_bytes() : 0);
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
    const bool shares = shares_paths(scene, render);
    const bool brings_sky = paths_bring_sky(scene, render);
    history.caches =
        make_light_caches(scene, {pixel_passes(render), shares, !brings_sky}, history.caches);
    const bool keeps_history = uses_history(render);
    FrameDomain domain = make_frame_domain(share(scene, keeps_history), history.caches,
                                           render.restir, &history.last);
    const bool surfaces_bring_sky = surface_paths_bring_sky(scene, render);
    if (surfaces_bring_sky) domain.bsdf_finds.environment = false;
    domain.mean_known = mean_known_light(domain);
    stats.cache_cpu_seconds = process_cpu_seconds() - cpu_start;
    std::optional<Change> change;
    if (history.last.scene) change = change_between(history.last, domain);
    const ReusePlan plan = plan_reuse(domain, render, change);
    const AimedLights aims = find_aimed_lights(scene);
    const bool is_same = change && !(change->media || change->lights || change->surfaces);
    // Under auto, frames that reuse nothing else are the same whatever was rendered before.
    const bool uses_known = history.known && (render.restir.reuse != ReuseMode::Auto ||
                                              plan.accumulates || plan.reuses_samples());
    IndirectGuesses guesses =
        guess_indirect({scene, render, lights, *history.caches, aims, plan.paths,
                        uses_known ? &*history.known : nullptr, is_same});
    point_to_mean(render.restir, guesses);
    stats.cache_cpu_seconds += guesses.cpu_seconds;
    Buffer2D<Spectrum> path_light;
    if (plan.paths) path_light = {scene.camera.width, scene.camera.height};
    const PassInputs inputs{domain,
                            render,
                            aovs,
                            lights,
                            guesses.nodes ? &*guesses.nodes : nullptr,
                            guesses.sharing ? &*guesses.sharing : nullptr,
                            brings_sky,
                            surfaces_bring_sky,
                            plan.paths ? &path_light : nullptr,
                            aims,
                            find_split_pixels(scene, domain.params.edge_strata),
                            guesses.radiance ? &*guesses.radiance : nullptr};
    PassCounts counts;
    bool finished = false;
    if (plan.reuses_samples()) {
        history.pixels = {};
        finished = render_reusing_passes(inputs, plan, control, history.before, film, counts,
                                         stats.dropped_non_finite, history.pixels, history.paths);
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
    if (!plan.paths) history.paths = {};
    history.known = keeps_history ? std::move(guesses.mean) : std::nullopt;
    history.last = keeps_history ? domain : FrameDomain{};
    stats.truncation = counts.truncation;
    stats.camera_rays = counts.bins.rays + static_cast<int64_t>(counts.lamps.rays);
    stats.missed_rays = counts.bins.misses;
    stats.light_rays = static_cast<int64_t>(counts.light_rays.rays);
    stats.cells =
        counts.bins.cells + static_cast<int64_t>(counts.light_rays.cells + counts.lamps.cells);
    stats.light_ray_cells = static_cast<int64_t>(counts.light_rays.cells);
    stats.coarse_rays = static_cast<int64_t>(counts.guesses.rays);
    stats.coarse_ray_cells = static_cast<int64_t>(counts.guesses.cells);
    stats.uniform_bricks =
        counts.bins.uniform_bricks +
        static_cast<int64_t>(counts.light_rays.uniform_bricks + counts.lamps.uniform_bricks);
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
        if (uniform) {
            scratch.traced.samples.assign(pixels, *uniform);
            for (size_t i = 0; i <= pixels; ++i) scratch.first.push_back(i);
        }
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
                const std::span<const FilmSample> parts(
                    scratch.traced.samples.data() + scratch.first[i],
                    scratch.first[i + 1] - scratch.first[i]);
                tile_dropped += scratch.pixels[i].add(parts) ? 0 : 1;
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
