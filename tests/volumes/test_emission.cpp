#include <gtest/gtest.h>

#include "support/trials.h"
#include "volumes.h"
#include "volumes/blackbody.h"

namespace mote {
namespace {

using test::bricks_of;
using test::bumpy;
using test::run_trials;
using test::unit_cube;

using test::everything;

TEST(Blackbody, ChromaticitiesAreThePlanckianLocus)
{
    // CIE 1931 2 degree chromaticities of black bodies (CIE 15 and standard tables). The matching
    // functions are a fit good to 0.003.
    const struct {
        float T, x, y;
    } known[] = {{2000.0f, 0.5267f, 0.4133f},
                 {2856.0f, 0.4476f, 0.4074f},
                 {4000.0f, 0.3805f, 0.3768f},
                 {6500.0f, 0.3135f, 0.3237f},
                 {10000.0f, 0.2807f, 0.2884f}};
    for (const auto& k : known) {
        const Spectrum c = blackbody_rgb(k.T);
        const float X = 0.4124564f * c.x + 0.3575761f * c.y + 0.1804375f * c.z;
        const float Y = 0.2126729f * c.x + 0.7151522f * c.y + 0.0721750f * c.z;
        const float Z = 0.0193339f * c.x + 0.1191920f * c.y + 0.9503041f * c.z;
        EXPECT_NEAR(X / (X + Y + Z), k.x, 0.004f) << k.T;
        EXPECT_NEAR(Y / (X + Y + Z), k.y, 0.004f) << k.T;
    }
}

TEST(Blackbody, LuminanceIsOneComponentsAreNotNegativeAndTheTableIsClose)
{
    for (float T = 100.0f; T < 1e6f; T *= 1.013f) {
        const Spectrum c = blackbody_rgb(T);
        EXPECT_NEAR(luminance(c), 1.0f, 1e-5f);
        EXPECT_GE(std::min({c.x, c.y, c.z}), 0.0f);
        const Spectrum exact = blackbody_rgb_exact(static_cast<double>(T));
        EXPECT_LT(glm::length(c - exact), 2e-3f * glm::length(exact)) << T;
    }
    for (const float T : {0.0f, -5.0f, std::numeric_limits<float>::quiet_NaN(), infinity}) {
        EXPECT_TRUE(is_finite(blackbody_rgb(T)));
    }
}

/// Emission grid and hot density on different lattices, moved and turned.
Volume fire()
{
    Volume volume;
    volume.density = bricks_of({64, 64, 64}, unit_cube(), bumpy);
    volume.density_scale = 3.0f;
    volume.temperature =
        bricks_of({20, 20, 20}, {Mat3(20.0f), Vec3(0.3f, 0.0f, -0.2f)},
                  [](Vec3i p) { return static_cast<float>(p.x * 100 + p.y * 20); });
    volume.emission = bricks_of({30, 30, 30}, {Mat3(30.0f), Vec3(1.5f, 2.0f, 0.0f)}, [](Vec3i p) {
        return p.y > 12 ? 0.0f : 0.1f * static_cast<float>(p.z % 7);
    });
    volume.emission_params.emission_scale = 2.0f;
    volume.emission_params.emission_color = {1.0f, 0.5f, 0.1f};
    volume.emission_params.blackbody_scale = 0.7f;
    volume.emission_params.temperature_offset = 300.0f;
    volume.world_from_object = test::tilted();
    finalize(volume);
    return volume;
}

Vec3 object_point(const Volume& volume, Vec3 p_world)
{
    return Vec3(glm::inverse(matrix(volume.world_from_object.at(0.0f))) *
                glm::dvec4(Vec3d(p_world), 1.0));
}

TEST(Emission, FollowsItsDefinition)
{
    const Volume volume = fire();
    const Vec3 p(0.4f, 0.35f, 0.6f);
    const float T = temperature_at(volume, p);
    EXPECT_NEAR(T, 300.0f + 100.0f * 8.3f + 20.0f * 7.0f, 0.1f);
    const float E = sample_trilinear(*volume.emission, volume.emission->index_from_object.point(p));
    const Spectrum expected =
        2.0f * E * Spectrum(1.0f, 0.5f, 0.1f) +
        0.7f * sigma_t_at(volume, p) * std::pow(T / 1500.0f, 4.0f) * blackbody_rgb(T);
    EXPECT_LT(glm::length(emission_at(volume, p) - expected), 1e-4f * glm::length(expected));
    EXPECT_EQ(emission_at(volume, Vec3(50.0f)), Spectrum(0.0f));
    Volume cold = volume;
    cold.emission_params = {};
    EXPECT_EQ(emission_at(cold, p), Spectrum(0.0f));
}

TEST(EmissionStat, RayIntegralIsUnbiased)
{
    const Volume volume = fire();
    for (uint32_t i = 0; i < 4; ++i) {
        const Ray ray = test::test_ray(world_bounds(volume), i);
        double exact = 0.0;
        constexpr int steps = 40'000;
        constexpr double length = 8.0;
        for (int k = 0; k < steps; ++k) {
            const float t = static_cast<float>(length * (k + 0.5) / steps);
            exact += static_cast<double>(
                luminance(emission_at(volume, object_point(volume, ray.at(t)))));
        }
        exact *= length / steps;
        const RunningStats stats = run_trials(40'000, 5 + i, [&](Rng& rng) {
            return luminance(estimate_emission(volume, ray, everything, rng));
        });
        // 5 standard errors: false alarm once in 1.7 million seeds; the march is good to 1e-4.
        EXPECT_NEAR(stats.mean, exact, 5.0 * stats.standard_error() + 2e-4 * exact + 1e-6);
    }
}

TEST(EmissionStat, EmissionUpToTheFreeFlightIsTheTransmittedIntegral)
{
    // A box of constant density 1 and constant emission: L = j / sigma (1 - exp(-tau)).
    const auto box = bricks_of({64, 64, 64}, unit_cube(), [](Vec3i) { return 1.0f; });
    Volume volume = test::volume_of(box, 4.0f);
    volume.emission = box;
    volume.emission_params.emission_scale = 3.0f;
    finalize(volume);
    const Media media{{volume}};
    const Ray ray{{-1.0f, 0.5f, 0.5f}, {1.0f, 0.0f, 0.0f}};
    const double exact = 3.0 / 4.0 * (1.0 - std::exp(-4.0));
    const RunningStats stats = run_trials(100'000, 9, [&](Rng& rng) {
        const auto hit = sample_free_flight(media, ray, everything, rng);
        return estimate_emission(volume, ray, {0.0f, hit ? hit->t : infinity}, rng).x;
    });
    EXPECT_NEAR(stats.mean, exact, 5.0 * stats.standard_error());
}

