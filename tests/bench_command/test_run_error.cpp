#include <limits>

#include <gtest/gtest.h>

#include "bench_command/noisy_images.h"
#include "runs/run_error.h"
#include "runs/trimmed_mean.h"

namespace mote {

namespace {

constexpr int width = 64;
constexpr int height = 50;
constexpr double value_count = 3.0 * width * height;

PixelStats exact_reference(const Buffer2D<Spectrum>& image)
{
    PixelStats stats;
    add_run(stats, image);
    add_run(stats, image);
    return stats;
}

}  // namespace

TEST(TrimmedMean, LeavesOutWholePixelsAndTakesTheMiddle)
{
    const std::vector<double> values{1.0, 9.0, 2.0, 4.0};
    EXPECT_DOUBLE_EQ(trimmed_mean(values, worst_pixels(values, 0.0)), 4.0);
    EXPECT_DOUBLE_EQ(trimmed_mean(values, worst_pixels(values, 0.01)), 7.0 / 3.0);
    EXPECT_DOUBLE_EQ(trimmed_mean(values, worst_pixels(values, 0.5)), 1.5);
    EXPECT_DOUBLE_EQ(trimmed_mean(values, worst_pixels(values, 1.0)), 0.0);
    EXPECT_DOUBLE_EQ(trimmed_mean({}, worst_pixels({}, 0.5)), 0.0);
    EXPECT_DOUBLE_EQ(median({3.0, 1.0, 2.0}), 2.0);
    EXPECT_DOUBLE_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
    EXPECT_TRUE(std::isnan(median({})));
    EXPECT_TRUE(std::isnan(median({1.0, std::numeric_limits<double>::quiet_NaN()})));
}

TEST(PixelStats, MatchTheFormulas)
{
    PixelStats stats;
    add_run(stats, Buffer2D<Spectrum>(2, 1, Spectrum(1.0f, 2.0f, 3.0f)));
    EXPECT_EQ(mean_variance(stats), 0.0);
    EXPECT_EQ(variance_of_mean(stats, 0), Spectrum(0.0f));
    Buffer2D<Spectrum> second(2, 1, Spectrum(1.0f, 2.0f, 3.0f));
    second.at(1, 0) = Spectrum(3.0f, 2.0f, 3.0f);
    add_run(stats, second);
    // One value of six has the runs 1 and 3: variance 2, of the mean 1.
    EXPECT_FLOAT_EQ(stats.mean.at(1, 0).x, 2.0f);
    EXPECT_DOUBLE_EQ(mean_variance(stats), 2.0 / 6.0);
    EXPECT_EQ(variance_of_mean(stats, 1), Spectrum(1.0f, 0.0f, 0.0f));
    EXPECT_DOUBLE_EQ(trimmed_mean_variance(stats, 0.5), 0.0);
    EXPECT_DOUBLE_EQ(stats.image_means.mean, 0.5 * (2.0 + 14.0 / 6.0));
}

TEST(PixelStats, NonFinitePixelsBecomeBlackAndAreCounted)
{
    Buffer2D<Spectrum> image(3, 1, Spectrum(1.0f));
    image.at(0, 0).y = std::numeric_limits<float>::quiet_NaN();
    image.at(2, 0).x = std::numeric_limits<float>::infinity();
    EXPECT_EQ(replace_non_finite(image), 2);
    EXPECT_EQ(image.at(0, 0), Spectrum(0.0f));
    EXPECT_EQ(image.at(1, 0), Spectrum(1.0f));
    EXPECT_EQ(replace_non_finite(image), 0);
}

TEST(RunError, IsBiasSquaredPlusVarianceOverTheSquaredMean)
{
    // A constant error of 0.1 in red alone, against 0.5: (0.01 / 3) / 0.25.
    const PixelStats reference = exact_reference(Buffer2D<Spectrum>(width, height, Spectrum(0.5f)));
    const Buffer2D<Spectrum> image(width, height, Spectrum(0.6f, 0.5f, 0.5f));
    const RunError error = measure_error(image, reference);
    EXPECT_NEAR(error.mse, 0.01 / 3.0 / 0.25, 1e-8);
    EXPECT_NEAR(error.trimmed_mse, error.mse, 1e-8);
    EXPECT_NEAR(error.rel_mse, 0.01 / 3.0 / (0.25 + 0.01 * 0.25), 1e-8);
    EXPECT_NEAR(error.worst_share, 1e-3 * 4.0 / 3.2, 1e-6);  // 4 of 3200 pixels
}

TEST(RunError, TrimmingTakesTheFireflyAndSaysItsShare)
{
    const PixelStats reference = exact_reference(Buffer2D<Spectrum>(width, height, Spectrum(1.0f)));
    Buffer2D<Spectrum> image(width, height, Spectrum(1.1f));
    image.at(7, 9) = Spectrum(101.0f);
    const RunError error = measure_error(image, reference);
    EXPECT_NEAR(error.trimmed_mse, 0.01, 1e-7);
    EXPECT_NEAR(error.mse, (10000.0 + 0.01 * (width * height - 1)) / (width * height), 1e-5);
    EXPECT_GT(error.worst_share, 0.99);
}

TEST(RunErrorStat, TheNoiseOfTheReferenceIsTakenOff)
{
    // Truth 1, image with bias 0.05 and variance 0.01, reference of 4 runs of variance 0.08, so of
    // variance 0.02 in the mean. The expected error is 0.01 + 0.0025 whatever the reference.
    constexpr double variance = 0.01;
    constexpr double bias = 0.05;
    constexpr double noise = 0.02;
    const PixelStats reference = noisy_runs(width, height, 1.0f, 4.0 * noise, 4, 1);
    const Buffer2D<Spectrum> image = noisy_image(width, height, 1.05f, variance, 100);
    const RunError error = measure_error(image, reference);
    // Squares of sums of uniform numbers scatter less than those of normal ones: var(d^2) <
    // 2 s^4 + 4 b^2 s^2, and the estimate of the noise, of 3 degrees of freedom, adds
    // 2 noise^2 / 3. Four of these fail falsely once in 16,000 seeds.
    const double s2 = variance + noise;
    const double tolerance =
        4.0 * std::sqrt((2.0 * s2 * s2 + 4.0 * bias * bias * s2 + 2.0 * noise * noise / 3.0) /
                        value_count);
    const double expected = variance + bias * bias;
    EXPECT_LT(tolerance, 0.2 * expected);
    EXPECT_NEAR(error.mse, expected, tolerance);
    EXPECT_NEAR(reference_noise(reference), noise, 0.1 * noise);
    // Negative control: with the reference taken for exact the error is far off.
    const RunError uncorrected = measure_error(image, exact_reference(reference.mean));
    EXPECT_GT(std::abs(uncorrected.mse - expected), 5.0 * tolerance);
}

}  // namespace mote
