#include "render/restir_reuse.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "render/indirect_pass.h"
#include "render/part_pass.h"
#include "render/seen_lamps.h"
#include "restir/surface_reuse.h"

namespace mote {
namespace {

/// From this many lamps on `auto` reuses surfaces' samples in motion.
constexpr size_t many_lamps = 16;

/// A part of a pixel's pass beside that of its reservoirs: on its own, without reuse.
struct OtherPart {
    size_t pixel = 0;
    FilmSample sample;
};

/// Whole-image buffers of a pass under way.
struct PassBuffers {
    PassBuffers(int width, int height, bool has_surfaces)
        : samples(width, height),
          current(width, height),
          next(width, height),
          colors(width, height),
          acceptance(width, height)
    {
        if (!has_surfaces) return;
        surfaces = {Buffer2D<PixelReservoir>(width, height),
                    Buffer2D<PixelReservoir>(width, height), Buffer2D<Spectrum>(width, height)};
    }
    Buffer2D<FilmSample> samples;
    Buffer2D<PixelReservoir> current;
    Buffer2D<PixelReservoir> next;
    Buffer2D<Spectrum> colors;  ///< of the sampled lights
    Buffer2D<Acceptance> acceptance;
    SurfaceBuffers surfaces;
    std::vector<OtherPart> others;
};

/// Everything of one frame's passes.
struct ReusingFrame {
    const PassInputs& inputs;
    const FrameControl& control;
    bool reuses_media;  ///< else samples in media are shaded and forgotten
    PassBuffers buffers;
    std::atomic<bool> stopped{false};
    std::mutex mutex;
    PassCounts& counts;

    ReusingFrame(const PassInputs& in, const ReusePlan& plan, const FrameControl& c, PassCounts& n)
        : inputs(in),
          control(c),
          reuses_media(plan.temporal || plan.spatial),
          buffers(in.domain.scene->camera.width, in.domain.scene->camera.height,
                  in.domain.scene->surfaces != nullptr),
          counts(n)
    {
    }

