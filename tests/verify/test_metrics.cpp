#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "verify/metrics.h"

namespace mote {

namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

/// One row of pixels.
Channel row(const std::vector<float>& values, const std::string& name = "R")
{
    Channel channel{name, PixelType::Float, Buffer2D<float>(static_cast<int>(values.size()), 1)};
    std::copy(values.begin(), values.end(), channel.data.begin());
    return channel;
}

ChannelMetrics measure(const std::vector<float>& tested, const std::vector<float>& reference,
                       const MetricParams& params = {})
{
    return measure_channel({row(tested), row(reference)}, params);
}

}  // namespace

TEST(Metrics, FiguresByHand)
{
    // Differences 1, 0, -2, 0; reference 2, 2, 4, 0 with mean 2, so epsilon 0.01 * 4.
    const ChannelMetrics m = measure({3.0f, 2.0f, 2.0f, 0.0f}, {2.0f, 2.0f, 4.0f, 0.0f});
    EXPECT_EQ(m.pixel_count, 4);
    EXPECT_DOUBLE_EQ(m.mean_tested, 1.75);
    EXPECT_DOUBLE_EQ(m.mean_reference, 2.0);
    EXPECT_DOUBLE_EQ(m.mean_ratio, 0.875);
    EXPECT_DOUBLE_EQ(m.mse, 5.0 / 4.0);
    EXPECT_DOUBLE_EQ(m.epsilon, 0.04);
    EXPECT_DOUBLE_EQ(m.rel_mse, (1.0 / 4.04 + 4.0 / 16.04) / 4.0);
    // One pixel of four is dropped (0.1 %, rounded up): 4/16.04, the larger one.
    EXPECT_DOUBLE_EQ(m.rel_mse_trimmed, (1.0 / 4.04) / 3.0);
    EXPECT_DOUBLE_EQ(m.worst_share, 4.0 / 5.0);
    EXPECT_DOUBLE_EQ(m.peak, 4.0);
    EXPECT_DOUBLE_EQ(m.psnr, 10.0 * std::log10(16.0 / 1.25));
    ASSERT_EQ(m.worst.size(), 2u);  // equal pixels are not bad ones
    EXPECT_EQ(m.worst[0].x, 2);
    EXPECT_EQ(m.worst[0].tested, 2.0f);
    EXPECT_EQ(m.worst[0].reference, 4.0f);
    EXPECT_EQ(m.worst[1].x, 0);
    EXPECT_FALSE(m.noise);
}

TEST(Metrics, EqualImages)
{
    const ChannelMetrics m = measure({0.5f, 1.5f}, {0.5f, 1.5f});
    EXPECT_EQ(m.mse, 0.0);
    EXPECT_EQ(m.rel_mse, 0.0);
    EXPECT_EQ(m.mean_ratio, 1.0);
    EXPECT_TRUE(std::isinf(m.psnr) && m.psnr > 0.0);
    EXPECT_EQ(m.worst_share, 0.0);
    EXPECT_TRUE(m.worst.empty());
}

TEST(Metrics, RelativeErrorDoesNotDependOnTheScaleOfTheScene)
{
    // A power of two scales floats exactly.
    const std::vector<float> a = {0.3f, 0.7f, 1.1f, 0.0f};
    const std::vector<float> b = {0.4f, 0.6f, 1.3f, 0.1f};
    std::vector<float> large_a;
    std::vector<float> large_b;
    for (const float x : a) large_a.push_back(x * 0x1p40f);
    for (const float x : b) large_b.push_back(x * 0x1p40f);
    EXPECT_DOUBLE_EQ(measure(large_a, large_b).rel_mse, measure(a, b).rel_mse);
    EXPECT_DOUBLE_EQ(measure(large_a, large_b).psnr, measure(a, b).psnr);
}

