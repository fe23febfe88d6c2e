#include "multiscatter/ray_pyramid.h"

#include <algorithm>
#include <cmath>

#include "multiscatter/paired_paths.h"
#include "restir/media_mixture.h"
#include "restir/ray_flight.h"
#include "volumes/media_extent.h"
#include "volumes/phase_list.h"

namespace mote {
namespace {

/// Pairs per block of each level, and paths of the tile's own ray, for one pair per pixel: measured
/// on a plume; in proportion to the root of variance over cost, times the pixels that share.
constexpr int pairs_of_level[] = {1, 2, 6, 16};
constexpr int root_paths = 128;

/// Side by side up to this many times the distance between the two events, on average, but not for
/// longer than a mean free path: measured, both ways, where the product of variance and cost is
/// least.
float reach_between(const Media& media, const PairedEvent& a, const PairedEvent& b, float time)
{
    constexpr float of_distance = 8.0f;
    const float sigma_t = 0.5f * (sigma_t_at(media, a.x, time) + sigma_t_at(media, b.x, time));
    return std::min(of_distance * glm::length(a.x - b.x), 1.0f / std::max(sigma_t, 1e-30f));
}

/// First index of a level's rays.
size_t first_of(int level)
{
    size_t first = 0;
    for (int above = RayPyramid::levels; above > level; --above) {
        const auto blocks = size_t{1} << (RayPyramid::levels - above);
        first += blocks * blocks;
    }
    return first;
}

/// Share of light that collides on a ray.
float lost_on(const PixelDomain& domain)
{
    return domain.bins.empty() ? 0.0f : -std::expm1(-domain.bins.depth());
}

/// The first event that u stands for, with the share of light that collides as part of its weight.
PairedEvent event_at(const Media& media, const PixelDomain& domain, float u, float u_medium)
{
    PairedEvent event;
    if (domain.bins.empty()) return event;
    event.x = flight_at(media, domain.ray, domain.bins, u).x;
    event.wo = domain.wo();
    const MediaMixture mixture = mixture_at(media, event.x, domain.ray.time);
    for (int i = 0; i < mixture.count; ++i) {
        const MediaMixture::Part& part = mixture.parts[i];
        event.phase = &part.volume->phase;
        event.weight = lost_on(domain) * part.albedo;
        u_medium -= part.share;
        if (u_medium < 0.0f) break;
    }
    return event;
}

bool has_one_phase(const Media& media)
{
    const Phase& first = media.volumes.front().phase;
    return std::all_of(media.volumes.begin(), media.volumes.end(),
                       [&](const Volume& volume) { return is_same_phase(volume.phase, first); });
}

/// I(here) - I(there) by `count` pairs.
Spectrum difference_of(const TraceContext& context, const PixelDomain& here,
                       const PixelDomain& there, int count, Rng& rng, bool& truncated)
{
    const Media& media = context.scene.media;
    const float lost = std::max(lost_on(here), lost_on(there));
    if (!(lost > 0.0f)) return Spectrum(0.0f);
    const float share = 1.0f / paths_worth(lost, count);
    const bool translates = has_one_phase(media);
    Spectrum sum(0.0f);
    for (float u = rng.uniform() * share; u < 1.0f; u += share) {
        const float u_medium = rng.uniform();
        const PairedEvent a = event_at(media, here, u, u_medium);
        const PairedEvent b = event_at(media, there, u, u_medium);
        if (!a.phase && !b.phase) continue;
        const PairedPathParams params{reach_between(media, a, b, here.ray.time), translates};
        sum += share * estimate_difference(context, a, b, here.ray.time, params, rng, truncated);
    }
    return sum;
}

/// I of the tile's ray by `count` paths.
Spectrum light_of_root(const TraceContext& context, const PixelDomain& root, int count, Rng& rng,
                       bool& truncated)
{
    const float lost = lost_on(root);
    if (!(lost > 0.0f)) return Spectrum(0.0f);
    const float share = 1.0f / paths_worth(lost, count);
    Spectrum sum(0.0f);
    for (float u = rng.uniform() * share; u < 1.0f; u += share) {
        const PairedEvent a = event_at(context.scene.media, root, u, rng.uniform());
        if (!a.phase) continue;
        const ScatterEvent event{a.x, a.wo, root.ray.time, a.phase};
        const PathResult path = trace_after_event(context, event, rng);
        truncated |= path.truncated;
        sum += share * a.weight * path.indirect;
    }
    return sum;
}

/// Through the middle of some pixels, of the lens and of the shutter.
Ray middle_ray(const Camera& camera, const Tile& pixels)
{
    const Vec2 lo(pixels.x0, pixels.y0);
    const Vec2 hi(pixels.x1, pixels.y1);
    return generate_ray(camera, 0.5f * (lo + hi), Vec2(0.5f), cache_time);
}

/// Calls f(x0, y0) for the blocks of a level that have pixels; in image pixels.
template <class F>
void for_each_block(const Tile& tile, int level, F&& f)
{
    const int size = 1 << level;
    for (int y = tile.y0; y < tile.y1; y += size) {
        for (int x = tile.x0; x < tile.x1; x += size) f(x, y);
    }
}

}  // namespace

size_t RayPyramid::index_of(int level, int x, int y) const
{
    const auto row = static_cast<size_t>((y - tile.y0) >> level);
    const auto column = static_cast<size_t>((x - tile.x0) >> level);
    return first_of(level) + (row << (levels - level)) + column;
}

void make_ray_pyramid(const FrameDomain& frame, const Tile& tile, RayPyramid& pyramid,
                      BinCounts& counts)
{
    const Camera& camera = frame.scene->camera;
    pyramid.tile = tile;
    pyramid.rays.resize(first_of(0));
    for (int level = RayPyramid::levels; level >= 1; --level) {
        for_each_block(tile, level, [&](int x, int y) {
            const Tile block{x, y, std::min(x + (1 << level), tile.x1),
                             std::min(y + (1 << level), tile.y1)};
            make_pixel_domain(frame, middle_ray(camera, block),
                              pyramid.rays[pyramid.index_of(level, x, y)].domain, counts);
        });
    }
}

void light_ray_pyramid(const TraceContext& context, const RayPyramidParams& params, Rng& rng,
                       RayPyramid& pyramid, bool& truncated)
{
    RayPyramid::SharedRay& root = pyramid.rays.front();
    root.light = light_of_root(context, root.domain, root_paths * params.pairs, rng, truncated);
    for (int level = RayPyramid::levels - 1; level >= 1; --level) {
        for_each_block(pyramid.tile, level, [&](int x, int y) {
            RayPyramid::SharedRay& own = pyramid.rays[pyramid.index_of(level, x, y)];
            const RayPyramid::SharedRay& above = pyramid.ray_of(level + 1, x, y);
            own.light =
                above.light + difference_of(context, own.domain, above.domain,
                                            pairs_of_level[level] * params.pairs, rng, truncated);
        });
    }
}

Spectrum light_of_pixel(const TraceContext& context, const RayPyramidParams& params,
                        const RayPyramid& pyramid, int x, int y, const PixelDomain& domain,
                        Rng& rng, bool& truncated)
{
    const RayPyramid::SharedRay& nearest = pyramid.ray_of(1, x, y);
    return nearest.light +
           difference_of(context, domain, nearest.domain, params.pairs, rng, truncated);
}

bool is_worth_sharing(const FrameDomain& frame, const Tile& tile, BinCounts& counts)
{
    const Scene& scene = *frame.scene;
    if (!frame.caches->local_lights.empty()) return false;
    // Measured on plumes of 240 to 1280 pixels: at 0.1 mean free paths (g = 0.3) pairs and paths of
    // one's own are equally good, at 0.04 pairs are three times better.
    constexpr float most_apart = 0.06f / 0.7f;
    PixelDomain root;
    make_pixel_domain(frame, middle_ray(scene.camera, tile), root, counts);
    if (root.bins.empty()) return true;  // whatever there is, is thin
    float widest = 0.0f;
    for (const Volume& volume : scene.media.volumes) {
        const Phase& phase = volume.phase;
        widest = std::max(widest, phase.weight_b > 0.0f
                                      ? std::max(std::abs(phase.g), std::abs(phase.g_b))
                                      : std::abs(phase.g));
    }
    const Camera& camera = scene.camera;
    float inside = 0.0f;  // length of the ray in smoke
    float at = root.bins.s[0];
    for (int k = 0; k < root.bins.count; ++k) {
        if (!(root.bins.depth_of_bin(k) > 0.0f)) continue;
        inside += root.bins.s[k + 1] - root.bins.s[k];
        if (root.bins.tau[k] < 0.7f) at = root.bins.s[k];
    }
    const float pixel =
        root.bins.world_t(at) * 2.0f * camera.tan_half_fov_y / static_cast<float>(camera.height);
    return pixel * root.bins.depth() < most_apart * (1.0f - widest) * inside;
}

}  // namespace mote
