#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/rng.h"
#include "verify/tiles.h"

namespace mote {

namespace {

/// A made-up estimator: every pixel an independent exponential number times the picture's value,
/// the channels of a pixel correlated as one path's colours are, and an error that all pixels of a
/// run share, as reuse between pixels and frames makes it.
struct FakeEstimator {
    int width = 64;
    int height = 48;
    double scale = 1.0;          ///< of the whole picture; 1: unbiased
    double pixel_noise = 1.0;    ///< relative standard deviation
    double shared_noise = 0.02;  ///< relative standard deviation
    double corner_scale = 1.0;   ///< of the 16x16 pixels at the upper left

    [[nodiscard]] LayeredImage render(uint32_t seed) const
    {
        LayeredImage image;
        image.width = width;
        image.height = height;
        for (const char* name : {"R", "G", "B"}) {
            image.channels.push_back({name, PixelType::Float, Buffer2D<float>(width, height)});
        }
        Rng shared(seed, 1, Stream::Test, 0, 0);
        const double run_error = shared_noise * std::sqrt(12.0) * (uniform(shared) - 0.5);
        for (int y = 0; y < height; ++y) {
            Rng rng(seed, 0, Stream::Test, static_cast<uint32_t>(y), 0);
            for (int x = 0; x < width; ++x) {
                const double path = exponential(rng);
                const bool in_corner = x < 16 && y < 16;
                const double expected =
                    (1.0 + x) / width * scale * (in_corner ? corner_scale : 1.0);
                for (Channel& channel : image.channels) {
                    const double noise = 0.5 * (path + exponential(rng)) - 1.0;
                    channel.data.at(x, y) = static_cast<float>(
                        expected * (1.0 + run_error + std::sqrt(2.0) * pixel_noise * noise));
                }
            }
        }
        return image;
    }

    [[nodiscard]] TileStats run(int count, uint32_t first_seed, int tile_size = 16) const
    {
        TileStats stats(tile_size);
        for (int i = 0; i < count; ++i) {
            add_run(stats, render(first_seed + static_cast<uint32_t>(i)));
        }
        return stats;
    }

