#pragma once

#include "core/math.h"

/// GGX microfacets around the z axis; directions are unit and point away from the surface.
namespace mote {

/// Density of microfacet normals [1/sr], h.z > 0. Walter et al. 2007. Written by the sine, which
/// does not cancel where lobes are narrow.
[[nodiscard]] inline float ggx_density(Vec3 h, float alpha)
{
    const float alpha2 = sqr(alpha);
    const float sin2 = sqr(h.x) + sqr(h.y);
    return alpha2 / (pi * sqr(sin2 + alpha2 * sqr(h.z)));
}

/// Smith's Lambda: microfacet area hidden per area seen from w.
[[nodiscard]] inline float ggx_lambda(Vec3 w, float alpha)
{
    const float sin2 = sqr(w.x) + sqr(w.y);
    const float cos2 = sqr(w.z);
    if (!(cos2 > 0.0f)) return infinity;
    return 0.5f * (std::sqrt(1.0f + sqr(alpha) * sin2 / cos2) - 1.0f);
}

/// Share of microfacets that both directions see, with heights correlated. Heitz 2014.
[[nodiscard]] inline float ggx_visible(Vec3 wo, Vec3 wi, float alpha)
{
    return 1.0f / (1.0f + ggx_lambda(wo, alpha) + ggx_lambda(wi, alpha));
}

/// Density [1/sr] of sample_ggx_normal: of the normals that wo sees. Precondition: wo.z > 0.
[[nodiscard]] inline float ggx_normal_pdf(Vec3 wo, Vec3 h, float alpha)
{
    return ggx_density(h, alpha) * std::max(0.0f, glm::dot(wo, h)) /
           ((1.0f + ggx_lambda(wo, alpha)) * wo.z);
}

/// A microfacet normal out of those that wo sees. u in [0,1)^2. Precondition: wo.z > 0.
/// Source: Dupuy and Benyoub 2023, spherical caps.
[[nodiscard]] inline Vec3 sample_ggx_normal(Vec3 wo, float alpha, Vec2 u)
{
    const Vec3 w = glm::normalize(Vec3(alpha * wo.x, alpha * wo.y, wo.z));
    const float phi = 2.0f * pi * u.x;
    const float z = (1.0f - u.y) * (1.0f + w.z) - w.z;
    const float r = std::sqrt(std::clamp(1.0f - sqr(z), 0.0f, 1.0f));
    const Vec3 h = Vec3(r * std::cos(phi), r * std::sin(phi), z) + w;
    return glm::normalize(Vec3(alpha * h.x, alpha * h.y, std::max(0.0f, h.z)));
}

/// Fresnel reflectance by Schlick 1994; f0 straight on.
[[nodiscard]] inline Spectrum fresnel_schlick(Spectrum f0, float cosine)
{
    const float m = std::clamp(1.0f - cosine, 0.0f, 1.0f);
    return f0 + (Spectrum(1.0f) - f0) * (sqr(sqr(m)) * m);
}

/// Fresnel reflectance of a dielectric for unpolarised light; cosine > 0 on the side of incidence,
/// eta: index beyond over index here. 1 for total reflection.
[[nodiscard]] inline float fresnel_dielectric(float cosine, float eta)
{
    const float sin2_beyond = (1.0f - sqr(cosine)) / sqr(eta);
    if (sin2_beyond >= 1.0f) return 1.0f;
    const float beyond = std::sqrt(1.0f - sin2_beyond);
    const float parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
    const float perpendicular = (cosine - eta * beyond) / (cosine + eta * beyond);
    return 0.5f * (sqr(parallel) + sqr(perpendicular));
}

}  // namespace mote