TEST(EmissionStat, PointSamplesIntegrateTheVolumesPower)
{
    const Volume volume = fire();
    const EmissiveBricks bricks = make_emissive_bricks(volume);
    ASSERT_FALSE(bricks.empty());
    EXPECT_EQ(bricks.cdf.back(), 1.0f);
    // Exact power: both terms on their own lattices' fine midpoints would differ by their kinks;
    // uniform points of the common bounding box are the reference, with their own standard error.
    const Bounds3 box = world_bounds(volume);
    const Vec3 size = box.extent();
    const double box_volume =
        static_cast<double>(size.x) * static_cast<double>(size.y) * static_cast<double>(size.z);
    const RunningStats uniform = run_trials(400'000, 71, [&](Rng& rng) {
        const Vec3 p = box.lo + size * rng.uniform3();
        return luminance(emission_at(volume, object_point(volume, p)));
    });
    const RunningStats picked = run_trials(100'000, 72, [&](Rng& rng) {
        const EmissionSample sample = sample_emission(volume, bricks, 0.0f, rng);
        EXPECT_GT(sample.pdf_volume, 0.0f);
        EXPECT_NEAR(emission_pdf(volume, bricks, 0.0f, object_point(volume, sample.p)),
                    sample.pdf_volume, 1e-3f * sample.pdf_volume + 50.0f);
        return sample.pdf_volume > 0.0f ? luminance(sample.j) / sample.pdf_volume : 0.0f;
    });
    const double exact = uniform.mean * box_volume;
    const double error = std::hypot(uniform.standard_error() * box_volume, picked.standard_error());
    EXPECT_LT(std::abs(picked.mean - exact), 5.0 * error);
    EXPECT_LT(picked.standard_error(), 0.5 * uniform.standard_error() * box_volume);
    EXPECT_NEAR(
        bricks.total_power * 4.0 / 4.0,
        exact * 4.0 * 3.14159265 /
            std::abs(glm::determinant(glm::dmat3(matrix(volume.world_from_object.at(0.0f))))),
        0.05 * bricks.total_power);
}

TEST(Emission, EveryEmittingPointCanBePickedAndMajorantsHold)
{
    const Volume volume = fire();
    const EmissiveBricks bricks = make_emissive_bricks(volume);
    Volume parts[2] = {volume, volume};
    parts[0].emission_params.emission_scale = 0.0f;
    parts[1].emission_params.blackbody_scale = 0.0f;
    Rng rng(5, 0, Stream::Test, 0, 0);
    for (const EmissiveBricks::Brick& brick : bricks.bricks) {
        const BrickGrid& grid = *bricks.parts[brick.part].grid;
        const Affine& m = grid.index_from_object;
        const Mat3 object_from_index = glm::inverse(m.linear);
        for (int i = 0; i < 40; ++i) {
            const Vec3 index = Vec3(grid.lo) + 8.0f * (Vec3(brick.position) + rng.uniform3());
            const Vec3 p = object_from_index * (index - m.offset);
            const float j = luminance(emission_at(parts[brick.part], p));
            EXPECT_LE(j, brick.majorant * 1.0001f + 1e-6f);
        }
    }
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 p = rng.uniform3() * 1.2f - Vec3(0.1f);
        if (luminance(emission_at(volume, p)) > 1e-6f) {
            EXPECT_GT(emission_pdf(volume, bricks, 0.0f, p), 0.0f);
        }
    }
}

TEST(Emission, DarkVolumesHaveNoEmissiveBricks)
{
    Volume volume = fire();
    volume.emission_params = {};
    EXPECT_TRUE(make_emissive_bricks(volume).empty());
}

}  // namespace
}  // namespace mote
