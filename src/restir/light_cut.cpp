#include "restir/light_cut.h"

#include <algorithm>
#include <cmath>

#include "restir/cluster_lanes.h"

namespace mote {
namespace {

/// A cluster is left whole once its uncertainty is below this share of all light.
constexpr float tolerance = 1e-3f;

struct Candidate {
    int node = 0;
    float fluence = 0.0f;  ///< expected, shadows included
    float error = 0.0f;    ///< how wrong the cluster's weight may be inside
};

float distance2(const Bounds3& box, Vec3 x)
{
    const Vec3 d = glm::max(glm::max(box.lo - x, x - box.hi), Vec3(0.0f));
    return glm::dot(d, d);
}

/// As much as the nearest light might bring if it held all the power, times how far its place may
/// change that.
float uncertainty(const LightCluster& cluster, const Bounds3& bounds, Vec3 x, float radius,
                  float blur2, float tau)
{
    if (cluster.is_leaf()) return 0.0f;
    const float far = std::max(glm::length(cluster.centre - x), 1e-15f);
    const float near = std::max(0.0f, std::sqrt(distance2(bounds, x)) - radius);
    // The transmittance of cluster_lanes.h with v = 1/4.
    const float fade = 1.0f + 0.25f * tau * near / far;
    const float most = cluster.power * inv_4pi / (std::max(sqr(near), blur2) * sqr(sqr(fade)));
    const float size = 0.5f * glm::length(bounds.extent());
    const float spread = size / std::max(near, 1e-15f) + tau * size / far;
    return most * std::min(1.0f, sqr(spread));
}

}  // namespace

void choose_light_cut(const LightClusters& clusters, const CoarseExtinction& extinction, Vec3 x,
                      float radius, int most, std::vector<int>& cut)
{
    cut.clear();
    if (clusters.nodes.empty()) return;
    constexpr int steps = 8;
    const float blur2 = sqr(0.5f * radius);
    std::vector<Candidate> candidates{{0, 0.0f, infinity}};
    candidates.reserve(static_cast<size_t>(most) + 1);
    float total = 0.0f;
    while (static_cast<int>(candidates.size()) < most) {
        // As many of the worst as fill the lanes, each replaced by its left half, the right half
        // appended.
        ClusterLanes lanes;
        size_t slots[lane_count];
        int count = 0;
        const size_t old_count = candidates.size();
        while (count < lane_count && static_cast<int>(candidates.size()) < most) {
            size_t worst = 0;
            for (size_t i = 1; i < old_count; ++i)
                if (candidates[i].error > candidates[worst].error) worst = i;
            Candidate& parent = candidates[worst];
            const LightCluster& node = clusters.nodes[static_cast<size_t>(parent.node)];
            if (node.is_leaf() || !(parent.error > tolerance * total)) break;
            total -= parent.fluence;
            parent = {parent.node + 1, 0.0f, 0.0f};
            candidates.push_back({node.right, 0.0f, 0.0f});
            for (const size_t slot : {worst, candidates.size() - 1}) {
                slots[count] = slot;
                const auto n = static_cast<size_t>(candidates[slot].node);
                lanes.set(count++, clusters.nodes[n]);
            }
        }
        if (count == 0) break;
        FluenceLanes fluence;
        eval_fluence(lanes, extinction, x, blur2, steps, fluence);
        for (int l = 0; l < count; ++l) {
            Candidate& candidate = candidates[slots[l]];
            const auto n = static_cast<size_t>(candidate.node);
            const LightCluster& node = clusters.nodes[n];
            candidate.fluence = fluence.weight[l];
            candidate.error =
                uncertainty(node, clusters.bounds[n], x, radius, blur2, fluence.tau[l]);
            total += candidate.fluence;
        }
    }
    for (const Candidate& candidate : candidates) cut.push_back(candidate.node);
    std::sort(cut.begin(), cut.end());  // parents precede children: the lights' order
}

}  // namespace mote
