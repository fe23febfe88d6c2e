#pragma once

#include <vector>

#include "core/math.h"
#include "core/rng.h"

namespace mote {

/// Squared distance [m^2] from x at which a light at one point gives what lights spread over a box
/// give on average: to the box's centre, but no less than what holds at the centre of a cube, where
/// the mean of 1/d^2 is about 6 over the squared half diagonal.
[[nodiscard]] double effective_distance2(const Bounds3& bounds, Vec3 x);

/// Binary tree over lights that chooses one at a point by walking down, at each node in proportion
/// to power over squared distance. Cost: O(log lights). The probability of any light is
/// reproducible, as MIS needs. After Conty Estevez and Kulla 2018, without orientation bounds.
class LightTree {
  public:
    struct Item {
        int id = -1;
        Bounds3 bounds;
        float power = 0.0f;  ///< > 0 [W]
    };

    LightTree() = default;
    explicit LightTree(std::vector<Item> items);

    struct Choice {
        int id = -1;
        float pmf = 0.0f;
    };
    /// Chooses a light for point x. Asserts that the tree is not empty.
    [[nodiscard]] Choice sample(Vec3 x, Rng& rng) const;

    /// Probability of `sample` choosing the item of this id at x; 0 for unknown ids.
    [[nodiscard]] float pmf(int id, Vec3 x) const;

    /// Power over squared distance of everything together [W/m^2].
    [[nodiscard]] double importance(Vec3 x) const;

    [[nodiscard]] bool is_empty() const { return nodes_.empty(); }

  private:
    struct Node {
        Bounds3 bounds;
        float power = 0.0f;
        int parent = -1;
        int right = -1;  ///< the left child follows its parent
        int id = -1;     ///< leaves only
    };
    int build(std::vector<Item>& items, size_t begin, size_t end, int parent);
    [[nodiscard]] double left_probability(const Node& node, size_t index, Vec3 x) const;

    std::vector<Node> nodes_;
    std::vector<int> leaf_of_id_;
};

}  // namespace mote
