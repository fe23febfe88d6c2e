#include "render/frame.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "reference/path_tracer.h"
#include "render/film.h"
#include "render/metadata.h"
#include "render/motion.h"
#include "render/restir_frame.h"
#include "render/view_depth.h"
#include "restir/cache_stats.h"

namespace mote {
namespace {

/// What every sample of the frame needs.
struct FrameInputs {
    const Scene& scene;
    const RenderDescription& render;
    AovSet aovs;
    LightSampler lights;
};

/// Few enough that a stop takes effect at once, many enough that asking costs nothing.
constexpr int samples_between_polls = 32;

/// Normal and place of the first surface on a camera ray; returns its distance.
float add_first_surface(const Surfaces& surfaces, const Ray& ray, FilmSample& sample)
{
    const std::optional<SurfaceHit> hit = intersect(surfaces, ray, {0.0f, infinity});
    if (!hit) return infinity;
    const SurfaceVertex vertex = make_vertex(surfaces, *hit, ray.time);
    sample.has_surface = true;
    sample.normal = glm::dot(vertex.ng, ray.d) < 0.0f ? vertex.ns : -vertex.ns;
    sample.position = vertex.p;
    sample.surface_distance = hit->t;
    sample.material = surfaces.material_index(hit->object);
    return hit->t;
}

FilmSample trace_sample(const FrameInputs& frame, int x, int y, uint32_t sample, float& cut)
{
    const Scene& scene = frame.scene;
    const auto frame_number = static_cast<uint32_t>(scene.frame);
    const auto pixel = static_cast<uint32_t>(y * scene.camera.width + x);
    Rng camera_rng(frame.render.seed, frame_number, Stream::Camera, pixel, sample);
    const Vec2 film = Vec2(x, y) + camera_rng.uniform2();
    const Vec2 lens = camera_rng.uniform2();
    const Ray ray = generate_ray(scene.camera, film, lens, camera_rng.uniform());

    Rng path_rng(frame.render.seed, frame_number, Stream::Path, pixel, sample);
    const PathResult path = trace_path(scene, frame.lights, frame.render.path, ray, path_rng);
    cut = path.cut;
    FilmSample out;
    out.direct = path.direct;
    out.indirect = path.indirect;
    out.emission = path.emission;
    out.background = path.background;
    out.surface_direct = path.surface_direct;
    out.surface_indirect = path.surface_indirect;
    out.surface_emission = path.surface_emission;
    out.on_surface = path.object >= 0;
    out.transmittance = path.transmittance;
    out.collided = path.depth < infinity;
    out.albedo = path.albedo;
    const AovSet& aovs = frame.aovs;
    if (out.collided) {
        out.depth =
            aovs.needs_first_collision() ? view_depth(scene.camera, ray, path.depth) : path.depth;
    }
    if (aovs.needs_motion()) out.motion = film_motion(scene, ray, path.depth, path.object);
    const bool needs_depth = aovs.has(Aov::Transmittance) || aovs.has(Aov::OpticalDepth);
    float t_surface = infinity;
    if (scene.surfaces && (needs_depth || aovs.needs_first_surface())) {
        t_surface = add_first_surface(*scene.surfaces, ray, out);
    }
    if (needs_depth) out.optical_depth = optical_depth(scene.media, ray, {0.0f, t_surface});
    return out;
}

/// All samples by the path tracer. False if stopped.
bool render_paths(const FrameInputs& frame, const FrameControl& control, Film& film,
                  FrameStats& stats)
{
    const Camera& camera = frame.scene.camera;
    std::atomic<bool> stopped{false};
    std::atomic<int64_t> dropped{0};
    std::mutex mutex;
    TrackingCounts tracking;
    Truncation truncation;
    const auto must_stop = [&] {
        if (control.stop && control.stop()) stopped.store(true, std::memory_order_relaxed);
        return stopped.load(std::memory_order_relaxed);
    };
    for_each_tile(camera.width, camera.height, [&](const Tile& tile) {
        int64_t tile_dropped = 0;
        Truncation truncation_here;
        const TrackingCounts tracking_before = tracking_counts;
        for (int y = tile.y0; y < tile.y1; ++y) {
            for (int x = tile.x0; x < tile.x1; ++x) {
                PixelFilm pixel;
                for (int i = 0; i < frame.render.samples; ++i) {
                    if (i % samples_between_polls == 0 && must_stop()) return;
                    float cut = 0.0f;
                    const FilmSample sample =
                        trace_sample(frame, x, y, static_cast<uint32_t>(i), cut);
                    tile_dropped += pixel.add(sample) ? 0 : 1;
                    truncation_here.add(cut);
                }
                film.store(x, y, pixel);
            }
        }
        dropped += tile_dropped;
        {
            const std::lock_guard<std::mutex> lock(mutex);
            tracking.add(tracking_counts.since(tracking_before));
            truncation.add(truncation_here);
        }
        if (control.tile_done) control.tile_done();
    });
    stats.dropped_non_finite = dropped;
    stats.truncation = truncation;
    stats.tracking = tracking;
    return !stopped;
}

size_t grid_bytes(const Media& media)
{
    std::set<const void*> seen;  // volumes may share grids
    size_t bytes = 0;
    const auto add = [&](const BrickGrid* grid) {
        if (grid != nullptr && seen.insert(grid).second) bytes += grid->memory_bytes();
    };
    for (const Volume& volume : media.volumes) {
        for (const auto& grid : {volume.density, volume.temperature, volume.emission}) {
            add(grid.get());
        }
        for (const auto& grid : {volume.color, volume.velocity}) {
            for (int c = 0; grid && c < 3; ++c) add(&grid->channel[c]);
        }
    }
    return bytes;
}

size_t image_bytes(const LayeredImage& image)
{
    size_t bytes = 0;
    for (const Channel& channel : image.channels) bytes += channel.data.size() * sizeof(float);
    return bytes;
}

}  // namespace

FrameHistory::FrameHistory() : impl_(std::make_unique<Impl>()) {}
FrameHistory::~FrameHistory() = default;

void FrameHistory::expect_no_more()
{
    impl_->is_last = true;
}

bool uses_history(const RenderDescription& render)
{
    if (render.estimator != EstimatorKind::Restir) return false;
    if (render.path.max_bounces > 1 && reuses_paths_in_time(render.restir)) return true;
    switch (render.restir.reuse) {
        case ReuseMode::Off:
        case ReuseMode::Spatial:
            return false;
        case ReuseMode::Auto:
            return render.samples == 1;
        case ReuseMode::Temporal:
        case ReuseMode::Both:
            return true;
    }
    return false;
}

LayeredImage render_frame(const Scene& scene, const RenderDescription& render,
                          const OutputDescription& output, FrameHistory& history,
                          StopRequested stop, FrameStats& stats, TileDone tile_done)
{
    const auto start = std::chrono::steady_clock::now();
    const double cpu_start = process_cpu_seconds();
    const AovSet aovs = parse_aovs(output.aovs);
    if (scene.surfaces && render.estimator == EstimatorKind::March) {
        throw Error(ExitCode::Input, "the ray marcher cannot render [[objects]]; use \"path\"");
    }
    // A million lamps take a second to sort; only paths of their own need that.
    const bool follows_paths =
        render.estimator == EstimatorKind::Path ||
        (render.estimator == EstimatorKind::Restir && render.path.max_bounces > 1);
    const FrameInputs frame{
        scene, render, aovs,
        follows_paths ? build_light_sampler(scene, render.path) : LightSampler()};
    const Camera& camera = scene.camera;
    const FrameControl control{stop, tile_done};
    Film film(camera.width, camera.height, aovs, output.color_type);
    const auto render_all = [&] {
        FrameHistory::Impl& kept = history.impl();
        switch (render.estimator) {
            case EstimatorKind::Path:
                return render_paths(frame, control, film, stats);
            case EstimatorKind::Restir:
                return render_restir(scene, render, aovs, frame.lights, control, kept, film, stats);
            case EstimatorKind::March:
                return render_marched(scene, render, control, kept.march, film, stats);
        }
        return false;
    };
    const bool finished = render_all();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    stats.render_seconds = wall.count();
    stats.render_cpu_seconds = process_cpu_seconds() - cpu_start;
    stats.paths = finished ? int64_t{render.samples} * camera.width * camera.height : 0;
    if (!finished) return {};
    LayeredImage image = film.take();
    stats.memory.grids = grid_bytes(scene.media);
    stats.memory.film = image_bytes(image);
    image.attributes = camera_attributes(camera);
    return image;
}

}  // namespace mote
