#include <gtest/gtest.h>

#include "core/sampling.h"
#include "support/chi_squared.h"
#include "support/trials.h"
#include "surfaces/bsdf.h"

namespace mote {
namespace {

struct Case {
    const char* name;
    Material material;
    bool from_inside = false;  ///< wo on the back
};

Material make(MaterialKind kind, float roughness, float metallic = 0.0f,
              Spectrum color = Spectrum(1.0f))
{
    Material material;
    material.kind = kind;
    material.roughness = roughness;
    material.metallic = metallic;
    material.base_color = color;
    return material;
}

std::vector<Case> cases()
{
    const Spectrum gold(1.0f, 0.75f, 0.3f);
    return {
        {"diffuse", make(MaterialKind::Diffuse, 0.5f)},
        {"diffuse, back", make(MaterialKind::Diffuse, 0.5f), true},
        {"plastic", make(MaterialKind::MetallicRoughness, 0.35f)},
        {"rough plastic", make(MaterialKind::MetallicRoughness, 1.0f)},
        {"metal", make(MaterialKind::MetallicRoughness, 0.4f, 1.0f, gold)},
        {"rough metal", make(MaterialKind::MetallicRoughness, 1.0f, 1.0f)},
        {"half metal", make(MaterialKind::MetallicRoughness, 0.6f, 0.5f, gold)},
        {"glass", make(MaterialKind::Dielectric, 0.4f)},
        {"rough glass", make(MaterialKind::Dielectric, 0.8f)},
        {"glass from inside", make(MaterialKind::Dielectric, 0.4f), true},
        {"rough glass from inside", make(MaterialKind::Dielectric, 0.9f), true},
    };
}

/// A vertex in no special direction.
SurfaceVertex vertex_of(const Material& material, float tilt = 0.0f)
{
    SurfaceVertex v;
    v.ng = glm::normalize(Vec3(0.3f, -0.5f, 0.7f));
    v.ns = glm::normalize(v.ng + tilt * Vec3(1.0f, 0.2f, 0.0f));
    v.material = material;
    return v;
}

Vec3 wo_at(const SurfaceVertex& v, float cosine, bool from_inside)
{
    const float sine = std::sqrt(1.0f - sqr(cosine));
    const float z = from_inside ? -cosine : cosine;
    return make_frame(v.ng) * Vec3(sine * std::cos(0.8f), sine * std::sin(0.8f), z);
}

constexpr float cosines[] = {0.95f, 0.5f, 0.15f};
constexpr int rows = 32;
constexpr int columns = 64;

/// Cell of a direction in equal-area bins around the normal.
size_t cell_of(const Mat3& frame, Vec3 w)
{
    const Vec3 d = w * frame;
    const float v = 0.5f * (1.0f - d.z);
    const float u = std::atan2(d.y, d.x) / (2.0f * pi) + 0.5f;
    const auto clamped = [](float x, int n) {
        return static_cast<size_t>(
            std::clamp(static_cast<int>(x * static_cast<float>(n)), 0, n - 1));
    };
    return clamped(v, rows) * columns + clamped(u, columns);
}

/// Calls f(direction, solid angle, cell) for sub x sub points of every cell.
template <class F>
void for_each_direction(const Mat3& frame, int sub, F&& f)
{
    const int n_rows = rows * sub;
    const int n_columns = columns * sub;
    const float solid_angle = 4.0f * pi / static_cast<float>(n_rows * n_columns);
    for (int j = 0; j < n_rows; ++j) {
        const float z = 1.0f - 2.0f * (static_cast<float>(j) + 0.5f) / static_cast<float>(n_rows);
        const float r = std::sqrt(1.0f - sqr(z));
        for (int i = 0; i < n_columns; ++i) {
            const float phi =
                2.0f * pi * ((static_cast<float>(i) + 0.5f) / static_cast<float>(n_columns) - 0.5f);
            const Vec3 d(r * std::cos(phi), r * std::sin(phi), z);
            f(frame * d, solid_angle, static_cast<size_t>(j / sub * columns + i / sub));
        }
    }
}

/// Chi-squared z of samples against `pdf_scale` times bsdf_pdf, samples that are empty included.
double sampling_z(const SurfaceVertex& v, Vec3 wo, uint32_t count, float pdf_scale = 1.0f)
{
    const Mat3 frame = make_frame(v.ng);
    std::vector<double> observed(rows * columns + 1, 0.0);
    std::vector<double> expected(rows * columns + 1, 0.0);
    for (uint32_t i = 0; i < count; ++i) {
        Rng rng(7, 0, Stream::Test, i, 0);
        const auto sample = sample_bsdf(v, wo, rng.uniform3());
        observed[sample ? cell_of(frame, sample->wi) : rows * columns] += 1.0;
    }
    double sum = 0.0;
    for_each_direction(frame, 8, [&](Vec3 wi, float solid_angle, size_t cell) {
        const double p = static_cast<double>(pdf_scale * bsdf_pdf(v, wo, wi) * solid_angle);
        expected[cell] += p * count;
        sum += p;
    });
    expected.back() = std::max(0.0, 1.0 - sum) * count;
    return test::chi_squared_z(observed, expected);
}

TEST(BsdfStat, SamplesFollowTheirDensity)
{
    // |z| > 5 has probability 6e-7 per case; 66 cases. Densities are summed over 64 points per
    // cell: too coarse for lobes narrower than those here.
    for (const Case& c : cases()) {
        for (const float cosine : cosines) {
            for (const float tilt : {0.0f, 0.3f}) {
                const SurfaceVertex v = vertex_of(c.material, tilt);
                const Vec3 wo = wo_at(v, cosine, c.from_inside);
                // What falls through the geometric horizon of a tilted vertex is drawn and worth
                // nothing; it counts as empty.
                EXPECT_LT(std::abs(sampling_z(v, wo, 20'000)), 5.0)
                    << c.name << " " << cosine << " " << tilt;
            }
        }
    }
}

TEST(BsdfStat, ADensityThatIsOffByATenthIsRejected)
{
    // Negative control.
    const SurfaceVertex v = vertex_of(make(MaterialKind::MetallicRoughness, 0.6f));
    EXPECT_GT(std::abs(sampling_z(v, wo_at(v, 0.5f, false), 20'000, 0.9f)), 5.0);
}

/// Reflected and refracted share of light from everywhere, by quadrature. Radiance beyond a
/// refracting surface is eta^2 times that outside (from inside: the inverse), so that it counts
/// as 1.
double quadrature_albedo(const SurfaceVertex& v, Vec3 wo, float eta2)
{
    double sum = 0.0;
    for_each_direction(make_frame(v.ng), 16, [&](Vec3 wi, float solid_angle, size_t) {
        const bool refracts = glm::dot(v.ng, wi) * glm::dot(v.ng, wo) < 0.0f;
        sum += static_cast<double>(eval_bsdf(v, wo, wi).x * shading_cosine(v, wo, wi) *
                                   solid_angle * (refracts ? eta2 : 1.0f));
    });
    return sum;
}

TEST(Bsdf, NoMoreLightLeavesThanComesIn)
{
    // White furnace. Quadrature errors are below 0.5 % for these roughnesses. Single reflection
    // off GGX facets loses up to 70 %: at alpha 1 half of them reflect straight light downwards.
    for (const Case& c : cases()) {
        const float ior2 = sqr(c.material.ior);
        for (const float cosine : cosines) {
            const SurfaceVertex v = vertex_of(c.material);
            const Vec3 wo = wo_at(v, cosine, c.from_inside);
            const double albedo = quadrature_albedo(v, wo, c.from_inside ? 1.0f / ior2 : ior2);
            EXPECT_LT(albedo, 1.005) << c.name << " " << cosine;
            EXPECT_GT(albedo, c.material.roughness > 0.7f ? 0.3 : 0.7) << c.name << " " << cosine;
            if (c.material.kind == MaterialKind::Diffuse) {
                EXPECT_NEAR(albedo, 1.0, 0.005);
            }
        }
    }
}

TEST(BsdfStat, SampledAlbedoAgreesWithQuadrature)
{
    // E[f cos / pdf] against the integral; 5 standard errors and 0.5 % of quadrature error.
    for (const Case& c : cases()) {
        for (const float cosine : cosines) {
            const SurfaceVertex v = vertex_of(c.material);
            const Vec3 wo = wo_at(v, cosine, c.from_inside);
            const RunningStats stats = test::run_trials(10'000, 8, [&](Rng& rng) {
                const auto sample = sample_bsdf(v, wo, rng.uniform3());
                if (!sample) return 0.0f;
                EXPECT_EQ(sample->value.f, eval_bsdf(v, wo, sample->wi));
                EXPECT_EQ(sample->value.pdf_dir, bsdf_pdf(v, wo, sample->wi));
                return sample->value.f.x * sample->value.cosine / sample->value.pdf_dir;
            });
            const double exact = quadrature_albedo(v, wo, 1.0f);
            EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 0.005 * exact)
                << c.name << " " << cosine;
        }
    }
}

TEST(Bsdf, Reciprocal)
{
    for (const Case& c : cases()) {
        const SurfaceVertex v = vertex_of(c.material);
        const float ior2 = sqr(c.material.ior);
        int seen = 0;
        for (uint32_t i = 0; i < 2000; ++i) {
            Rng rng(9, 0, Stream::Test, i, 0);
            const Vec3 a = sample_sphere(rng.uniform2());
            const auto drawn = sample_bsdf(v, a, rng.uniform3());
            if (!drawn) continue;
            const Vec3 b = drawn->wi;
            if (std::abs(glm::dot(v.ng, a)) < 0.02f || std::abs(glm::dot(v.ng, b)) < 0.02f)
                continue;
            // eta^2 on a's side and on b's, for refraction.
            const float eta2_a = glm::dot(v.ng, a) > 0.0f ? 1.0f : ior2;
            const float eta2_b = glm::dot(v.ng, b) > 0.0f ? 1.0f : ior2;
            const float forth = eval_bsdf(v, a, b).y * eta2_b;
            const float back = eval_bsdf(v, b, a).y * eta2_a;
            EXPECT_NEAR(forth, back, 2e-3f * std::abs(back) + 1e-6f) << c.name;
            ++seen;
        }
        EXPECT_GT(seen, 500) << c.name;
    }
}

TEST(Bsdf, MirrorsAndClearGlassFollowTheirLaws)
{
    // At the narrowest lobe: angle of reflection, Snell's angle, Fresnel's share.
    const float cos_o = 0.6f;
    const float sin_o = 0.8f;
    SurfaceVertex v;
    const Vec3 wo(sin_o, 0.0f, cos_o);
    v.material = make(MaterialKind::MetallicRoughness, 0.0f, 1.0f);
    for (uint32_t i = 0; i < 500; ++i) {
        Rng rng(10, 0, Stream::Test, i, 0);
        const auto sample = sample_bsdf(v, wo, rng.uniform3());
        ASSERT_TRUE(sample);
        EXPECT_LT(glm::length(sample->wi - Vec3(-sin_o, 0.0f, cos_o)), 0.3f);
        EXPECT_NEAR(sample->value.f.x * sample->wi.z / sample->value.pdf_dir, 1.0f, 0.02f);
    }
    v.material = make(MaterialKind::Dielectric, 0.0f);
    const float sin_i = sin_o / 1.5f;
    const double reflectance = [&] {
        const double a = 0.6, b = std::sqrt(1.0 - 0.64 / 2.25);
        const double s = (a - 1.5 * b) / (a + 1.5 * b), p = (1.5 * a - b) / (1.5 * a + b);
        return 0.5 * (s * s + p * p);
    }();
    int reflected = 0;
    const int count = 20'000;
    double off = 0.0;
    for (int i = 0; i < count; ++i) {
        Rng rng(11, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        const auto sample = sample_bsdf(v, wo, rng.uniform3());
        ASSERT_TRUE(sample);
        if (sample->wi.z > 0.0f) {
            ++reflected;
        } else {
            const Vec3 snell(-sin_i, 0.0f, -std::sqrt(1.0f - sqr(sin_i)));
            off += static_cast<double>(glm::length(sample->wi - snell));
        }
    }
    EXPECT_LT(off / count, 0.002);
    // 5 standard errors.
    EXPECT_NEAR(reflected / static_cast<double>(count), reflectance,
                5.0 * std::sqrt(reflectance / count));
}

TEST(Bsdf, OneSidedAndShadingNormals)
{
    Material material = make(MaterialKind::Diffuse, 0.5f);
    material.emission = Spectrum(2.0f);
    material.two_sided = false;
    const SurfaceVertex v = vertex_of(material);
    const Vec3 front = wo_at(v, 0.5f, false);
    const Vec3 back = wo_at(v, 0.5f, true);
    EXPECT_GT(eval_bsdf(v, front, v.ng).x, 0.0f);
    EXPECT_EQ(eval_bsdf(v, back, -v.ng).x, 0.0f);
    EXPECT_FALSE(sample_bsdf(v, back, Vec3(0.5f)));
    EXPECT_EQ(surface_emission(v, front).x, 2.0f);
    EXPECT_EQ(surface_emission(v, back).x, 0.0f);
    // Shading normals let no light through.
    for (const Case& c : cases()) {
        if (c.material.kind == MaterialKind::Dielectric) continue;
        const SurfaceVertex tilted = vertex_of(c.material, 1.0f);
        for (uint32_t i = 0; i < 500; ++i) {
            Rng rng(12, 0, Stream::Test, i, 0);
            const Vec3 wo = sample_sphere(rng.uniform2());
            const Vec3 wi = sample_sphere(rng.uniform2());
            const Spectrum f = eval_bsdf(tilted, wo, wi);
            EXPECT_TRUE(is_finite(f) && f.x >= 0.0f);
            if (glm::dot(tilted.ng, wo) * glm::dot(tilted.ng, wi) < 0.0f) {
                EXPECT_EQ(f.x, 0.0f);
            }
            const auto sample = sample_bsdf(tilted, wo, rng.uniform3());
            if (!sample) continue;
            EXPECT_GT(glm::dot(tilted.ng, wo) * glm::dot(tilted.ng, sample->wi), 0.0f);
        }
    }
}

}  // namespace
}  // namespace mote
