#pragma once

#include <span>

#include "scene/lamp_surfaces.h"
#include "scene/scene.h"

namespace mote {

/// What a camera ray sees behind all media, as far as it tells pixels with edges from others.
struct SeenLook {
    int object = -1;     ///< -1: no surface
    int triangle = -1;   ///< of the object's mesh
    float t = infinity;  ///< distance of the surface [m]
    Vec3 p{0.0f};        ///< point on it [m]
    Vec3 n{0.0f};        ///< its normal [unit, either side]: of glossy surfaces the shading normal
    float like_normals = 0.9f;  ///< cosine between normals above which its reflections are alike
    Spectrum Le{0.0f};          ///< emitted towards the camera by the surface
};

/// `near`: what a ray beside it sees, which may spare some work; null: unknown. Cost: a ray, and a
/// shading point where it meets an emissive surface.
[[nodiscard]] SeenLook look_along(const Surfaces& surfaces, const Ray& ray,
                                  const SeenLook* near = nullptr);

/// Whether both see about the same: one smooth surface of one brightness, or both none.
[[nodiscard]] bool looks_alike(const SeenLook& a, const SeenLook& b);

/// What the lamps that a ray meets give off towards its origin. `index`: of `lamps`.
[[nodiscard]] Spectrum lamp_light(std::span<const Light> lamps, const LampSurfaces& index,
                                  const Ray& ray);

/// Whether two emissions are about the same.
[[nodiscard]] bool emits_alike(Spectrum a, Spectrum b);

}  // namespace mote
