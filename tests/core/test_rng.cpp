#include <gtest/gtest.h>

#include "core/rng.h"
#include "core/sampling.h"
#include "support/trials.h"

namespace mote {
namespace {

TEST(Rng, IsAPureFunctionOfItsKeyAndCounter)
{
    Rng a(1, 2, Stream::Path, 3, 4);
    Rng b(1, 2, Stream::Path, 3, 4);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next(), b.next());
    Rng other(1, 2, Stream::Camera, 3, 4);
    EXPECT_NE(Rng(1, 2, Stream::Path, 3, 4).next(), other.next());
}

TEST(Rng, UniformStaysBelowOne)
{
    EXPECT_EQ(to_unit_float(0u), 0.0f);
    EXPECT_EQ(to_unit_float(0xffffffffu), 1.0f - 0x1p-24f);
    EXPECT_TRUE(std::isfinite(sample_exponential(to_unit_float(0xffffffffu))));
}

TEST(RngStat, NeighbouringStreamsAreUncorrelated)
{
    // Product of the first numbers of neighbouring items, samples and seeds: mean 1/4.
    // 5 standard errors: fails falsely once in 600,000 seeds for the three together.
    for (int axis = 0; axis < 3; ++axis) {
        RunningStats stats;
        for (uint32_t i = 0; i < 200'000; ++i) {
            Rng a(7, 0, Stream::Test, i, 0);
            Rng b(axis == 2 ? 8 : 7, 0, Stream::Test, axis == 0 ? i + 1 : i, axis == 1 ? 1 : 0);
            stats.add(static_cast<double>(a.uniform()) * static_cast<double>(b.uniform()));
        }
        EXPECT_LT(std::abs(stats.mean - 0.25), 5.0 * stats.standard_error()) << axis;
    }
}

TEST(RngStat, UniformHasTheRightMoments)
{
    const RunningStats stats =
        test::run_trials(400'000, 11, [](Rng& rng) { return rng.uniform(); });
    EXPECT_LT(std::abs(stats.mean - 0.5), 5.0 * stats.standard_error());
    EXPECT_NEAR(stats.variance(), 1.0 / 12.0, 5.0 * std::sqrt(1.0 / 180.0 / 400'000.0));
}

TEST(SamplingStat, ExponentialAndSphereHaveTheirMeans)
{
    const RunningStats exponential =
        test::run_trials(200'000, 5, [](Rng& rng) { return sample_exponential(rng.uniform()); });
    EXPECT_LT(std::abs(exponential.mean - 1.0), 5.0 * exponential.standard_error());
    const RunningStats z =
        test::run_trials(200'000, 6, [](Rng& rng) { return sample_sphere(rng.uniform2()).z; });
    EXPECT_LT(std::abs(z.mean), 5.0 * z.standard_error());
}

}  // namespace
}  // namespace mote
