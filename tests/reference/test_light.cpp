#include <gtest/gtest.h>

#include "core/sampling.h"
#include "scene/light.h"
#include "support/chi_squared.h"
#include "support/trials.h"

namespace mote {
namespace {

std::vector<Light> area_lights()
{
    return {
        SphereLight{Vec3(0.3f, 1.0f, -0.2f), 0.5f, Spectrum(2.0f)},
        SphereLight{Vec3(0.0f, 0.0f, 30.0f), 0.01f, Spectrum(5.0f)},
        QuadLight{Vec3(-1.0f, 2.0f, -1.0f), Vec3(0.0f, 0.3f, 2.0f), Vec3(1.5f, 0.0f, 0.0f),
                  Spectrum(1.0f), true},
        QuadLight{Vec3(0.1f, -0.2f, 0.4f), Vec3(0.0f, 0.3f, 0.0f), Vec3(0.2f, 0.1f, 0.05f),
                  Spectrum(1.0f), true},
    };
}

/// Direction bins: 24 x 48 in cosine and azimuth around the axis towards `centre`, the cosine
/// stretched so that small lights fill the bins.
struct DirectionBins {
    Mat3 frame;
    float max_one_minus_cos;
    static constexpr int rows = 12;
    static constexpr int columns = 24;

    [[nodiscard]] size_t bin(Vec3 wi) const
    {
        const Vec3 d = wi * frame;
        const float sin2 = d.x * d.x + d.y * d.y;
        const float one_minus_cos = d.z > 0.0f ? sin2 / (1.0f + d.z) : 1.0f - d.z;
        const int row =
            std::min(static_cast<int>(one_minus_cos / max_one_minus_cos * rows), rows - 1);
        const float phi = std::atan2(d.y, d.x) / (2.0f * pi) + 0.5f;
        const int column = std::min(static_cast<int>(phi * columns), columns - 1);
        return static_cast<size_t>(row * columns + column);
    }
    [[nodiscard]] Vec3 direction(float row, float column) const
    {
        const float one_minus_cos = row / rows * max_one_minus_cos;
        const float sin_theta = std::sqrt(one_minus_cos * (2.0f - one_minus_cos));
        const float phi = 2.0f * pi * (column / columns - 0.5f);
        return frame *
               Vec3(sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1.0f - one_minus_cos);
    }
};

double light_chi_squared(const Light& light, float pdf_scale_on_one_side)
{
    const Vec3 x(0.2f, 0.1f, 0.05f);
    const Bounds3 box = light_bounds(light);
    const Vec3 to_centre = box.centre() - x;
    const float distance = glm::length(to_centre);
    const float sin_max = std::min(1.0f, 0.51f * glm::length(box.extent()) / distance);
    DirectionBins bins{make_frame(to_centre / distance), 2.0f};
    if (sin_max < 0.9f) bins.max_one_minus_cos = 1.0f - std::sqrt(1.0f - sin_max * sin_max);
    const int trials = 100'000;
    std::vector<double> observed(DirectionBins::rows * DirectionBins::columns);
    std::vector<double> expected(observed.size());
    Rng rng(1, 0, Stream::Test, 0, 0);
    for (int i = 0; i < trials; ++i) {
        const auto sample = sample_light(light, x, rng.uniform2());
        if (sample) ++observed[bins.bin(sample->wi)];
    }
    const int sub = 48;
    const double cell = static_cast<double>(bins.max_one_minus_cos) / DirectionBins::rows * 2.0 *
                        std::numbers::pi / DirectionBins::columns / (sub * sub);
    for (int row = 0; row < DirectionBins::rows; ++row) {
        for (int column = 0; column < DirectionBins::columns; ++column) {
            double sum = 0.0;
            for (int i = 0; i < sub * sub; ++i) {
                const float r =
                    static_cast<float>(row) + (static_cast<float>(i / sub) + 0.5f) / sub;
                const float c =
                    static_cast<float>(column) + (static_cast<float>(i % sub) + 0.5f) / sub;
                sum += static_cast<double>(light_pdf(light, x, bins.direction(r, c)));
            }
            const double scale = column < DirectionBins::columns / 2
                                     ? static_cast<double>(pdf_scale_on_one_side)
                                     : 1.0;
            expected[static_cast<size_t>(row * DirectionBins::columns + column)] =
                sum * cell * trials * scale;
        }
    }
    return test::chi_squared_z(observed, expected);
}

TEST(LightStat, SamplesFollowTheirDensity)
{
    // |z| > 5 happens once in 1.7 million seeds per light.
    for (const Light& light : area_lights()) EXPECT_LT(light_chi_squared(light, 1.0f), 5.0);
}

TEST(LightStat, ADensityWrongOnOneSideIsRejected)
{
    EXPECT_GT(light_chi_squared(area_lights()[0], 1.06f), 5.0);
}

TEST(Light, SampleDensityDistanceAndHitAgree)
{
    for (const Light& light : area_lights()) {
        for (uint32_t i = 0; i < 2000; ++i) {
            Rng rng(2, 0, Stream::Test, i, 0);
            const Vec3 x = 3.0f * sample_sphere(rng.uniform2()) * rng.uniform();
            const auto sample = sample_light(light, x, rng.uniform2());
            if (!sample) continue;
            EXPECT_NEAR(glm::length(sample->wi), 1.0f, 1e-5f);
            const auto hit = hit_light(light, x, sample->wi);
            if (!hit) continue;  // float rounding at the rim
            EXPECT_NEAR(hit->distance, sample->distance, 2e-3f * (1.0f + sample->distance));
            EXPECT_NEAR(light_pdf(light, x, sample->wi) / sample->pdf_dir, 1.0f, 2e-2f);
            EXPECT_EQ(hit->Le, sample->Li);
        }
    }
}

TEST(LightStat, NextEventAndUniformDirectionsGiveTheSameFluence)
{
    // Fluence = integral of Le over directions; 5 standard errors fail once in 1.7 million seeds.
    const Vec3 x(0.2f, 0.1f, 0.05f);
    const Light lights[] = {area_lights()[0], area_lights()[2],
                            QuadLight{Vec3(-1.0f, 2.0f, -1.0f), Vec3(0.0f, 0.0f, -2.0f),
                                      Vec3(1.5f, 0.0f, 0.0f), Spectrum(1.0f), false}};
    for (const Light& light : lights) {
        const RunningStats by_light = test::run_trials(100'000, 3, [&](Rng& rng) {
            const auto sample = sample_light(light, x, rng.uniform2());
            return sample ? sample->Li.x / sample->pdf_dir : 0.0f;
        });
        const RunningStats by_direction = test::run_trials(400'000, 4, [&](Rng& rng) {
            const auto hit = hit_light(light, x, sample_sphere(rng.uniform2()));
            return hit ? hit->Le.x / sample_sphere_pdf() : 0.0f;
        });
        const double error = std::hypot(by_light.standard_error(), by_direction.standard_error());
        EXPECT_LT(std::abs(by_light.mean - by_direction.mean), 5.0 * error + 1e-6);
        EXPECT_GT(by_light.mean, 0.0);
    }
}

