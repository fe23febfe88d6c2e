#include <gtest/gtest.h>

#include "core/distribution.h"
#include "support/chi_squared.h"

namespace mote {
namespace {

TEST(AliasTable, ProbabilitiesAreTheNormalisedWeights)
{
    const std::vector<float> weights{3.0f, 0.0f, 1.0f, 4.0f};
    const AliasTable table(weights);
    EXPECT_FLOAT_EQ(table.pmf(0), 0.375f);
    EXPECT_EQ(table.pmf(1), 0.0f);
    EXPECT_FLOAT_EQ(table.pmf(3), 0.5f);
    EXPECT_DOUBLE_EQ(table.sum(), 8.0);
}

TEST(AliasTable, RealisesItsProbabilitiesOnARegularGridOfRandomNumbers)
{
    // 2^16 equidistant u: each probability is met up to one grid step per column border.
    const std::vector<float> weights{3.0f, 0.0f, 1.0f, 4.0f, 1e-3f, 100.0f, 7.0f};
    const AliasTable table(weights);
    std::vector<double> counts(weights.size());
    const int steps = 1 << 16;
    for (int i = 0; i < steps; ++i) ++counts[table.sample((i + 0.5) / steps).index];
    for (size_t i = 0; i < weights.size(); ++i) {
        EXPECT_NEAR(counts[i] / steps, static_cast<double>(table.pmf(i)), 14.0 / steps) << i;
    }
}

TEST(AliasTable, NeverDrawsAZeroWeightAndKeepsUnequalWeightsApart)
{
    // One entry outweighs the other million; the rest must still be met at their true rate.
    std::vector<float> weights(1'000'000, 1e-3f);
    weights[17] = 1e6f;
    for (size_t i = 1; i < weights.size(); i += 2) weights[i] = i == 17 ? 1e6f : 0.0f;
    const AliasTable table(weights);
    const int trials = 4'000'000;
    int others = 0;
    Rng rng(3, 0, Stream::Test, 0, 0);
    for (int i = 0; i < trials; ++i) {
        const AliasTable::Sample sample = table.sample(uniform_double(rng));
        ASSERT_GT(weights[sample.index], 0.0f);
        if (sample.index != 17) ++others;
    }
    const double expected = trials * 500.0 / (1e6 + 500.0);  // 1999: 5 standard errors are 224
    EXPECT_NEAR(others, expected, 5.0 * std::sqrt(expected));
}

TEST(AliasTable, IsEmptyWithoutWeight)
{
    EXPECT_TRUE(AliasTable().is_empty());
    EXPECT_TRUE(AliasTable(std::vector<float>{0.0f, 0.0f}).is_empty());
    EXPECT_EQ(AliasTable(std::vector<float>{0.0f, 0.0f}).pmf(1), 0.0f);
}

TEST(AliasTable, TopRandomNumberIsSafe)
{
    for (const size_t count : {1u, 3u, 7u, 1000u}) {
        const AliasTable table(std::vector<float>(count, 0.1f));
        EXPECT_LT(table.sample(1.0 - 0x1p-53).index, count);
    }
}

}  // namespace
}  // namespace mote
