#pragma once

#include <cstddef>

#include "core/math.h"

namespace mote {

/// Cubes of one size that fill a box of world space. x is the fastest index.
struct Lattice {
    Vec3 lo{0.0f};
    float cell = 1.0f;  ///< edge [m]
    Vec3i count{0};

    [[nodiscard]] size_t size() const
    {
        return static_cast<size_t>(count.x) * static_cast<size_t>(count.y) *
               static_cast<size_t>(count.z);
    }
    [[nodiscard]] size_t index(Vec3i c) const
    {
        return (static_cast<size_t>(c.z) * static_cast<size_t>(count.y) +
                static_cast<size_t>(c.y)) *
                   static_cast<size_t>(count.x) +
               static_cast<size_t>(c.x);
    }
    [[nodiscard]] Vec3i coordinates(size_t i) const
    {
        const auto nx = static_cast<size_t>(count.x);
        const auto ny = static_cast<size_t>(count.y);
        return {static_cast<int>(i % nx), static_cast<int>(i / nx % ny),
                static_cast<int>(i / (nx * ny))};
    }
    [[nodiscard]] Vec3 centre(Vec3i c) const { return lo + cell * (Vec3(c) + 0.5f); }
    /// World point -> lattice units, in which cell c covers [c, c + 1).
    [[nodiscard]] Vec3 to_lattice(Vec3 x) const { return (x - lo) * (1.0f / cell); }
    /// Whether a point in lattice units lies in a cell; false for NaN.
    [[nodiscard]] bool contains(Vec3 p) const
    {
        return p.x >= 0.0f && p.y >= 0.0f && p.z >= 0.0f && p.x < static_cast<float>(count.x) &&
               p.y < static_cast<float>(count.y) && p.z < static_cast<float>(count.z);
    }
};

}  // namespace mote
