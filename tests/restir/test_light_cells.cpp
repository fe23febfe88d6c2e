#include <gtest/gtest.h>

#include <set>

#include "restir/light_cells_scene.h"
#include "support/chi_squared.h"

namespace mote {
namespace {

using test::test_eye;

TEST(LightCells, ProbabilitiesSumToOneInsideAndOutsideTheSmoke)
{
    // Tolerance: float rounding of a thousand probabilities.
    const Media media = test::clumpy_media();
    for (const int count : {1, 2, 50, 1000}) {
        const std::vector<Light> lamps = test::mixed_lamps(count);
        const LightCells cells(media, local_lights(lamps), test_eye);
        for (uint32_t k = 0; k < 60; ++k)
            EXPECT_NEAR(test::pmf_sum(cells, count, test::some_point(k)), 1.0, 2e-5) << count;
    }
}

TEST(LightCells, SampleReturnsTheProbabilityThatPmfTells)
{
    const std::vector<Light> lamps = test::mixed_lamps(1000);
    const LightCells cells(test::clumpy_media(), local_lights(lamps), test_eye);
    Rng rng(4, 0, Stream::Test, 0, 0);
    for (uint32_t k = 0; k < 3000; ++k) {
        const Vec3 x = test::some_point(k);
        const LightPick pick = cells.sample(x, static_cast<double>(rng.uniform()));
        ASSERT_GE(pick.light, 0);
        EXPECT_GT(pick.pmf, 0.0f);
        EXPECT_EQ(pick.pmf, cells.pmf(pick.light, x));
    }
}

TEST(LightCells, ManyAtOnceAreThoseOneByOne)
{
    Rng rng(6, 0, Stream::Test, 0, 0);
    for (const int count : {0, 1, 2, 30, 40000}) {
        const LightCells cells(test::clumpy_media(), test::random_lights(count), test_eye);
        for (uint32_t k = 0; k < 20; ++k) {
            const Vec3 x = k == 0 ? Vec3(5.0f) : test::some_point(k);
            double u[37];
            LightPick picks[37];
            for (double& v : u) v = static_cast<double>(rng.uniform());
            cells.sample(x, u, picks);
            for (int i = 0; i < 37; ++i) {
                EXPECT_EQ(picks[i].light, cells.sample(x, u[i]).light);
                EXPECT_EQ(picks[i].pmf, cells.sample(x, u[i]).pmf);
            }
        }
    }
}

/// Z of 100,000 samples at x against the probabilities, those of `told` if given.
double sampling_z(const LightCells& cells, int count, Vec3 x, const LightCells& told)
{
    const int trials = 100'000;
    std::vector<double> observed(static_cast<size_t>(count));
    std::vector<double> expected;
    Rng rng(5, 0, Stream::Test, 0, 0);
    for (int i = 0; i < trials; ++i)
        ++observed[static_cast<size_t>(cells.sample(x, static_cast<double>(rng.uniform())).light)];
    for (int i = 0; i < count; ++i)
        expected.push_back(trials * static_cast<double>(told.pmf(i, x)));
    return test::chi_squared_z(observed, expected);
}

TEST(LightCellsStat, SamplesFollowTheirProbabilities)
{
    // |z| > 5 once in 1.7 million seeds per case.
    const Media media = test::clumpy_media();
    for (const int count : {2, 50, 1000}) {
        const LightCells cells(media, test::random_lights(count), test_eye);
        for (const Vec3& x : {Vec3(0.1f, 0.2f, -0.1f), Vec3(-0.4f, 0.3f, 0.2f), Vec3(5.0f)})
            EXPECT_LT(sampling_z(cells, count, x, cells), 5.0) << count;
    }
}

TEST(LightCellsStat, TheTestNoticesProbabilitiesOfAnotherCamera)
{
    // Negative control: only the phase function differs.
    const Media media = test::clumpy_media();
    const std::vector<LocalLight> lights = test::random_lights(1000);
    const LightCells cells(media, lights, test_eye);
    const LightCells other(media, lights, Vec3(6.0f, 0.0f, 0.0f));
    EXPECT_GT(sampling_z(cells, 1000, Vec3(0.1f, 0.2f, -0.1f), other), 20.0);
}

TEST(LightCells, ChoicesAreMonotoneInTheRandomNumber)
{
    // Each light is chosen on one interval of u, as long as its probability: no light comes back
    // once left, and neighbours in the order are near each other.
    const LightCells cells(test::clumpy_media(), test::random_lights(200), test_eye);
    const Vec3 x(0.2f, 0.1f, 0.0f);
    std::set<int> left;
    int current = -1;
    double length = 0.0;
    const int steps = 200'000;
    for (int i = 0; i < steps; ++i) {
        const int light = cells.sample(x, (i + 0.5) / steps).light;
        if (light != current) {
            if (current >= 0) {
                EXPECT_NEAR(length, static_cast<double>(cells.pmf(current, x)), 1.1 / steps);
                EXPECT_TRUE(left.insert(current).second);
            }
            current = light;
            length = 0.0;
        }
        length += 1.0 / steps;
    }
}

TEST(LightCells, LightsWithoutPowerAndDistantLightsAreNeverChosen)
{
    const std::vector<Light> lamps = test::mixed_lamps(300);
    const LightCells cells(test::clumpy_media(), local_lights(lamps), test_eye);
    for (int i = 0; i < 300; ++i) {
        const bool is_distant = std::holds_alternative<DistantLight>(lamps[static_cast<size_t>(i)]);
        for (uint32_t k = 0; k < 10; ++k) {
            const float pmf = cells.pmf(i, test::some_point(k));
            if (i % 7 == 3 || is_distant) {
                EXPECT_EQ(pmf, 0.0f);
            } else {
                EXPECT_GT(pmf, 0.0f);
            }
        }
    }
}

TEST(LightCells, AnyContentKeepsFullSupport)
{
    // Whatever the cache holds, every light stays possible and probabilities stay exact.
    const int count = 500;
    LightCells cells(test::clumpy_media(), test::random_lights(count), test_eye);
    const std::function<float(size_t)> contents[] = {
        [](size_t) { return 0.0f; },
        [](size_t) { return 1e30f; },
        [](size_t i) { return i % 37 == 0 ? 1e20f : 0.0f; },
        [](size_t i) { return std::ldexp(1.0f, static_cast<int>(i * 7919 % 240) - 120); },
    };
    for (const auto& content : contents) {
        cells.overwrite(content, test_eye);
        for (uint32_t k = 0; k < 30; ++k) {
            const Vec3 x = test::some_point(k);
            EXPECT_NEAR(test::pmf_sum(cells, count, x), 1.0, 2e-5);
            for (int i = 0; i < count; ++i) EXPECT_GT(cells.pmf(i, x), 0.0f);
            EXPECT_GT(cells.inscatter(x), 0.0f);
            EXPECT_TRUE(std::isfinite(cells.inscatter(x)));
        }
        EXPECT_LT(sampling_z(cells, count, Vec3(0.1f, 0.2f, -0.1f), cells), 5.0);
    }
}

TEST(LightCells, VeryUnequalPowersKeepFullSupport)
{
    std::vector<LocalLight> lights = test::random_lights(300);
    for (size_t i = 0; i < lights.size(); ++i)
        lights[i].power = std::ldexp(1.0f, static_cast<int>(i) % 200 - 100);
    const LightCells cells(test::clumpy_media(), lights, test_eye);
    for (uint32_t k = 0; k < 30; ++k) {
        const Vec3 x = test::some_point(k);
        EXPECT_NEAR(test::pmf_sum(cells, 300, x), 1.0, 2e-5);
        for (int i = 0; i < 300; ++i) EXPECT_GT(cells.pmf(i, x), 0.0f);
    }
}

TEST(LightCells, HostilePointsGiveDefinedResults)
{
    const LightCells cells(test::clumpy_media(), test::random_lights(100), test_eye);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Vec3& x :
         {Vec3(nan), Vec3(infinity), Vec3(-infinity), Vec3(1e30f), Vec3(0.0f, nan, 0.0f)}) {
        const LightPick pick = cells.sample(x, 0.7);
        EXPECT_GE(pick.light, 0);
        EXPECT_GT(pick.pmf, 0.0f);
        EXPECT_GT(cells.inscatter(x), 0.0f);
    }
    for (const double u : {0.0, 1.0 - 0x1p-53}) {
        const LightPick pick = cells.sample(Vec3(0.0f), u);
        EXPECT_EQ(pick.pmf, cells.pmf(pick.light, Vec3(0.0f)));
    }
    EXPECT_EQ(cells.pmf(-1, Vec3(0.0f)), 0.0f);
    EXPECT_EQ(cells.pmf(100, Vec3(0.0f)), 0.0f);
}

}  // namespace
}  // namespace mote
