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
    Vec3 n{0.0f};        ///< its geometric normal [unit, either side]
    Spectrum Le{0.0f};   ///< emitted towards the camera, by the surface and by lamps before it
};

/// What there is to look at: surfaces (null: none), and lamps that rays meet, with their index.
struct Seeable {
    const Surfaces* surfaces = nullptr;
    std::span<const Light> lights;
    const LampSurfaces& lamps;  ///< of `lights`
};

/// `near`: what a ray beside it sees, which may spare some work; null: unknown. Cost: a ray, and a
/// shading point where it meets an emissive surface.
[[nodiscard]] SeenLook look_along(const Seeable& scene, const Ray& ray,
                                  const SeenLook* near = nullptr);

/// Whether both see about the same: one smooth surface of one brightness, or both none.
[[nodiscard]] bool looks_alike(const SeenLook& a, const SeenLook& b);

}  // namespace mote