TEST(Light, PointLightFollowsTheInverseSquareLaw)
{
    const Light light = PointLight{Vec3(0.0f, 2.0f, 0.0f), Spectrum(8.0f, 4.0f, 2.0f)};
    const auto sample = sample_light(light, Vec3(0.0f), Vec2(0.5f));
    ASSERT_TRUE(sample);
    EXPECT_TRUE(sample->is_delta);
    EXPECT_FLOAT_EQ(sample->Li.x, 2.0f);
    EXPECT_FLOAT_EQ(sample->distance, 2.0f);
    EXPECT_FALSE(sample_light(light, Vec3(0.0f, 2.0f, 0.0f), Vec2(0.5f)));
}

/// Share of a spot's intensity at an angle from its axis: the definition, a smoothstep in the
/// cosine.
double falloff_at(double cosine, double inner, double outer)
{
    const double t = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

TEST(Light, SpotsFadeFromTheInnerToTheOuterCone)
{
    const Vec3 axis = glm::normalize(Vec3(1.0f, -2.0f, 0.5f));
    const SpotLight spot{Vec3(0.3f, 1.0f, -0.2f), axis, Spectrum(8.0f, 4.0f, 2.0f), 0.9f, 0.6f};
    const Mat3 frame = make_frame(axis);
    for (const float cosine : {1.0f, 0.95f, 0.89f, 0.75f, 0.61f, 0.59f, 0.0f, -1.0f}) {
        const float sine = std::sqrt(1.0f - cosine * cosine);
        const Vec3 d = frame * Vec3(0.6f * sine, 0.8f * sine, cosine);
        const auto sample = sample_light(spot, spot.position + 2.0f * d, Vec2(0.5f));
        const double exact = 2.0 * falloff_at(static_cast<double>(cosine), 0.9, 0.6);
        EXPECT_NEAR(sample ? sample->Li.x : 0.0f, exact, 2e-5) << cosine;
        if (!sample) continue;
        EXPECT_TRUE(sample->is_delta);
        EXPECT_NEAR(sample->distance, 2.0f, 1e-6f);
        EXPECT_LT(glm::length(sample->wi + d), 1e-6f);
    }
    EXPECT_FALSE(sample_light(spot, spot.position, Vec2(0.5f)));
    EXPECT_FALSE(hit_light(spot, Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f)));
    EXPECT_EQ(light_pdf(spot, Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f)), 0.0f);
    // Sharp edges are no division by zero.
    SpotLight sharp = spot;
    sharp.cos_inner = sharp.cos_outer;
    EXPECT_FLOAT_EQ(sample_light(sharp, sharp.position + axis, Vec2(0.5f))->Li.y, 4.0f);
}

