#pragma once

#include <algorithm>
#include <vector>

#include "restir/coarse_extinction.h"
#include "restir/light_clusters.h"

namespace mote {

/// Fluence [W/m^2] that a cluster brings to points around x, shadows and scattering apart; finite.
/// `blur2`: squared distance [m^2] below which the inverse square law is levelled off.
[[nodiscard]] inline float cluster_fluence(const LightCluster& cluster, Vec3 x, float blur2)
{
    const Vec3 to_x = x - cluster.centre;
    const float distance2 = glm::dot(to_x, to_x);
    const float floored2 = std::max(distance2, std::max(0.5f * cluster.spread2, blur2));
    const float fluence = cluster.power * inv_4pi / std::max(floored2, 1e-30f);
    if (cluster.facing == Vec3(0.0f)) return fluence;
    // A cosine lobe to its first order, 1 + 2 cos: right on average, never quite dark.
    const float cos_theta = glm::dot(cluster.facing, to_x) / std::sqrt(std::max(floored2, 1e-30f));
    return fluence * std::max(0.05f, 1.0f + 2.0f * cos_theta);
}

/// Chooses clusters that cover all lights once, at most `most`, for the points within `radius` of
/// x: halves again and again the one whose lights may differ most in what they bring, as long as
/// that matters. Writes indices into clusters.nodes, in the lights' order.
/// After Walter et al. 2005, Lightcuts, with a bound that knows of extinction.
void choose_light_cut(const LightClusters& clusters, const CoarseExtinction& extinction, Vec3 x,
                      float radius, int most, std::vector<int>& cut);

}  // namespace mote
