#include "surfaces/bsdf.h"

#include "core/sampling.h"
#include "surfaces/ggx.h"

namespace mote {
namespace {

/// Shading frame around the normal on wo's side.
struct Local {
    Mat3 frame{1.0f};  ///< columns: tangents, normal
    Vec3 wo{0.0f};     ///< in the frame, z > 0
    bool is_front = true;
};

/// Empty where nothing is scattered: at grazing wo, and at the back of one-sided materials.
std::optional<Local> make_local(const SurfaceVertex& v, Vec3 wo)
{
    const float side = glm::dot(v.ng, wo);
    if (side == 0.0f) return std::nullopt;
    const bool is_front = side > 0.0f;
    const Material& material = v.material;
    if (!is_front && !material.two_sided && material.kind != MaterialKind::Dielectric) {
        return std::nullopt;
    }
    const float sign = is_front ? 1.0f : -1.0f;
    const Vec3 ns = sign * v.ns;
    Local local;
    local.frame = make_frame(glm::dot(ns, wo) > 0.0f ? ns : sign * v.ng);
    local.wo = wo * local.frame;  // by the transpose
    local.is_front = is_front;
    return local;
}

/// Whether wi leaves on wo's side.
bool is_reflection(const SurfaceVertex& v, Vec3 wo, Vec3 wi)
{
    return glm::dot(v.ng, wo) * glm::dot(v.ng, wi) > 0.0f;
}

float alpha_of(const Material& material)
{
    return std::max(min_alpha, sqr(material.roughness));
}

/// A value of the BSDF with the density of sampling it.
struct Lobe {
    Spectrum f{0.0f};
    float pdf = 0.0f;
};

/// GGX reflection without Fresnel factor, and the density of its sampling.
Lobe ggx_reflection(Vec3 wo, Vec3 wi, Vec3 h, float alpha)
{
    const float f = ggx_density(h, alpha) * ggx_visible(wo, wi, alpha) / (4.0f * wo.z * wi.z);
    return {Spectrum(f), ggx_normal_pdf(wo, h, alpha) / (4.0f * glm::dot(wo, h))};
}

/// glTF's metallic-roughness model. Departs from it in the diffuse part, which gets what neither
/// direction reflects: reciprocal like glTF's, but never more than comes in.
struct MetallicRoughness {
    Spectrum f0, diffuse;
    float alpha = 1.0f;
    float p_specular = 0.0f;  ///< share of samples

    MetallicRoughness(const Material& material, float cos_o)
    {
        f0 = glm::mix(Spectrum(0.04f), material.base_color, material.metallic);
        diffuse = (1.0f - material.metallic) * material.base_color;
        alpha = alpha_of(material);
        const float specular = luminance(fresnel_schlick(f0, cos_o));
        const float rest = luminance(diffuse) * (1.0f - specular);
        p_specular = specular + rest > 0.0f ? specular / (specular + rest) : 1.0f;
        // Never starve a lobe that may be bright where the light comes from.
        if (rest > 0.0f) p_specular = std::clamp(p_specular, 0.1f, 0.9f);
    }

    [[nodiscard]] Lobe eval(Vec3 wo, Vec3 wi) const
    {
        const Vec3 h = glm::normalize(wo + wi);
        Lobe lobe = ggx_reflection(wo, wi, h, alpha);
        lobe.f *= fresnel_schlick(f0, glm::dot(wo, h));
        const Spectrum passes = (Spectrum(1.0f) - fresnel_schlick(Spectrum(0.04f), wo.z)) *
                                (Spectrum(1.0f) - fresnel_schlick(Spectrum(0.04f), wi.z));
        lobe.f += inv_pi * diffuse * passes;
        lobe.pdf = p_specular * lobe.pdf + (1.0f - p_specular) * inv_pi * wi.z;
        return lobe;
    }
};

/// Rough glass. Source: Walter et al. 2007, with heights correlated.
struct Dielectric {
    float eta = 1.5f;  ///< index beyond over index on wo's side
    float alpha = 1.0f;
    Spectrum tint{1.0f};

    Dielectric(const Material& material, bool is_front)
        : eta(is_front ? material.ior : 1.0f / material.ior),
          alpha(alpha_of(material)),
          tint(material.base_color)
    {
    }

    [[nodiscard]] Lobe reflect(Vec3 wo, Vec3 wi) const
    {
        if (!(wi.z > 0.0f)) return {};
        const Vec3 h = glm::normalize(wo + wi);
        const float fresnel = fresnel_dielectric(glm::dot(wo, h), eta);
        Lobe lobe = ggx_reflection(wo, wi, h, alpha);
        return {fresnel * lobe.f, fresnel * lobe.pdf};
    }