  private:
    static double uniform(Rng& rng) { return static_cast<double>(rng.uniform()); }
    static double exponential(Rng& rng) { return -std::log1p(-uniform(rng)); }
};

LayeredImage grey_image(int width, int height, float value)
{
    LayeredImage image;
    image.width = width;
    image.height = height;
    image.channels.push_back({"Y", PixelType::Float, Buffer2D<float>(width, height, value)});
    return image;
}

}  // namespace

TEST(Tiles, MeansOverTilesIncludingCutOnes)
{
    TileStats stats(2);
    LayeredImage image = grey_image(3, 3, 0.0f);
    for (int i = 0; i < 9; ++i) image.channels[0].data.data()[i] = static_cast<float>(i);
    add_run(stats, image);
    ASSERT_EQ(stats.columns, 2);
    ASSERT_EQ(stats.rows, 2);
    const auto& tiles = stats.find("Y")->tiles;
    EXPECT_EQ(tiles[0].mean, 2.0);  // 0 1 3 4
    EXPECT_EQ(tiles[1].mean, 3.5);  // 2 5
    EXPECT_EQ(tiles[2].mean, 6.5);  // 6 7
    EXPECT_EQ(tiles[3].mean, 8.0);
    EXPECT_EQ(stats.find("Y")->whole_image.mean, 4.0);
    EXPECT_EQ(stats.find("Z"), nullptr);
}

TEST(Tiles, NonFinitePixelsAreCountedNotAveraged)
{
    TileStats stats(2);
    LayeredImage image = grey_image(4, 2, 3.0f);
    image.channels[0].data.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
    image.channels[0].data.at(2, 0) = std::numeric_limits<float>::infinity();
    add_run(stats, image);
    add_run(stats, grey_image(4, 2, 3.0f));
    EXPECT_EQ(stats.find("Y")->non_finite, 2);
    EXPECT_EQ(stats.find("Y")->tiles[0].mean, 3.0);
    EXPECT_EQ(stats.find("Y")->whole_image.mean, 3.0);
    EXPECT_EQ(compare_runs(stats, stats).non_finite, 4);
}

TEST(Tiles, RoundingOfFloatsIsNoBiasButAnyRealDifferenceWithoutVarianceIs)
{
    TileStats exact(8);
    TileStats rounded(8);
    TileStats wrong(8);
    for (int run = 0; run < 3; ++run) {
        add_run(exact, grey_image(8, 8, 1.0f));
        add_run(rounded, grey_image(8, 8, std::nextafter(1.0f, 2.0f)));
        add_run(wrong, grey_image(8, 8, 1.0001f));
    }
    EXPECT_EQ(compare_runs(rounded, exact).p, 1.0);
    EXPECT_EQ(compare_runs(wrong, exact).p, 0.0);
    // Tiles that do not vary say nothing about uniformity.
    EXPECT_EQ(compare_runs(wrong, exact).channels[0].uniformity.count, 0);
}

TEST(TilesStat, WithoutBiasTheWholeTestRejectsNoMoreThanItsNominalRate)
{
    // 200 times 12 runs against 12 runs of the same estimator with strong correlation between
    // pixels and channels. At most 23 of 200 at 5 %: fails falsely once in 10,000 seeds.
    FakeEstimator estimator;
    estimator.width = 48;
    estimator.height = 32;
    int64_t rejected = 0;
    for (uint32_t i = 0; i < 200; ++i) {
        const TileStats tested = estimator.run(12, 1000 + 24 * i);
        const TileStats reference = estimator.run(12, 1012 + 24 * i);
        rejected += compare_runs(tested, reference).p <= 0.05 ? 1 : 0;
    }
    EXPECT_LE(rejected, binomial_bound(200, 0.05, 1e-4));
    RecordProperty("rejected_of_200", static_cast<int>(rejected));
}

TEST(TilesStat, PixelsOfOneRunAreNoReplicates)
{
    // Negative control: taking the pixels of one run as independent observations rejects the same
    // unbiased estimator far more often, since it cannot see the error they share.
    FakeEstimator estimator;
    estimator.shared_noise = 0.05;
    int64_t rejected = 0;
    for (uint32_t i = 0; i < 200; ++i) {
        const LayeredImage tested = estimator.render(2 * i);
        const LayeredImage reference = estimator.render(2 * i + 1);
        RunningStats a;
        RunningStats b;
        for (const float value : tested.find("R")->data) a.add(value);
        for (const float value : reference.find("R")->data) b.add(value);
        rejected += welch_test(estimate_mean(a), estimate_mean(b)).p <= 0.05 ? 1 : 0;
    }
    EXPECT_GT(rejected, binomial_bound(200, 0.05, 1e-12));
}

TEST(TilesStat, PValuesOfIndependentTilesAreUniform)
{
    // 48 tiles of 16x16 exponential pixels over 16 runs: near enough to normal.
    FakeEstimator estimator;
    estimator.width = 128;
    estimator.height = 96;
    estimator.shared_noise = 0.0;
    const RunComparison comparison = compare_runs(estimator.run(16, 1), estimator.run(16, 101));
    for (const ChannelComparison& channel : comparison.channels) {
        EXPECT_EQ(channel.uniformity.count, 48);
        EXPECT_GT(channel.uniformity.p, 1e-3) << channel.name;
    }
}

TEST(TilesStat, OnePercentOfBiasIsRejected)
{
    FakeEstimator unbiased;
    unbiased.pixel_noise = 0.3;
    unbiased.shared_noise = 0.0;
    FakeEstimator biased = unbiased;
    biased.scale = 1.01;
    const TileStats reference = unbiased.run(24, 1);
    const RunComparison found = compare_runs(biased.run(24, 101), reference);
    const RunComparison none = compare_runs(unbiased.run(24, 101), reference);
    EXPECT_LT(found.p, 1e-3);
    EXPECT_GT(none.p, 0.05);
    for (const ChannelComparison& channel : found.channels) {
        const double detectable =
            smallest_detectable_bias(channel.whole_image.difference, 0.05 / 6.0, 0.9);
        EXPECT_LT(detectable / channel.reference.mean, 0.01) << channel.name;
        EXPECT_TRUE(channel.mean_ratio.contains(1.01)) << channel.name;
        EXPECT_FALSE(channel.mean_ratio.contains(1.0)) << channel.name;
    }
}

TEST(TilesStat, BiasOfOneTileIsFoundWhereItIs)
{
    FakeEstimator unbiased;
    unbiased.pixel_noise = 0.3;
    unbiased.shared_noise = 0.0;
    FakeEstimator biased = unbiased;
    biased.corner_scale = 1.1;  // 0.15 % of the whole picture
    const RunComparison found = compare_runs(biased.run(24, 101), unbiased.run(24, 1));
    EXPECT_LT(found.p_tiles, 1e-3);
    for (const ChannelComparison& channel : found.channels) {
        EXPECT_GT(channel.tiles[0].t, 5.0);
        for (size_t i = 1; i < channel.tiles.size(); ++i)
            EXPECT_LT(std::abs(channel.tiles[i].t), 5.0);
    }
}

TEST(TilesStat, EquivalenceIsShownByEnoughRunsOnly)
{
    FakeEstimator estimator;
    estimator.pixel_noise = 0.3;
    estimator.shared_noise = 0.0;
    const auto worst_p = [&](int run_count) {
        const RunComparison comparison =
            compare_runs(estimator.run(run_count, 1), estimator.run(run_count, 101));
        double worst = 0.0;
        for (const ChannelComparison& c : comparison.channels) {
            worst = std::max(worst, ratio_equivalence_p(c.tested, c.reference, 0.01));
        }
        return worst;
    };
    EXPECT_GT(worst_p(2), 0.05);
    EXPECT_LT(worst_p(24), 0.01);
}

TEST(Tiles, ErrorSplitsIntoBiasAndVarianceByHand)
{
    TileStats tested(1);
    TileStats reference(1);
    for (const float value : {2.0f, 4.0f}) add_run(tested, grey_image(1, 1, value));
    add_run(reference, grey_image(1, 1, 1.0f));
    // Mean 3, variance 2, of the mean 1: (3 - 1)^2 - 1 = 3.
    const ErrorSplit split = split_error(tested, reference, "Y");
    EXPECT_DOUBLE_EQ(split.bias_squared, 3.0);
    EXPECT_DOUBLE_EQ(split.noise, 1.0);
    EXPECT_DOUBLE_EQ(split.variance, 2.0);
    EXPECT_DOUBLE_EQ(split.mse(), 5.0);  // the mean of (2 - 1)^2 and (4 - 1)^2
    EXPECT_DOUBLE_EQ(split_relative_error(tested, reference, "Y", 3.0).mse(), 5.0 / 4.0);
    try {
        (void)split_error(tested, reference, "R");
        FAIL() << "a missing channel was accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Input);
    }
}

TEST(TilesStat, ErrorSplitIsUnbiasedBySubtractingTheNoiseOfBothMeans)
{
    // Bias 10 % of (1+x)/64, variance 25 % of its square per pixel (over three channels of which
    // one is used), 8 runs each. Mean of ((1+x)/64)^2 over x = 0..63 is 0.34118.
    FakeEstimator unbiased;
    unbiased.pixel_noise = 0.5;
    unbiased.shared_noise = 0.0;
    FakeEstimator biased = unbiased;
    biased.scale = 1.1;
    double power = 0.0;
    for (int x = 0; x < 64; ++x) power += (1.0 + x) * (1.0 + x) / (64.0 * 64.0 * 64.0);
    RunningStats bias_squared;
    RunningStats uncorrected;
    RunningStats variance;
    for (uint32_t i = 0; i < 20; ++i) {
        const ErrorSplit split =
            split_error(biased.run(8, 1000 * i, 1), unbiased.run(8, 1000 * i + 500, 1), "G");
        bias_squared.add(split.bias_squared);
        uncorrected.add(split.bias_squared + split.noise);
        variance.add(split.variance);
    }
    // Four standard errors over 20 repetitions (t with 19 degrees: once in 1,300 seeds).
    EXPECT_NEAR(bias_squared.mean, 0.01 * power, 4.0 * bias_squared.standard_error());
    EXPECT_NEAR(variance.mean, 0.25 * 1.21 * power, 4.0 * variance.standard_error());
    // Without the correction the same data say several times as much.
    EXPECT_GT(uncorrected.mean, 4.0 * 0.01 * power);
}

}  // namespace mote
