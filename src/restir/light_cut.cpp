#include "restir/light_cut.h"

#include <cmath>

namespace mote {
namespace {

/// A cluster is left whole once its uncertainty is below this share of all light.
constexpr float tolerance = 1e-3f;

struct Candidate {
    float fluence = 0.0f;  ///< expected, shadows included
    float error = 0.0f;    ///< how wrong choosing by power alone may be inside
};

float distance2(const Bounds3& box, Vec3 x)
{
    const Vec3 d = glm::max(glm::max(box.lo - x, x - box.hi), Vec3(0.0f));
    return glm::dot(d, d);
}

Candidate weigh(const LightCluster& cluster, const CoarseExtinction& extinction, Vec3 x,
                float radius)
{
    const float blur2 = sqr(0.5f * radius);
    const float tau = coarse_optical_depth(extinction, x, cluster.centre);
    Candidate out;
    out.fluence = cluster_fluence(cluster, x, blur2) * std::exp(-tau);
    if (cluster.is_leaf()) return out;
    // As much as the nearest light might bring if it held all the power.
    const float far = std::max(glm::length(cluster.centre - x), 1e-15f);
    const float near = std::max(0.0f, std::sqrt(distance2(cluster.bounds, x)) - radius);
    const float most = cluster.power * inv_4pi / std::max(sqr(near), std::max(blur2, 1e-30f)) *
                       std::exp(-tau * std::min(1.0f, near / far));
    const float size = 0.5f * glm::length(cluster.bounds.extent());
    const float spread = size / std::max(near, 1e-15f) + tau * size / far;
    out.error = most * std::min(1.0f, sqr(spread));
    return out;
}

}  // namespace

void choose_light_cut(const LightClusters& clusters, const CoarseExtinction& extinction, Vec3 x,
                      float radius, int most, std::vector<int>& cut)
{
    cut.clear();
    if (clusters.nodes.empty()) return;
    std::vector<Candidate> candidates;
    candidates.reserve(static_cast<size_t>(most));
    float total = 0.0f;
    const auto weigh_node = [&](int node) {
        const Candidate candidate =
            weigh(clusters.nodes[static_cast<size_t>(node)], extinction, x, radius);
        total += candidate.fluence;
        return candidate;
    };
    cut.push_back(0);
    candidates.push_back(weigh_node(0));
    while (static_cast<int>(cut.size()) < most) {
        size_t worst = 0;
        for (size_t i = 1; i < candidates.size(); ++i)
            if (candidates[i].error > candidates[worst].error) worst = i;
        if (!(candidates[worst].error > tolerance * std::max(total, 0.0f))) break;
        total -= candidates[worst].fluence;
        const int left = cut[worst] + 1;
        const int right = clusters.nodes[static_cast<size_t>(cut[worst])].right;
        cut[worst] = left;
        candidates[worst] = weigh_node(left);
        cut.push_back(right);
        candidates.push_back(weigh_node(right));
    }
    std::sort(cut.begin(), cut.end());  // parents precede children: the lights' order
}

}  // namespace mote