    [[nodiscard]] bool must_stop()
    {
        if (control.stop && control.stop()) stopped.store(true, std::memory_order_relaxed);
        return stopped.load(std::memory_order_relaxed);
    }
    [[nodiscard]] size_t pixel_index(int x, int y) const
    {
        return static_cast<size_t>(y) * static_cast<size_t>(buffers.colors.width()) +
               static_cast<size_t>(x);
    }
    [[nodiscard]] PixelRng rng(Stream stream, uint32_t pass) const
    {
        return [this, stream, pass](int x, int y) {
            return pass_rng(inputs, {x, y, pass}, stream);
        };
    }
    /// Calls f(tile, counts) for all tiles in parallel.
    void for_tiles(const std::function<void(const Tile&, PassCounts&)>& f)
    {
        for_each_tile(buffers.colors.width(), buffers.colors.height(), [&](const Tile& tile) {
            if (must_stop()) return;
            PassCounts own;
            const TrackingCounts before = tracking_counts;
            f(tile, own);
            own.tracking = tracking_counts.since(before);
            const std::lock_guard<std::mutex> lock(mutex);
            counts.add(own);
        });
    }
    /// `kept`: where rays are taken from; null: drawn.
    void fill_initial(const Tile& tile, uint32_t pass, const DomainStore* kept, FinishedPass& now,
                      PassCounts& n);
    /// Adds a pass to the pixels, with all their parts; returns how many were dropped.
    int64_t finish_pass(Buffer2D<PixelFilm>& pixels);
    /// All of a pass's work on surfaces, after fill_initial.
    void pass_over_surfaces(const ReusePlan& plan, uint32_t pass, const FinishedPass& before,
                            FinishedPass& now);
};

/// Candidates of one pixel in a tile's list.
struct CandidateRange {
    size_t first = 0;
    size_t count = 0;
};

void ReusingFrame::fill_initial(const Tile& tile, uint32_t pass, const DomainStore* kept,
                                FinishedPass& now, PassCounts& n)
{
    const FrameDomain& frame = inputs.domain;
    TileRays corrections;
    LightRays shadows;
    LightRays lamp_rays;
    std::vector<Candidate> candidates;
    std::vector<CandidateRange> ranges;
    std::vector<FilmSample*> samples;
    std::vector<PathVertex> first_vertices;
    std::vector<PixelPart> parts;
    std::vector<DuePart> main_parts;
    std::vector<DuePart> other_parts;
    PartScratch traced;
    std::vector<OtherPart> others;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const PassKey key{x, y, pass};
            buffers.samples.at(x, y) = {};
            buffers.acceptance.at(x, y) = {};
            const Ray ray = kept ? kept->ray(x, y) : camera_ray(inputs, key);
            parts.assign(1, {ray, 1.0f});
            if (!kept) split_pixel(inputs, key, ray, parts);
            main_parts.push_back({key, parts[0]});
            for (uint32_t i = 1; i < parts.size(); ++i) {
                other_parts.push_back({{x, y, pass, i}, parts[i]});
                others.push_back({pixel_index(x, y), {}});
            }
        }
    }
    trace_parts(inputs, other_parts, traced, n);
    const auto begin_pixel = [&](size_t i, PixelDomain& domain) {
        const PassKey& key = main_parts[i].key;
        FilmSample& sample = buffers.samples.at(key.x, key.y);
        const auto owner = static_cast<int>(i);
        samples.push_back(&sample);
        sample.weight = main_parts[i].part.weight;
        look_for_lamps(inputs, key, owner, 1.0f / sample.weight, lamp_rays);
        SurfaceDomain surface;
        begin_pass(inputs, key, domain, owner, surface, corrections, first_vertices, sample, n);
        if (inputs.render.path.max_bounces == 0) surface.share = 0.0f;
        if (now.surfaces.size() > 0) now.surfaces.at(key.x, key.y) = surface;
        const size_t first = candidates.size();
        const bool is_lit = frame.has_sampled_lights() && !domain.bins.empty() &&
                            inputs.render.path.max_bounces > 0;
        if (is_lit) {
            weigh_bins(frame, domain);
            Rng numbers = pass_rng(inputs, key, Stream::Initial);
            draw_candidates(frame, domain, frame.params.candidates, numbers, candidates);
        }
        if (!is_lit || !reuses_media) domain.bins.count = 0;  // no event to remember
        now.domains.store(key.x, key.y, domain);
        ranges.push_back({first, candidates.size() - first});
        sample.exact_rays += static_cast<float>(candidates.size() - first);
        sample.work.x = static_cast<float>(candidates.size() - first);
        for (size_t j = first; j < candidates.size(); ++j) {
            Candidate& c = candidates[j];
            if (frame.params.visibility == TargetVisibility::Cached) {
                c.f *= cached_visibility(frame, c.y, c.x, c.arrival);
            } else {
                const float tau_max =
                    reuses_media ? infinity
                                 : depth_that_matters(c.f / c.density, luminance(sample.L()));
                shadows.add(static_cast<int>(j), c.x, c.arrival.wi, c.arrival.distance,
                            domain.ray.time, c.f, tau_max);
            }
        }
    };
    std::vector<PixelDomain> domains;
    for_each_domain(
        frame, main_parts.size(), [&](size_t i) -> const Ray& { return main_parts[i].part.ray; },
        domains, n.bins, begin_pixel);
    shade_parts(inputs, {tile.x0, tile.y0, pass, 1}, traced, n);
    for (size_t i = 0; i < others.size(); ++i) others[i].sample = traced.samples[i];
    if (!others.empty()) {
        const std::lock_guard<std::mutex> lock(mutex);
        buffers.others.insert(buffers.others.end(), others.begin(), others.end());
    }
    n.candidates += static_cast<int64_t>(candidates.size());
    const std::vector<Spectrum> shared =
        light_shared_paths(inputs, {tile.x0, tile.y0, pass}, first_vertices, n);
    for (size_t i = 0; i < shared.size(); ++i) samples[i]->indirect += shared[i];
    corrections.trace(frame, n.guesses, n.light_rays, [&](int of, Spectrum value) {
        FilmSample& sample = *samples[static_cast<size_t>(of)];
        sample.direct += value;
        sample.exact_rays += 1.0f;
    });
    add_seen_lamps(*frame.scene, lamp_rays, n.lamps,
                   [&](int of) -> FilmSample& { return *samples[static_cast<size_t>(of)]; });
    shadows.trace(*frame.scene, n.light_rays);
    for (size_t i = 0; i < shadows.size(); ++i) {
        candidates[static_cast<size_t>(shadows.owners[i])].f = shadows.value(i);
    }
    size_t pixel = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const CandidateRange& range = ranges[pixel++];
            Rng numbers = pass_rng(inputs, {x, y, pass}, Stream::Shade);
            buffers.current.at(x, y) = resample({candidates.data() + range.first, range.count},
                                                numbers, buffers.colors.at(x, y));
        }
    }
}

