#include "scene/triangle_emission.h"

namespace mote {
namespace {

/// Texels that an edge spans in a picture, the longer way.
float texels_along(const Texture* picture, Vec2 edge)
{
    if (!picture) return 0.0f;
    return std::max(std::abs(edge.x) * static_cast<float>(picture->width()),
                    std::abs(edge.y) * static_cast<float>(picture->height()));
}

/// Texels that the longest edge of a triangle spans in the pictures that decide its emission.
float texel_span(const TriangleEmission& emission)
{
    const MaterialTextures& textures = *emission.textures;
    const Texture* cut = textures.is_cut() ? textures.color.get() : nullptr;
    float span = 0.0f;
    for (const Texture* picture : {textures.emission.get(), cut}) {
        for (const Vec2& edge : {emission.uv_along_u, emission.uv_along_v,
                                 emission.uv_along_v - emission.uv_along_u}) {
            span = std::max(span, texels_along(picture, edge));
        }
    }
    return span;
}

}  // namespace

Spectrum mean_emission(const TriangleEmission& emission, int max_steps, Spectrum floor)
{
    const float span = 4.0f * texel_span(emission);
    const bool is_coarse = !(span <= static_cast<float>(max_steps));
    const int steps = is_coarse ? max_steps : std::max(1, static_cast<int>(std::ceil(span)));
    const float size = 1.0f / static_cast<float>(steps);
    glm::dvec3 sum(0.0);
    // Centres of the steps^2 small triangles that the triangle is made of.
    for (int j = 0; j < steps; ++j) {
        for (int i = 0; i + j < steps; ++i) {
            const Vec2 corner(static_cast<float>(i), static_cast<float>(j));
            sum += glm::dvec3(emission.at(size * (corner + Vec2(1.0f / 3.0f))));
            if (i + j + 1 < steps) {
                sum += glm::dvec3(emission.at(size * (corner + Vec2(2.0f / 3.0f))));
            }
        }
    }
    const Spectrum mean(sum / (static_cast<double>(steps) * steps));
    return is_coarse ? mean + 1e-3f * floor : mean;
}

}  // namespace mote
