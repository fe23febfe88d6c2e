#include "multiscatter/radiance_cache.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/parallel.h"
#include "core/sampling.h"
#include "multiscatter/next_event.h"
#include "restir/cache_stats.h"
#include "volumes/media_at.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

constexpr size_t grain = 16;  ///< nodes per task

/// What arrives at a node, by one direction in each of `count` strata of the sphere. `goes_on`: the
/// mean weight with which their walks go on in media.
RadianceCache::Node trace_node(const TraceContext& context, Vec3 x, int count, uint32_t slot,
                               uint32_t seed, float& goes_on)
{
    constexpr float golden = 0.618034f;  // turns from one stratum to the next are spread evenly
    const auto frame = static_cast<uint32_t>(context.scene.frame);
    RadianceCache::Node node;
    node.fill(Spectrum(0.0f));
    for (int i = 0; i < count; ++i) {
        Rng rng(seed, frame, Stream::RadianceCache, slot, static_cast<uint32_t>(i));
        const Vec2 u = rng.uniform2();
        const float turn = u.y + golden * static_cast<float>(i);
        const Vec3 wi = sample_sphere(
            {(static_cast<float>(i) + u.x) / static_cast<float>(count), turn - std::floor(turn)});
        LightRay ray{Ray{x, wi, cache_time}, sample_sphere_pdf(), false};
        const TracedSegment segment = trace_segment(context, ray, false, rng);
        const std::optional<NextEvent> next = next_event(context.scene, ray.ray, segment);
        if (!next) continue;
        if (next->event.phase) {
            goes_on += max_component(next->albedo) / static_cast<float>(count);
        }
        float cut = 0.0f;
        const Spectrum light = next->albedo * light_of_event(context, next->event, 2, rng, cut) /
                               (sample_sphere_pdf() * static_cast<float>(count));
        const ShBasis basis = eval_sh(wi);
        for (size_t k = 0; k < sh_count; ++k) node[k] += basis[k] * light;
    }
    return node;
}

/// An even share of the smoke's extent for each node that may be spent.
float choose_spacing(const Media& media, int nodes)
{
    Bounds3 box;
    for (const Volume& volume : media.volumes) {
        if (!is_void(volume)) box.extend(world_bounds(volume));
    }
    const Vec3 extent = box.extent();
    return std::cbrt(extent.x * extent.y * extent.z / static_cast<float>(nodes));
}

/// Events of walks that start where media collide most, as if all events were alike.
float mean_events(const Media& media, const SmokeLattice& lattice, std::span<const float> goes_on)
{
    double collisions = 0.0;
    double survived = 0.0;
    for (size_t i = 1; i < goes_on.size(); ++i) {
        const auto sigma_t =
            static_cast<double>(sigma_t_at(media, lattice.position(lattice.nodes[i]), cache_time));
        collisions += sigma_t;
        survived += sigma_t * static_cast<double>(goes_on[i]);
    }
    if (!(collisions > 0.0)) return 1.0f;
    return static_cast<float>(1.0 / std::max(1.0 - survived / collisions, 1e-6));
}

}  // namespace

RadianceCacheParams share_of_paths(int64_t paths, int share, uint32_t seed)
{
    constexpr int64_t fewest = 16;  // directions that a node is worth having with
    const int64_t nodes = std::clamp<int64_t>(paths / (share * fewest), 64, 4096);
    const int64_t directions = std::clamp<int64_t>(paths / (share * nodes), fewest, 256);
    return {static_cast<int>(directions), static_cast<int>(nodes), seed};
}

RadianceCache make_radiance_cache(const TraceContext& context, const RadianceCacheParams& params)
{
    const double start = process_cpu_seconds();
    RadianceCache cache;
    const Media& media = context.scene.media;
    cache.lattice = make_smoke_lattice(media, choose_spacing(media, params.nodes), params.nodes);
    cache.incident.resize(cache.lattice.nodes.size());
    cache.incident[0].fill(Spectrum(0.0f));
    std::vector<float> goes_on(cache.incident.size(), 0.0f);
    parallel_for(cache.incident.size() - 1, grain, [&](size_t begin, size_t end) {
        for (size_t i = begin + 1; i < end + 1; ++i) {
            cache.incident[i] =
                trace_node(context, cache.lattice.position(cache.lattice.nodes[i]),
                           params.directions, static_cast<uint32_t>(i), params.seed, goes_on[i]);
        }
    });
    cache.mean_events = mean_events(media, cache.lattice, goes_on);
    cache.cpu_seconds = process_cpu_seconds() - start;
    return cache;
}

Spectrum eval_cached_light(const RadianceCache& cache, const ScatterEvent& event)
{
    const Phase& phase = *event.phase;
    const ShBasis basis = eval_sh(-event.wo);
    const float a[3] = {1.0f, phase.g, phase.g * phase.g};
    const float b[3] = {1.0f, phase.g_b, phase.g_b * phase.g_b};
    ShBasis kernel;
    for (size_t k = 0; k < sh_count; ++k) {
        const int l = sh_order[k];
        kernel[k] = basis[k] * (a[l] + phase.weight_b * (b[l] - a[l]));
    }
    const SmokeLattice::Corners corners = cache.lattice.corners(event.x);
    Spectrum sum(0.0f);
    float weights = 0.0f;
    for (int n = 0; n < 8; ++n) {
        if (corners.slot[n] == 0) continue;
        const RadianceCache::Node& node = cache.incident[static_cast<size_t>(corners.slot[n])];
        Spectrum light(0.0f);
        for (size_t k = 0; k < sh_count; ++k) light += kernel[k] * node[k];
        sum += corners.weight[n] * light;
        weights += corners.weight[n];
    }
    return weights > 0.0f ? glm::max(sum / weights, Spectrum(0.0f)) : Spectrum(0.0f);
}

}  // namespace mote