int64_t ReusingFrame::finish_pass(Buffer2D<PixelFilm>& pixels)
{
    // Tiles came in any order; the parts of one pixel are in theirs.
    std::vector<OtherPart>& others = buffers.others;
    std::stable_sort(others.begin(), others.end(),
                     [](const OtherPart& a, const OtherPart& b) { return a.pixel < b.pixel; });
    auto other = others.begin();
    int64_t dropped = 0;
    std::vector<FilmSample> parts;
    for (size_t i = 0; i < pixels.size(); ++i) {
        FilmSample& sample = buffers.samples.data()[i];
        const Reservoir& r = buffers.current.data()[i].r;
        sample.direct += buffers.colors.data()[i];
        sample.reservoir = Vec3(r.M, r.W, r.age);
        sample.work.z = buffers.acceptance.data()[i].share();
        parts.assign(1, sample);
        for (; other != others.end() && other->pixel == i; ++other) parts.push_back(other->sample);
        dropped += pixels.data()[i].add(parts) ? 0 : 1;
    }
    others.clear();
    return dropped;
}

void ReusingFrame::pass_over_surfaces(const ReusePlan& plan, uint32_t pass,
                                      const FinishedPass& before, FinishedPass& now)
{
    const FrameDomain& frame = inputs.domain;
    SurfaceBuffers& surfaces = buffers.surfaces;
    for_tiles([&](const Tile& tile, PassCounts& n) {
        fill_surface_reservoirs(inputs, tile, pass, now.surfaces, surfaces, buffers.samples, n);
    });
    const ReuseOutput out{surfaces.next, surfaces.colors, buffers.acceptance};
    if (plan.surface_temporal && before.surfaces.size() > 0) {
        const bool still = !change_between(before.frame, frame).any();
        for_tiles([&](const Tile& tile, PassCounts& n) {
            Combination scratch(surface_temporal_rules(frame.params, still));
            reuse_surfaces_in_time({frame, now.surfaces, surfaces.current}, before, still, tile,
                                   rng(Stream::SurfaceTemporal, pass), scratch, out, n.light_rays,
                                   n.reuse);
        });
        std::swap(surfaces.current, surfaces.next);
    }
    const auto keep = [&] {
        for (size_t i = 0; i < now.surface_reservoirs.size(); ++i) {
            now.surface_reservoirs.data()[i] = surfaces.current.data()[i].r;
        }
    };
    if (!frame.params.surface.feedback) keep();
    if (plan.surface_spatial) {
        for_tiles([&](const Tile& tile, PassCounts& n) {
            Combination scratch(surface_spatial_rules(frame.params));
            reuse_surfaces_in_space({frame, now.surfaces, surfaces.current}, tile,
                                    rng(Stream::SurfaceSpatial, pass), scratch, out, n.light_rays,
                                    n.reuse);
        });
        std::swap(surfaces.current, surfaces.next);
    }
    if (frame.params.surface.feedback) keep();
    if (frame.params.surface.visibility == SurfaceVisibility::None && !shades_all(frame.params)) {
        for_tiles([&](const Tile& tile, PassCounts& n) {
            shade_surface_reservoirs(frame, tile, now.surfaces, surfaces, n);
        });
    }
    for (size_t i = 0; i < now.surfaces.size(); ++i) {
        buffers.samples.data()[i].surface_direct +=
            now.surfaces.data()[i].share * surfaces.colors.data()[i];
    }
}

}  // namespace

ReusePlan plan_reuse(const FrameDomain& domain, const RenderDescription& render,
                     const std::optional<Change>& change)
{
    if (domain.params.reuse == ReuseMode::Auto) {
        ReusePlan plan;
        plan.keeps_passes = render.samples == 1;
        plan.accumulates = plan.keeps_passes && change && !change->any();
        plan.surface_temporal = plan.keeps_passes && !plan.accumulates &&
                                render.path.max_bounces > 0 && domain.scene->surfaces &&
                                domain.caches->local_lights.size() >= many_lamps;
        plan.paths = !plan.accumulates && reuses_paths(*domain.scene, render);
        return plan;
    }
    if (render.path.max_bounces == 0) return {};
    const ReuseMode mode = domain.params.reuse;
    const bool temporal = mode == ReuseMode::Temporal || mode == ReuseMode::Both;
    const bool spatial = mode == ReuseMode::Spatial || mode == ReuseMode::Both;
    ReusePlan plan;
    plan.temporal = temporal && domain.has_sampled_lights();
    plan.spatial = spatial && domain.has_sampled_lights();
    plan.surface_temporal = temporal && domain.scene->surfaces;
    plan.surface_spatial = spatial && domain.scene->surfaces;
    plan.paths = reuses_paths(*domain.scene, render);
    return plan;
}

