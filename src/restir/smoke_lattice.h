#pragma once

#include <vector>

#include "volumes/tracking.h"

namespace mote {

/// A lattice of cubes along world axes over all media, of whose nodes only those near smoke are
/// active: a point with density always has eight active nodes around it. Values live in arrays of
/// active_count() + 1 slots; slot 0 stands for every node far from smoke.
struct SmokeLattice {
    /// The eight nodes around a point, x fastest, and their trilinear weights, which sum to 1.
    struct Corners {
        Vec3i first{0};  ///< lattice coordinates of node 0; node n adds the bits of n
        int32_t slot[8];
        float weight[8];

        [[nodiscard]] Vec3i node(int n) const { return first + Vec3i(n & 1, n >> 1 & 1, n >> 2); }
    };

    Vec3 origin{0.0f};  ///< of node (0,0,0) [m]
    float spacing = 1.0f;
    Vec3i count{2};                                      ///< nodes along x, y, z
    std::vector<int32_t> slots{0, 0, 0, 0, 0, 0, 0, 0};  ///< per node, x fastest
    std::vector<Vec3i> nodes{Vec3i(0)};                  ///< per slot; [0] means nothing

    [[nodiscard]] int32_t active_count() const { return static_cast<int32_t>(nodes.size()) - 1; }
    [[nodiscard]] Vec3 position(Vec3i node) const { return origin + spacing * Vec3(node); }
    [[nodiscard]] size_t index(Vec3i node) const
    {
        return (static_cast<size_t>(node.z) * static_cast<size_t>(count.y) +
                static_cast<size_t>(node.y)) *
                   static_cast<size_t>(count.x) +
               static_cast<size_t>(node.x);
    }
    [[nodiscard]] int64_t memory_bytes() const
    {
        return static_cast<int64_t>(slots.size() * sizeof(int32_t) + nodes.size() * sizeof(Vec3i));
    }

    /// x in world space; outside the lattice the nearest point of its border, not-a-number its
    /// first node.
    [[nodiscard]] Corners corners(Vec3 x) const
    {
        const Vec3 p = (x - origin) / spacing;
        Corners out;
        Vec3 f;
        for (int axis = 0; axis < 3; ++axis) {
            const float q = std::min(std::max(0.0f, p[axis]), static_cast<float>(count[axis] - 1));
            out.first[axis] = std::min(static_cast<int>(q), count[axis] - 2);
            f[axis] = q - static_cast<float>(out.first[axis]);
        }
        const int32_t* slot = slots.data() + index(out.first);
        const size_t line = static_cast<size_t>(count.x);
        const size_t plane = line * static_cast<size_t>(count.y);
        for (int n = 0; n < 8; ++n) {
            const bool bx = (n & 1) != 0;
            const bool by = (n & 2) != 0;
            const bool bz = (n & 4) != 0;
            out.slot[n] = slot[(bx ? 1 : 0) + (by ? line : 0) + (bz ? plane : 0)];
            out.weight[n] =
                (bx ? f.x : 1.0f - f.x) * (by ? f.y : 1.0f - f.y) * (bz ? f.z : 1.0f - f.z);
        }
        return out;
    }
};

/// Lattice with at most node_budget active nodes (and 64 times as many nodes in all): the spacing
/// grows from `spacing` [m] until it fits. Moving media count where they are at the start, in the
/// middle and at the end of the shutter. Without density: no active nodes.
[[nodiscard]] SmokeLattice make_smoke_lattice(const Media& media, float spacing, int node_budget);

}  // namespace mote
