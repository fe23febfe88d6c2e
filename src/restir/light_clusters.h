#pragma once

#include <span>
#include <vector>

#include "restir/local_light.h"

namespace mote {

/// Lights close together, as one: a range of LightClusters::ids.
struct alignas(64) LightCluster {
    Vec3 centre{0.0f};     ///< of power [m]
    float power = 0.0f;    ///< [W]
    Vec3 facing{0.0f};     ///< power-weighted mean of the lights' normals, length in [0,1]
    float spread2 = 0.0f;  ///< power-weighted mean squared distance from `centre` [m^2]
    int begin = 0;
    int end = 0;
    int right = -1;  ///< right child; the left one follows its parent; -1: not divided

    [[nodiscard]] bool is_leaf() const { return right < 0; }
};

/// Binary tree of clusters over lights in an order in which neighbours are near each other. Any
/// set of clusters that covers all lights once is a row of consecutive ranges of that order.
struct LightClusters {
    std::vector<LightCluster> nodes;  ///< [0] is the root; empty without lights
    std::vector<Bounds3> bounds;      ///< of the positions of each node's lights
    std::vector<int> ids;             ///< of the lights, in order
    std::vector<int> place_of_id;     ///< position in `ids`; -1: no such light
    /// Sums of the lights' shares of power in order; ids.size() + 1 entries from 0 to about 1. A
    /// share is never below 1e-6 / light count, so that every step shows in a double.
    std::vector<double> share_sum;

    [[nodiscard]] int light_count() const { return static_cast<int>(ids.size()); }
    /// Position of a light in the order; -1 for ids that are not there.
    [[nodiscard]] int place(int id) const
    {
        const auto i = static_cast<size_t>(id);
        return id >= 0 && i < place_of_id.size() ? place_of_id[i] : -1;
    }
};

/// Halves the lights at the median of the longest axis, down to single lights, or to groups where
/// there are more than 16384. Cost: O(n log n), 0.3 s for a million lights.
[[nodiscard]] LightClusters make_light_clusters(std::span<const LocalLight> lights);

}  // namespace mote