    [[nodiscard]] Lobe refract(Vec3 wo, Vec3 wi) const
    {
        if (!(wi.z < 0.0f) || eta == 1.0f) return {};
        Vec3 h = glm::normalize(wo + eta * wi);
        if (h.z < 0.0f) h = -h;
        const float cos_o = glm::dot(wo, h);
        const float cos_i = glm::dot(wi, h);
        if (!(cos_o > 0.0f && cos_i < 0.0f)) return {};
        const float passes = 1.0f - fresnel_dielectric(cos_o, eta);
        // Solid angle of h per solid angle of wi.
        const float jacobian = -cos_i / sqr(cos_i + cos_o / eta);
        const float f = passes * ggx_density(h, alpha) * ggx_visible(wo, wi, alpha) * cos_o *
                        jacobian / (-wo.z * wi.z * sqr(eta));
        return {f * tint, passes * ggx_normal_pdf(wo, h, alpha) * jacobian};
    }
};

Lobe eval(const SurfaceVertex& v, const Local& local, Vec3 wo, Vec3 wi)
{
    const Vec3 wi_local = wi * local.frame;
    const bool reflects = is_reflection(v, wo, wi);
    if (v.material.kind == MaterialKind::Dielectric) {
        const Dielectric glass(v.material, local.is_front);
        return reflects ? glass.reflect(local.wo, wi_local) : glass.refract(local.wo, wi_local);
    }
    if (!reflects || !(wi_local.z > 0.0f)) return {};
    if (v.material.kind == MaterialKind::Diffuse) {
        return {inv_pi * v.material.base_color, inv_pi * wi_local.z};
    }
    return MetallicRoughness(v.material, local.wo.z).eval(local.wo, wi_local);
}

Vec3 sample_cosine(Vec2 u)
{
    const Vec2 d = sample_disk(u);
    // Not a number beyond the rounded rim: lost, as are flat directions.
    return {d.x, d.y, std::sqrt(1.0f - glm::dot(d, d))};
}

Vec3 mirror(Vec3 wo, Vec3 h)
{
    return 2.0f * glm::dot(wo, h) * h - wo;
}

/// A direction in the frame, and by which lobe.
struct Drawn {
    Vec3 wi{0.0f};
    bool is_reflected = true;
};

Drawn draw(const SurfaceVertex& v, const Local& local, Vec3 u)
{
    const Vec2 uv(u.x, u.y);
    if (v.material.kind == MaterialKind::Diffuse) return {sample_cosine(uv)};
    if (v.material.kind == MaterialKind::MetallicRoughness) {
        const MetallicRoughness model(v.material, local.wo.z);
        if (u.z >= model.p_specular) return {sample_cosine(uv)};
        return {mirror(local.wo, sample_ggx_normal(local.wo, model.alpha, uv))};
    }
    const Dielectric glass(v.material, local.is_front);
    const Vec3 h = sample_ggx_normal(local.wo, glass.alpha, uv);
    const float cos_o = glm::dot(local.wo, h);
    if (u.z < fresnel_dielectric(cos_o, glass.eta)) return {mirror(local.wo, h)};
    // Not a number, and lost, where rounding has it just beyond total reflection.
    const float cos_i = std::sqrt(1.0f - (1.0f - sqr(cos_o)) / sqr(glass.eta));
    return {-local.wo / glass.eta + (cos_o / glass.eta - cos_i) * h, false};
}

}  // namespace

BsdfValue eval_bsdf_and_pdf(const SurfaceVertex& v, Vec3 wo, Vec3 wi)
{
    const std::optional<Local> local = make_local(v, wo);
    if (!local) return {};
    const Lobe lobe = eval(v, *local, wo, wi);
    return {lobe.f, lobe.pdf, std::abs(glm::dot(local->frame[2], wi))};
}

Spectrum eval_bsdf(const SurfaceVertex& v, Vec3 wo, Vec3 wi)
{
    return eval_bsdf_and_pdf(v, wo, wi).f;
}

float bsdf_pdf(const SurfaceVertex& v, Vec3 wo, Vec3 wi)
{
    return eval_bsdf_and_pdf(v, wo, wi).pdf_dir;
}

float shading_cosine(const SurfaceVertex& v, Vec3 wo, Vec3 wi)
{
    return eval_bsdf_and_pdf(v, wo, wi).cosine;
}

std::optional<BsdfSample> sample_bsdf(const SurfaceVertex& v, Vec3 wo, Vec3 u)
{
    const std::optional<Local> local = make_local(v, wo);
    if (!local) return std::nullopt;
    const Drawn drawn = draw(v, *local, u);
    const Vec3 wi = glm::normalize(local->frame * drawn.wi);
    // Facets may throw light to the wrong side of the surface; there it is lost.
    if (is_reflection(v, wo, wi) != drawn.is_reflected) return std::nullopt;
    const Lobe lobe = eval(v, *local, wo, wi);
    if (!(lobe.pdf > 0.0f) || !std::isfinite(lobe.pdf)) return std::nullopt;
    return BsdfSample{wi, {lobe.f, lobe.pdf, std::abs(glm::dot(local->frame[2], wi))}};
}

Spectrum surface_albedo(const SurfaceVertex& v)
{
    return v.material.base_color;
}

}  // namespace mote
