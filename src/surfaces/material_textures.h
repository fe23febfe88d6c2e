#pragma once

#include <memory>

#include "surfaces/material.h"
#include "surfaces/texture.h"

namespace mote {

/// Pictures that change a material from point to point; null: none. Channels are glTF's, so that
/// one picture may serve for several, and a grey one for any.
struct MaterialTextures {
    std::shared_ptr<const Texture> color;      ///< RGB multiplies base_color; A is the opacity
    std::shared_ptr<const Texture> roughness;  ///< G multiplies roughness
    std::shared_ptr<const Texture> metallic;   ///< B multiplies metallic
    std::shared_ptr<const Texture> normal;     ///< RGB - 1/2: along u, along v, outwards
    std::shared_ptr<const Texture> emission;   ///< RGB multiplies emission
    float normal_strength = 1.0f;              ///< multiplies the normal's slopes
    float opacity = 1.0f;                      ///< multiplies that of `color`
    float alpha_cutoff = 0.0f;  ///< [0,1]: where opacity is below, there is no surface

    [[nodiscard]] bool is_cut() const { return alpha_cutoff > 0.0f; }
    [[nodiscard]] bool has_pictures() const
    {
        return color || roughness || metallic || normal || emission;
    }
    bool operator==(const MaterialTextures&) const = default;
};

/// The material at texture coordinates uv.
[[nodiscard]] Material material_at(const Material& material, const MaterialTextures& textures,
                                   Vec2 uv);

/// Whether the surface is there at uv.
[[nodiscard]] bool is_present(const MaterialTextures& textures, Vec2 uv);

/// Radiance given off at uv; 0 where the surface is cut out.
[[nodiscard]] Spectrum textured_emission(const Spectrum& emission, const MaterialTextures& textures,
                                         Vec2 uv);

}  // namespace mote