bool render_reusing_passes(const PassInputs& inputs, const ReusePlan& plan,
                           const FrameControl& control, FinishedPass& before, Film& film,
                           PassCounts& counts, int64_t& dropped, Buffer2D<PixelFilm>& kept,
                           FinishedPaths& paths)
{
    const FrameDomain& frame = inputs.domain;
    const int width = frame.scene->camera.width;
    const int height = frame.scene->camera.height;
    ReusingFrame run(inputs, plan, control, counts);
    PassBuffers& buffers = run.buffers;
    Buffer2D<PixelFilm> pixels(width, height);
    const bool matches =
        !before.empty() && before.domains.width() == width && before.domains.height() == height;
    if (!matches) before = {};
    // Where nothing changed a pixel keeps its camera ray: history then fits exactly. On another ray
    // through the pixel it is worth less than nothing (measured: ten times the noise). Several
    // passes of one frame need rays of their own to cover the pixel.
    const bool keeps_rays = (plan.temporal || plan.surface_temporal) &&
                            inputs.render.samples == 1 && !before.empty() &&
                            !change_between(before.frame, frame).any();
    for (uint32_t pass = 0; pass < static_cast<uint32_t>(inputs.render.samples); ++pass) {
        FinishedPass now{frame, DomainStore(width, height), Buffer2D<Reservoir>(width, height)};
        if (frame.scene->surfaces) {
            now.surfaces = Buffer2D<SurfaceDomain>(width, height);
            now.surface_reservoirs = Buffer2D<Reservoir>(width, height);
        }
        if (plan.paths) {
            light_reused_paths(
                inputs, pass, [&](const auto& f) { run.for_tiles(f); }, paths, *inputs.path_light);
        }
        const DomainStore* old_rays = keeps_rays ? &before.domains : nullptr;
        run.for_tiles([&](const Tile& tile, PassCounts& n) {
            run.fill_initial(tile, pass, old_rays, now, n);
        });
        if (frame.scene->surfaces) run.pass_over_surfaces(plan, pass, before, now);
        const ReuseOutput out{buffers.next, buffers.colors, buffers.acceptance};
        if (plan.temporal && !before.empty()) {
            const bool still = !change_between(before.frame, frame).any();
            run.for_tiles([&](const Tile& tile, PassCounts& n) {
                Combination scratch(temporal_rules(frame.params, still));
                reuse_in_time({frame, now.domains, buffers.current}, before, still, tile,
                              run.rng(Stream::Temporal, pass), scratch, out, n.light_rays, n.reuse);
            });
            std::swap(buffers.current, buffers.next);
        }
        const auto keep = [&] {
            for (size_t i = 0; i < now.reservoirs.size(); ++i) {
                now.reservoirs.data()[i] = buffers.current.data()[i].r;
            }
        };
        if (!frame.params.spatial.feedback) keep();
        if (plan.spatial) {
            run.for_tiles([&](const Tile& tile, PassCounts& n) {
                Combination scratch(spatial_rules(frame.params));
                reuse_in_space({frame, now.domains, buffers.current}, tile,
                               run.rng(Stream::Spatial, pass), scratch, out, n.light_rays, n.reuse);
            });
            std::swap(buffers.current, buffers.next);
        }
        if (frame.params.spatial.feedback) keep();
        if (frame.params.visibility != TargetVisibility::Exact) {
            run.for_tiles([&](const Tile& tile, PassCounts& n) {
                shade_chosen({frame, now.domains, buffers.current}, tile, buffers.colors,
                             n.light_rays);
            });
        }
        if (run.stopped) return false;
        dropped += run.finish_pass(pixels);
        before = std::move(now);
    }
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) film.store(x, y, pixels.at(x, y));
    }
    if (plan.keeps_passes) kept = std::move(pixels);
    return true;
}

}  // namespace mote
