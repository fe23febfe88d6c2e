#pragma once

#include "core/math.h"

namespace mote {

enum class MaterialKind {
    Diffuse,            ///< Lambert
    MetallicRoughness,  ///< glTF's: GGX over a diffuse base, or metal
    Dielectric,         ///< rough glass: GGX reflection and refraction
};

/// What a surface is made of, at one point of it.
struct Material {
    MaterialKind kind = MaterialKind::Diffuse;
    Spectrum base_color{0.8f};  ///< diffuse albedo, metal reflectance or tint of refraction, [0,1]
    float metallic = 0.0f;      ///< [0,1]; MetallicRoughness
    float roughness = 0.5f;     ///< [0,1]; GGX alpha is its square, but at least min_alpha
    float ior = 1.5f;           ///< inside over outside, >= 1; Dielectric
    Spectrum emission{0.0f};    ///< radiance that the surface gives off [W/(m^2 sr)]
    bool two_sided = true;      ///< else the back is black; dielectrics have both sides anyway

    bool operator==(const Material&) const = default;
    [[nodiscard]] bool is_emissive() const { return max_component(emission) > 0.0f; }
};

/// GGX lobes are never narrower: a mirror is a lobe of 0.1 degrees, so that every material has a
/// density that light sampling can be weighed against.
inline constexpr float min_alpha = 1e-3f;

}  // namespace mote
