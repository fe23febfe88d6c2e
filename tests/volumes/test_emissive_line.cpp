#include <gtest/gtest.h>

#include "support/trials.h"
#include "volumes.h"
#include "volumes/emissive_line.h"

namespace mote {
namespace {

using test::bricks_of;
using test::bumpy;
using test::run_trials;
using test::unit_cube;

/// Dense glowing smoke and a thin emission grid on another lattice.
Volume fire(float density_scale)
{
    Volume volume;
    volume.density = bricks_of({64, 64, 64}, unit_cube(), bumpy);
    volume.density_scale = density_scale;
    volume.temperature = bricks_of({20, 20, 20}, {Mat3(20.0f), Vec3(0.0f)},
                                   [](Vec3i p) { return static_cast<float>(p.x * 100); });
    volume.emission = bricks_of({30, 30, 30}, {Mat3(30.0f), Vec3(1.5f, 2.0f, 0.0f)}, [](Vec3i p) {
        return p.y > 12 ? 0.0f : 0.1f * static_cast<float>(p.z % 7);
    });
    volume.emission_params.emission_scale = 2.0f;
    volume.emission_params.blackbody_scale = 0.7f;
    volume.emission_params.temperature_offset = 300.0f;
    volume.world_from_object = test::tilted();
    finalize(volume);
    return volume;
}

Ray ray_into(const Volume& volume, Rng& rng)
{
    const Bounds3 box = world_bounds(volume);
    const Vec3 from = box.lo + box.extent() * rng.uniform3();
    const Vec3 to = box.lo + box.extent() * rng.uniform3();
    return {from, glm::normalize(to - from), 0.0f};
}

TEST(EmissiveLineStat, SamplesHaveTheirDensityAndItIsOne)
{
    // In each fifth of the ray: samples that fall into it against the integral of the density, 5
    // standard errors of the count; the density's own quadrature is good to 1 % of the whole.
    for (const float density_scale : {0.5f, 30.0f}) {
        const Volume volume = fire(density_scale);
        const EmissiveBricks bricks = make_emissive_bricks(volume);
        for (uint32_t trial = 0; trial < 12; ++trial) {
            Rng place(trial, 0, Stream::Test, 0, 0);
            const Ray ray = ray_into(volume, place);
            constexpr int parts = 5;
            constexpr int steps = 4000;
            const float reach = glm::length(world_bounds(volume).extent());
            double integral[parts] = {};
            for (int i = 0; i < steps; ++i) {
                const float t = (static_cast<float>(i) + 0.5f) * reach / steps;
                integral[i * parts / steps] +=
                    static_cast<double>(emissive_line_pdf(volume, bricks, ray, t) * reach / steps);
            }
            double whole = 0.0;
            for (const double part : integral) whole += part;
            if (whole == 0.0) continue;  // it sees nothing that glows
            EXPECT_NEAR(whole, 1.0, 0.01);
            constexpr uint32_t count = 4000;
            double found[parts] = {};
            for (uint32_t i = 0; i < count; ++i) {
                Rng rng(77, trial, Stream::Test, i, 0);
                const auto sample = sample_emissive_line(volume, bricks, ray, rng.uniform());
                ASSERT_TRUE(sample);
                ASSERT_GE(sample->t, 0.0f);
                EXPECT_EQ(sample->pdf, emissive_line_pdf(volume, bricks, ray, sample->t));
                const int part = static_cast<int>(sample->t / reach * parts);
                found[std::min(part, parts - 1)] += 1.0 / count;
            }
            for (int part = 0; part < parts; ++part) {
                const double sigma = std::sqrt(std::max(integral[part], 0.001) / count);
                EXPECT_NEAR(found[part], integral[part], 5.0 * sigma + 0.01);
            }
        }
    }
}

TEST(EmissiveLine, FollowsTheLightThatArrives)
{
    // Behind dense smoke less is picked than a uniform distance would: most samples come from
    // within a few mean free paths.
    const Volume volume = fire(60.0f);
    const EmissiveBricks bricks = make_emissive_bricks(volume);
    const Bounds3 box = world_bounds(volume);
    const Ray ray{box.lo + 0.5f * box.extent(), glm::normalize(Vec3(0.3f, 1.0f, 0.2f)), 0.0f};
    const RunningStats distance = run_trials(2000, 5, [&](Rng& rng) {
        const auto sample = sample_emissive_line(volume, bricks, ray, rng.uniform());
        return sample ? sample->t : 0.0f;
    });
    EXPECT_LT(distance.mean, 0.25 * static_cast<double>(glm::length(box.extent())));
}

TEST(EmissiveLine, ExtremeNumbersAndDarkRays)
{
    const Volume volume = fire(3.0f);
    const EmissiveBricks bricks = make_emissive_bricks(volume);
    const Bounds3 box = world_bounds(volume);
    const Ray away{box.hi + Vec3(1.0f), Vec3(1.0f, 0.0f, 0.0f), 0.0f};
    EXPECT_FALSE(sample_emissive_line(volume, bricks, away, 0.5f));
    EXPECT_EQ(emissive_line_pdf(volume, bricks, away, 0.5f), 0.0f);
    for (uint32_t trial = 0; trial < 200; ++trial) {
        Rng place(trial, 1, Stream::Test, 0, 0);
        const Ray ray = ray_into(volume, place);
        for (const float u : {0.0f, one_minus_epsilon}) {
            const auto sample = sample_emissive_line(volume, bricks, ray, u);
            if (!sample) continue;
            EXPECT_TRUE(std::isfinite(sample->t) && sample->pdf > 0.0f);
        }
    }
}

}  // namespace
}  // namespace mote
