#pragma once

#include <memory>

#include "scene/light.h"
#include "surfaces/mesh.h"
#include "surfaces/surfaces.h"

namespace mote {

/// What a triangle of a textured or cut emissive mesh gives off from point to point.
struct TriangleEmission {
    Spectrum emission{0.0f};                   ///< [W/(m^2 sr)], before the textures
    std::shared_ptr<const Surfaces> surfaces;  ///< keeps the textures
    const MaterialTextures* textures = nullptr;
    Vec2 uv{0.0f}, uv_along_u{0.0f}, uv_along_v{0.0f};  ///< at the corner, and along its edges

    /// Radiance at corner + u edge_u + v edge_v of the light.
    [[nodiscard]] Spectrum at(Vec2 place) const
    {
        return textured_emission(emission, *textures,
                                 uv + place.x * uv_along_u + place.y * uv_along_v);
    }
    [[nodiscard]] bool is_same(const TriangleEmission& other) const
    {
        return emission == other.emission && *textures == *other.textures && uv == other.uv &&
               uv_along_u == other.uv_along_u && uv_along_v == other.uv_along_v;
    }
};

/// Mean of `emission` over its triangle, for the power of the light, from places a quarter of a
/// texel apart, where the triangle spans at most max_steps / 4 texels either way. Beyond that it
/// takes max_steps^2 places and adds a thousandth of `floor`, so that no light that may shine is
/// never chosen. An approximation, which moves noise alone.
[[nodiscard]] Spectrum mean_emission(const TriangleEmission& emission, int max_steps,
                                     Spectrum floor);

}  // namespace mote
