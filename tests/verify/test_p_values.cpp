#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.h"
#include "verify/p_values.h"

namespace mote {

TEST(PValues, SidakOfTheMinimum)
{
    EXPECT_NEAR(sidak_p(0.05, 2), 0.0975, 1e-15);
    EXPECT_NEAR(sidak_p(1e-300, 1'000'000), 1e-294, 1e-306);  // no cancellation
    EXPECT_EQ(sidak_p(0.0, 10), 0.0);
    EXPECT_EQ(sidak_p(1.0, 10), 1.0);
}

TEST(PValues, HolmStepsDown)
{
    // By hand: sorted 0.005, 0.01, 0.03, 0.04 times 4, 3, 2, 1, then made monotone.
    const std::vector<double> p = {0.01, 0.04, 0.03, 0.005};
    const std::vector<double> adjusted = holm_adjusted(p);
    ASSERT_EQ(adjusted.size(), 4u);
    EXPECT_DOUBLE_EQ(adjusted[3], 0.02);
    EXPECT_DOUBLE_EQ(adjusted[0], 0.03);
    EXPECT_DOUBLE_EQ(adjusted[2], 0.06);
    EXPECT_DOUBLE_EQ(adjusted[1], 0.06);
    EXPECT_DOUBLE_EQ(holm_adjusted(std::vector<double>{0.9, 0.8})[0], 1.0);
    EXPECT_TRUE(holm_adjusted({}).empty());
}

TEST(PValues, KolmogorovDistributionIsExactForSmallSamples)
{
    // One number: the distance is max(x, 1 - x), so its distribution function is 2d - 1.
    EXPECT_NEAR(kolmogorov_cdf(1, 0.75), 0.5, 1e-14);
    // Marsaglia, Tsang and Wang 2003 print this one; the others by their method in rationals.
    EXPECT_NEAR(kolmogorov_cdf(10, 0.274), 0.62847961545650428, 1e-13);
    EXPECT_NEAR(kolmogorov_cdf(100, 0.1), 0.74730724299360987, 1e-12);
    // Critical values at 5 % of the published tables (Miller 1956), of five digits.
    EXPECT_NEAR(kolmogorov_cdf(5, 0.56328), 0.95, 1e-5);
    EXPECT_NEAR(kolmogorov_cdf(20, 0.29408), 0.95, 1e-5);
    EXPECT_EQ(kolmogorov_cdf(20, 1.0), 1.0);
    EXPECT_EQ(kolmogorov_cdf(20, 0.0), 0.0);
}

TEST(PValues, KolmogorovDistributionOfLargeSamplesIsWithinItsStatedError)
{
    EXPECT_NEAR(kolmogorov_cdf(150, 0.1), 0.90707879586173863, 2e-4);
    EXPECT_NEAR(kolmogorov_cdf(101, 0.134), 0.95169714327400454, 2e-4);
    EXPECT_NEAR(kolmogorov_cdf(101, 0.06), 0.16125004929947975, 2e-4);
    // The limit distribution's 5 % point is 1.3581.
    EXPECT_NEAR(kolmogorov_cdf(100'000'000, 1.3581e-4), 0.95, 1e-5);
}

TEST(PValues, UniformityFindsClustersButNotUniformNumbers)
{
    std::vector<double> even;
    std::vector<double> small;
    for (int i = 0; i < 50; ++i) {
        even.push_back((i + 0.5) / 50.0);
        small.push_back(even.back() * even.back());
    }
    EXPECT_NEAR(test_uniformity(even).distance, 0.01, 1e-12);
    EXPECT_NEAR(test_uniformity(even).p, 1.0, 1e-9);
    EXPECT_LT(test_uniformity(small).p, 0.01);
    EXPECT_EQ(test_uniformity({}).p, 1.0);
}

TEST(PValuesStat, UniformityTestIsItselfUniform)
{
    // 2,000 tests of 64 uniform numbers each; the count of p <= 5 % within its binomial bound,
    // which this fixed seed would miss once in 10,000 seeds.
    Rng rng(2, 0, Stream::Test, 0, 0);
    std::vector<double> p_values;
    int64_t rejected = 0;
    for (int i = 0; i < 2000; ++i) {
        std::vector<double> numbers(64);
        for (double& x : numbers) x = static_cast<double>(rng.uniform());
        p_values.push_back(test_uniformity(numbers).p);
        rejected += p_values.back() <= 0.05 ? 1 : 0;
    }
    EXPECT_LE(rejected, binomial_bound(2000, 0.05, 1e-4));
    EXPECT_GT(test_uniformity(p_values).p, 1e-4);
}

TEST(PValues, HistogramCountsBothEnds)
{
    const std::vector<int64_t> counts = histogram(std::vector<double>{0.0, 0.49, 0.5, 1.0}, 2);
    EXPECT_EQ(counts, (std::vector<int64_t>{2, 2}));
}

TEST(PValues, BinomialLimits)
{
    EXPECT_NEAR(binomial_upper_limit(10, 200, 0.95), 0.083335151066371974, 1e-12);
    // No event in n trials: 1 - 0.05^(1/n), the rule of three.
    EXPECT_NEAR(binomial_upper_limit(0, 100, 0.95), 1.0 - std::pow(0.05, 0.01), 1e-12);
    EXPECT_EQ(binomial_upper_limit(5, 5, 0.95), 1.0);
    // Of 200 trials at 5 %, more than 17 have a chance of 1.2 %, more than 18 one of 0.6 %.
    EXPECT_EQ(binomial_bound(200, 0.05, 0.01), 18);
    EXPECT_EQ(binomial_bound(200, 0.05, 1e-4), 23);
    EXPECT_EQ(binomial_bound(10, 0.0, 0.01), 0);
}

}  // namespace mote
