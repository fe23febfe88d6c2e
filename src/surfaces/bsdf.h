#pragma once

#include <optional>

#include "surfaces/surface_vertex.h"

namespace mote {

/// The BSDF for a pair of directions, with all that an estimator needs beside it.
struct BsdfValue {
    Spectrum f{0.0f};      ///< eval_bsdf [1/sr]
    float pdf_dir = 0.0f;  ///< bsdf_pdf [1/sr]
    float cosine = 0.0f;   ///< shading_cosine
};

/// A scattered direction.
struct BsdfSample {
    Vec3 wi{0.0f};    ///< [unit]
    BsdfValue value;  ///< of it; pdf_dir > 0
};

/// The BSDF [1/sr], without the cosine: radiance towards wo per irradiance from wi. Reciprocal, but
/// for refraction, where f(wo, wi) eta_o^2 = f(wi, wo) eta_i^2. Geometric normals decide between
/// reflection and refraction, so that shading normals leak no light; where wo does not see the
/// shading normal the geometric one takes its place. 0 at the back of one-sided materials. What
/// GGX reflects twice between its facets is lost (rough metals are a little dark).
[[nodiscard]] Spectrum eval_bsdf(const SurfaceVertex& v, Vec3 wo, Vec3 wi);

/// Draws wi about in proportion to f times cosine. u in [0,1)^3. Empty if nothing is scattered.
[[nodiscard]] std::optional<BsdfSample> sample_bsdf(const SurfaceVertex& v, Vec3 wo, Vec3 u);

/// Density [1/sr] with which sample_bsdf draws wi.
[[nodiscard]] float bsdf_pdf(const SurfaceVertex& v, Vec3 wo, Vec3 wi);

/// All three at once.
[[nodiscard]] BsdfValue eval_bsdf_and_pdf(const SurfaceVertex& v, Vec3 wo, Vec3 wi);

/// |cosine| between wi and the normal that eval_bsdf shades by.
[[nodiscard]] float shading_cosine(const SurfaceVertex& v, Vec3 wo, Vec3 wi);

/// Radiance that the surface gives off towards wo.
[[nodiscard]] inline Spectrum surface_emission(const SurfaceVertex& v, Vec3 wo)
{
    const bool is_lit = v.material.two_sided || glm::dot(v.ng, wo) > 0.0f;
    return is_lit ? v.material.emission : Spectrum(0.0f);
}

/// Share of light that is scattered, as a colour for the albedo layer: base colour; 1 for glass.
[[nodiscard]] Spectrum surface_albedo(const SurfaceVertex& v);

}  // namespace mote
