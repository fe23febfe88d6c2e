#include "multiscatter/scatter_along.h"

#include <cmath>

#include "restir/pixel_domain.h"
#include "volumes/media_at.h"

namespace mote {
namespace {

/// Trilinear between active nodes alone.
Spectrum light_between(const ScatterNodes& nodes, const SmokeLattice::Corners& corners,
                       size_t phase)
{
    Spectrum sum(0.0f);
    float weights = 0.0f;
    for (int n = 0; n < 8; ++n) {
        if (corners.slot[n] == 0) continue;
        sum += corners.weight[n] * nodes.at(phase, corners.slot[n]);
        weights += corners.weight[n];
    }
    return weights > 0.0f ? sum / weights : sum;
}

/// Source function at a point; black where nothing scatters.
Spectrum source_at_edge(const ScatterNodes& nodes, const Media& media, Vec3 x, float time)
{
    const SmokeLattice::Corners corners = nodes.lattice.corners(x);
    Spectrum sum(0.0f);
    for_each_scatterer(media, x, time, [&](const Volume& volume, float share, Spectrum albedo) {
        const auto index = static_cast<size_t>(&volume - media.volumes.data());
        const auto phase = static_cast<size_t>(nodes.phases.of_volume[index]);
        sum += share * albedo * light_between(nodes, corners, phase);
    });
    return sum;
}

}  // namespace

Spectrum scatter_along(const ScatterNodes& nodes, const Media& media, const Ray& ray,
                       const RayBins& bins)
{
    Spectrum sum(0.0f);
    if (bins.empty()) return sum;
    Spectrum near = source_at_edge(nodes, media, ray.at(bins.world_t(bins.s[0])), ray.time);
    for (int k = 0; k < bins.count; ++k) {
        const Vec3 x = ray.at(bins.world_t(bins.s[k + 1]));
        Spectrum far = source_at_edge(nodes, media, x, ray.time);
        // At the border of all media, what is inside counts.
        if (far == Spectrum(0.0f)) far = near;
        if (near == Spectrum(0.0f)) near = far;
        const Vec2 weights = std::exp(-bins.tau[k]) * linear_weights(bins.depth_of_bin(k));
        sum += weights.x * near + weights.y * far;
        near = far;
    }
    return sum;
}

}  // namespace mote
