#pragma once

#include "surfaces/material.h"

namespace mote {

/// A point on a surface, with all that shading needs. Directions wo and wi point away from it.
struct SurfaceVertex {
    Vec3 p{0.0f};               ///< world [m]
    Vec3 ng{0.0f, 0.0f, 1.0f};  ///< geometric normal of the front [unit, world]
    Vec3 ns{0.0f, 0.0f, 1.0f};  ///< shading normal, on the same side as ng [unit, world]
    float offset = 0.0f;        ///< rays that start this far along +-ng clear the surface [m]
    Material material;          ///< evaluated here
    int object = -1;            ///< into Surfaces::objects
    int triangle = -1;          ///< of the object's mesh
};

/// Where a ray that leaves the vertex along `direction` starts: `p`, moved along the geometric
/// normal by the bound of all rounding errors, so that it neither meets its own triangle nor skips
/// anything beyond.
[[nodiscard]] inline Vec3 ray_origin(const SurfaceVertex& v, Vec3 direction)
{
    return v.p + (glm::dot(v.ng, direction) < 0.0f ? -v.offset : v.offset) * v.ng;
}

}  // namespace mote
