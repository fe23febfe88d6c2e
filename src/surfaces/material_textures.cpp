#include "surfaces/material_textures.h"

namespace mote {

Material material_at(const Material& material, const MaterialTextures& textures, Vec2 uv)
{
    Material out = material;
    if (textures.color) {
        const Spectrum color = material.base_color * Spectrum(textures.color->at(uv));
        out.base_color = glm::min(color, Spectrum(1.0f));  // pictures of floats know no limit
    }
    if (textures.roughness) {
        out.roughness = std::min(1.0f, material.roughness * textures.roughness->at(uv).y);
    }
    if (textures.metallic) {
        out.metallic = std::min(1.0f, material.metallic * textures.metallic->at(uv).z);
    }
    if (textures.emission) out.emission *= Spectrum(textures.emission->at(uv));
    return out;
}

bool is_present(const MaterialTextures& textures, Vec2 uv)
{
    if (!textures.is_cut()) return true;
    const float opacity = textures.color ? textures.color->at(uv).w : 1.0f;
    return textures.opacity * opacity >= textures.alpha_cutoff;
}

Spectrum textured_emission(const Spectrum& emission, const MaterialTextures& textures, Vec2 uv)
{
    if (!is_present(textures, uv)) return Spectrum(0.0f);
    return textures.emission ? emission * Spectrum(textures.emission->at(uv)) : emission;
}

}  // namespace mote