TEST(Metrics, OneFireflyInTenThousandPixelsIsShownButTrimmed)
{
    std::vector<float> tested(10'000, 1.1f);
    const std::vector<float> reference(10'000, 1.0f);
    tested[1234] = 1e6f;
    const ChannelMetrics m = measure(tested, reference);
    EXPECT_NEAR(m.rel_mse, 1e12 / 1.01 / 10'000.0, 1e3);
    EXPECT_NEAR(m.rel_mse_trimmed, 0.01 / 1.01, 1e-7);  // float 1.1 is off by 2e-8
    EXPECT_NEAR(m.worst_share, 1.0, 1e-9);
    EXPECT_EQ(m.worst[0].x, 1234);
}

TEST(Metrics, TheWorstPixelsAreSortedAndLimited)
{
    MetricParams params;
    params.worst_count = 2;
    const ChannelMetrics m = measure({1.0f, -4.0f, 2.0f, 3.0f}, {0.0f, 0.0f, 0.0f, 0.0f}, params);
    ASSERT_EQ(m.worst.size(), 2u);
    EXPECT_EQ(m.worst[0].x, 1);
    EXPECT_EQ(m.worst[1].x, 3);
    params.worst_count = 0;
    EXPECT_TRUE(measure({1.0f}, {0.0f}, params).worst.empty());
}

TEST(Metrics, NonFinitePixelsAreCountedAndLeftOut)
{
    const ChannelMetrics m = measure({nan_value, 1.0f, infinite, infinite, nan_value, 2.0f},
                                     {1.0f, nan_value, infinite, -infinite, nan_value, 3.0f});
    EXPECT_EQ(m.pixel_count, 1);
    EXPECT_EQ(m.non_finite_tested, 4);
    EXPECT_EQ(m.non_finite_reference, 4);
    EXPECT_EQ(m.non_finite_differing, 3);  // equal infinities and NaN in both are the same
    EXPECT_DOUBLE_EQ(m.mse, 1.0);
    EXPECT_DOUBLE_EQ(m.mean_reference, 3.0);
    const ChannelMetrics none = measure({nan_value}, {nan_value});
    EXPECT_EQ(none.pixel_count, 0);
    EXPECT_TRUE(std::isnan(none.mse) && std::isnan(none.mean_ratio));
}

TEST(Metrics, ABlackReferenceMakesAnyLightInfinitelyWrong)
{
    const ChannelMetrics m = measure({1.0f, 0.0f}, {0.0f, 0.0f});
    EXPECT_TRUE(std::isinf(m.rel_mse));
    EXPECT_TRUE(std::isinf(m.mean_ratio));
    EXPECT_EQ(measure({0.0f, 0.0f}, {0.0f, 0.0f}).rel_mse, 0.0);
    EXPECT_EQ(measure({0.0f, 0.0f}, {0.0f, 0.0f}).mean_ratio, 1.0);
}

TEST(Metrics, NoiseOfTheReferenceByHand)
{
    const Channel tested = row({3.0f, 2.0f, 2.0f, 0.0f});
    const Channel reference = row({2.0f, 2.0f, 4.0f, 0.0f});
    const Channel reference_variance = row({1.0f, 0.5f, 0.5f, 0.0f});
    const Channel tested_variance = row({2.0f, 2.0f, 3.0f, 0.0f});
    const auto known =
        measure_channel({tested, reference, &tested_variance, &reference_variance}, {});
    ASSERT_TRUE(known.noise);
    EXPECT_DOUBLE_EQ(known.noise->mse, (5.0 - 2.0) / 4.0);
    EXPECT_DOUBLE_EQ(known.noise->standard_error, std::sqrt(2.0 + 7.0) / 4.0);
    EXPECT_DOUBLE_EQ(known.noise->z, -1.0 / 3.0);  // differences sum to -1
    // Without the tested image's variance: from the squared differences, which sum to 5.
    const auto unknown = measure_channel({tested, reference, nullptr, &reference_variance}, {});
    EXPECT_DOUBLE_EQ(unknown.noise->standard_error, std::sqrt(5.0) / 4.0);
    EXPECT_DOUBLE_EQ(unknown.noise->z, -1.0 / std::sqrt(5.0));
}

TEST(Metrics, BadVariancesAreCountedAndLeftOut)
{
    const Channel tested = row({3.0f, 2.0f, 2.0f});
    const Channel reference = row({2.0f, 1.0f, 4.0f});
    const Channel variance = row({nan_value, 0.25f, -1.0f});
    const auto m = measure_channel({tested, reference, nullptr, &variance}, {});
    EXPECT_EQ(m.noise->bad_variances, 2);
    EXPECT_DOUBLE_EQ(m.noise->mse, 0.75);
    EXPECT_DOUBLE_EQ(m.mse, 2.0);  // the plain figure keeps them
}

}  // namespace mote