TEST(Light, SpotPowerIsTheIntegralOfItsIntensity)
{
    for (const auto& [inner, outer] :
         {std::pair(0.9, 0.6), std::pair(0.999, 0.99), std::pair(0.2, -0.5), std::pair(0.5, 0.5)}) {
        double sum = 0.0;
        constexpr int steps = 200'000;
        for (int i = 0; i < steps; ++i) {
            const double cosine = -1.0 + 2.0 * (i + 0.5) / steps;
            sum += inner > outer ? falloff_at(cosine, inner, outer) : (cosine >= outer ? 1.0 : 0.0);
        }
        const double exact = 2.0 * std::numbers::pi * 3.0 * sum * 2.0 / steps;
        SpotLight spot;
        spot.intensity = Spectrum(3.0f);
        spot.cos_inner = static_cast<float>(inner);
        spot.cos_outer = static_cast<float>(outer);
        EXPECT_NEAR(light_power(spot, 1.0f), exact, 1e-4 * exact);
        EXPECT_FLOAT_EQ(brightest_power(spot, 1.0f), 12.0f * pi);
    }
    EXPECT_EQ(brightest_power(SphereLight{}, 1.0f), light_power(SphereLight{}, 1.0f));
}

TEST(Light, OneSidedQuadShinesWhereItsNormalPoints)
{
    // cross(u, v) = -y.
    const QuadLight down{Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f), Vec3(0.0f, 0.0f, 1.0f), Spectrum(1.0f),
                         false};
    const Vec3 below(0.5f, -1.0f, 0.5f);
    const Vec3 above(0.5f, 1.0f, 0.5f);
    EXPECT_TRUE(hit_light(down, below, Vec3(0.0f, 1.0f, 0.0f)));
    EXPECT_FALSE(hit_light(down, above, Vec3(0.0f, -1.0f, 0.0f)));
    EXPECT_TRUE(sample_light(down, below, Vec2(0.5f)));
    EXPECT_FALSE(sample_light(down, above, Vec2(0.5f)));
}

