#include "render/march_frame.h"

#include <atomic>

#include "core/parallel.h"
#include "render/restir_frame.h"
#include "render/view_depth.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

/// Points of Roberts' R2 sequence (2018), from the middle on.
Vec2 r2_point(int i, Vec2 step)
{
    return glm::fract(Vec2(0.5f) + static_cast<float>(i) * step);
}

constexpr Vec2 film_step{0.7548776662f, 0.5698402910f};
constexpr Vec2 lens_step{0.8191725134f, 0.6710436067f};

FilmSample march_sample(const Scene& scene, const Marcher& marcher, bool scatters, int x, int y,
                        int sample, int64_t& steps)
{
    const Vec2 film = Vec2(x, y) + r2_point(sample, film_step);
    const Ray ray = generate_ray(scene.camera, film, r2_point(sample, lens_step), cache_time);
    const MarchResult marched = marcher.march(ray);
    steps += marched.steps;
    FilmSample out;
    if (scatters) out.direct = marched.direct;
    out.emission = marched.emission;
    out.background = marched.background;
    out.transmittance = marched.transmittance;
    out.optical_depth = -std::log(std::max(marched.transmittance, 1e-38f));
    return out;
}

/// Shadows of the frame before where nothing changed, else new ones.
void update_shadows(const Scene& scene, const MarchParams& params, MarchHistory& history,
                    FrameStats& stats)
{
    const double start = process_cpu_seconds();
    MediaKey media = media_key(scene.media);
    std::vector<MarchLight> lights = march_lights(scene, params.sky_bands);
    const bool same = history.shadows && history.media == media && history.lights == lights;
    if (!same) {
        history.shadows = std::make_shared<const ShadowGrid>(scene.media, lights, params);
        history.media = std::move(media);
        history.lights = std::move(lights);
    }
    (same ? stats.caches_reused : stats.caches_built) = 1;
    stats.caches.map_bytes = static_cast<int64_t>(history.shadows->memory_bytes());
    stats.cache_cpu_seconds = process_cpu_seconds() - start;
}

}  // namespace

bool render_marched(const Scene& scene, const RenderDescription& render,
                    const FrameControl& control, MarchHistory& history, Film& film,
                    FrameStats& stats)
{
    update_shadows(scene, render.march, history, stats);
    const Marcher marcher(scene, render.march, history.lights, history.shadows);
    const bool scatters = render.path.max_bounces > 0;
    std::atomic<bool> stopped{false};
    std::atomic<int64_t> dropped{0};
    std::atomic<int64_t> steps{0};
    for_each_tile(scene.camera.width, scene.camera.height, [&](const Tile& tile) {
        if (control.stop && control.stop()) stopped = true;
        if (stopped) return;
        int64_t tile_dropped = 0;
        int64_t tile_steps = 0;
        for (int y = tile.y0; y < tile.y1; ++y) {
            for (int x = tile.x0; x < tile.x1; ++x) {
                PixelFilm pixel;
                for (int i = 0; i < render.samples; ++i) {
                    const FilmSample sample =
                        march_sample(scene, marcher, scatters, x, y, i, tile_steps);
                    tile_dropped += pixel.add(sample) ? 0 : 1;
                }
                film.store(x, y, pixel);
            }
        }
        dropped += tile_dropped;
        steps += tile_steps;
        if (control.tile_done) control.tile_done();
    });
    stats.dropped_non_finite = dropped;
    stats.tracking = {};
    stats.tracking.lookups = steps;
    return !stopped;
}

}  // namespace mote