TEST(Light, SphereIsDarkFromInsideAndRobustAtItsSurface)
{
    const Light light = SphereLight{Vec3(0.0f), 1.0f, Spectrum(1.0f)};
    EXPECT_FALSE(sample_light(light, Vec3(0.5f, 0.0f, 0.0f), Vec2(0.5f)));
    EXPECT_FALSE(hit_light(light, Vec3(0.5f, 0.0f, 0.0f), Vec3(1.0f, 0.0f, 0.0f)));
    for (const float distance : {1.0f, std::nextafter(1.0f, 2.0f), 1.0001f, 1e4f, 1e8f, 1e18f}) {
        for (const Vec2& u : {Vec2(0.0f), Vec2(one_minus_epsilon), Vec2(0.5f)}) {
            const auto sample = sample_light(light, Vec3(distance, 0.0f, 0.0f), u);
            if (!sample) continue;
            EXPECT_TRUE(is_finite(sample->wi) && std::isfinite(sample->distance)) << distance;
            EXPECT_TRUE(std::isfinite(sample->pdf_dir) && sample->pdf_dir > 0.0f) << distance;
            EXPECT_GE(sample->distance, 0.0f);
        }
    }
}

TEST(Light, DegenerateAndBlackLightsAreHarmless)
{
    const Light lights[] = {
        QuadLight{Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f), Vec3(2.0f, 0.0f, 0.0f), Spectrum(1.0f), true},
        SphereLight{Vec3(0.0f), 0.0f, Spectrum(1.0f)}};
    for (const Light& light : lights) {
        EXPECT_EQ(light_power(light, 1.0f), 0.0f);
        EXPECT_FALSE(sample_light(light, Vec3(0.0f, 1.0f, 0.0f), Vec2(0.5f)));
        EXPECT_FALSE(hit_light(light, Vec3(0.0f, 1.0f, 0.0f), Vec3(0.0f, -1.0f, 0.0f)));
        EXPECT_EQ(light_pdf(light, Vec3(0.0f, 1.0f, 0.0f), Vec3(0.0f, -1.0f, 0.0f)), 0.0f);
    }
}

TEST(Light, PowerIsTheIntegralOfEmission)
{
    EXPECT_FLOAT_EQ(light_power(PointLight{Vec3(0.0f), Spectrum(1.0f)}, 1.0f), 4.0f * pi);
    EXPECT_FLOAT_EQ(light_power(SphereLight{Vec3(0.0f), 2.0f, Spectrum(1.0f)}, 1.0f),
                    16.0f * pi * pi);
    const QuadLight quad{Vec3(0.0f), Vec3(2.0f, 0.0f, 0.0f), Vec3(0.0f, 0.0f, 3.0f), Spectrum(1.0f),
                         true};
    EXPECT_FLOAT_EQ(light_power(quad, 1.0f), 12.0f * pi);
    EXPECT_FLOAT_EQ(light_power(DistantLight{Vec3(0.0f, 1.0f, 0.0f), Spectrum(2.0f)}, 3.0f),
                    18.0f * pi);
}

TEST(Light, NumbersAreThoseOfTheDirection)
{
    const Vec3 x(0.2f, 0.1f, 0.05f);
    for (const Light& light : area_lights()) {
        for (uint32_t i = 0; i < 200; ++i) {
            Rng rng(4, 0, Stream::Test, i, 0);
            const Vec2 u = rng.uniform2();
            const auto sample = sample_light(light, x, u);
            if (!sample || !hit_light(light, x, sample->wi)) continue;  // grazed by rounding
            const auto numbers = light_numbers(light, x, sample->wi);
            ASSERT_TRUE(numbers);
            // Directions are floats: a lamp of 1/3000 of a radian has some 3000 steps across.
            EXPECT_LT(std::abs(numbers->x - u.x), 2e-3f) << light.index();
            const float turn = std::abs(numbers->y - u.y);
            EXPECT_LT(std::min(turn, 1.0f - turn) * std::sqrt(u.x), 2e-3f) << light.index();
        }
        EXPECT_FALSE(light_numbers(light, x, Vec3(-0.6f, -0.8f, 0.0f)));
    }
    EXPECT_FALSE(light_numbers(PointLight{}, x, Vec3(0.0f, 1.0f, 0.0f)));
}

}  // namespace
}  // namespace mote
