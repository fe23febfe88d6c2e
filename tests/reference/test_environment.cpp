#include <gtest/gtest.h>

#include "core/error.h"
#include "core/sampling.h"
#include "scene/environment.h"
#include "support/chi_squared.h"
#include "support/trials.h"

namespace mote {
namespace {

/// Random pixels, one black row, one very bright pixel.
Buffer2D<Spectrum> test_image(int width, int height)
{
    Buffer2D<Spectrum> pixels(width, height);
    Rng rng(9, 0, Stream::Test, 0, 0);
    for (Spectrum& pixel : pixels) pixel = rng.uniform3();
    for (int x = 0; x < width; ++x) pixels.at(x, height / 2) = Spectrum(0.0f);
    pixels.at(width / 3, height / 4) = Spectrum(50.0f);
    return pixels;
}

EnvironmentLight image_light(Buffer2D<Spectrum> pixels)
{
    EnvironmentLight light;
    light.map = make_environment_map(std::move(pixels), "test image");
    light.map_from_world =
        glm::mat3_cast(glm::angleAxis(0.7f, glm::normalize(Vec3(1.0f, 2.0f, 3.0f))));
    return light;
}

TEST(EnvironmentStat, SamplesFollowTheirDensity)
{
    // 16 x 32 equal-area bins of world directions; |z| > 5 once in 1.7 million seeds per image.
    const int rows = 16;
    const int columns = 32;
    for (const auto& [width, height] : {std::pair{16, 8}, {1, 5}, {7, 1}, {64, 32}}) {
        const EnvironmentLight light = image_light(test_image(width, height));
        std::vector<double> observed(rows * columns);
        std::vector<double> expected(observed.size());
        const int trials = 200'000;
        Rng rng(5, 0, Stream::Test, 0, 0);
        const auto bin = [&](Vec3 d) {
            const int row = std::min(static_cast<int>((1.0f - d.z) * 0.5f * rows), rows - 1);
            const float phi = std::atan2(d.y, d.x) / (2.0f * pi) + 0.5f;
            return static_cast<size_t>(row * columns +
                                       std::min(static_cast<int>(phi * columns), columns - 1));
        };
        for (int i = 0; i < trials; ++i) {
            const auto sample = sample_environment(light, rng);
            ASSERT_TRUE(sample);
            EXPECT_NEAR(glm::length(sample->wi), 1.0f, 1e-5f);
            ++observed[bin(sample->wi)];
        }
        const int steps = 3'000'000;
        for (int i = 0; i < steps; ++i) {  // R2 sequence: even, with no grid to line up with pixels
            const double u = std::fmod(0.5 + i * 0.7548776662466927, 1.0);
            const double v = std::fmod(0.5 + i * 0.5698402909980532, 1.0);
            const Vec3 d = sample_sphere({static_cast<float>(u), static_cast<float>(v)});
            expected[bin(d)] += static_cast<double>(environment_pdf(light, d)) * 4.0 *
                                std::numbers::pi * trials / steps;
        }
        EXPECT_LT(test::chi_squared_z(observed, expected), 5.0) << width << "x" << height;
    }
}

TEST(Environment, SampleCarriesItsDensityAndRadiance)
{
    const EnvironmentLight light = image_light(test_image(32, 16));
    int differ = 0;
    for (uint32_t i = 0; i < 10'000; ++i) {
        Rng rng(6, 0, Stream::Test, i, 0);
        const auto sample = sample_environment(light, rng);
        ASSERT_TRUE(sample);
        // Rounding moves a direction on a pixel border to the other pixel now and then.
        if (std::abs(environment_pdf(light, sample->wi) / sample->pdf_dir - 1.0f) > 1e-3f) ++differ;
        const Spectrum radiance = environment_radiance(light, sample->wi);
        EXPECT_NEAR(luminance(radiance) / luminance(sample->Li), 1.0f, 1e-2f);
    }
    EXPECT_LT(differ, 10);
}

TEST(EnvironmentStat, FluenceIsTheSameHoweverItIsSampled)
{
    const EnvironmentLight light = image_light(test_image(16, 8));
    const RunningStats by_image = test::run_trials(100'000, 7, [&](Rng& rng) {
        const auto sample = sample_environment(light, rng);
        return luminance(sample->Li) / sample->pdf_dir;
    });
    const RunningStats by_direction = test::run_trials(400'000, 8, [&](Rng& rng) {
        return luminance(environment_radiance(light, sample_sphere(rng.uniform2()))) /
               sample_sphere_pdf();
    });
    const double error = std::hypot(by_image.standard_error(), by_direction.standard_error());
    EXPECT_LT(std::abs(by_image.mean - by_direction.mean), 5.0 * error);
    const double fluence = static_cast<double>(environment_fluence(light));
    EXPECT_LT(std::abs(by_image.mean - fluence), 5.0 * by_image.standard_error() + 0.02 * fluence);
    // Importance sampling is there to lower the variance: by 30 in this image with its sun.
    EXPECT_LT(by_image.variance(), 0.1 * by_direction.variance());
}

TEST(Environment, ImageCentreLooksAlongMinusZWithPlusXToItsRight)
{
    Buffer2D<Spectrum> pixels(64, 32);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x)
            pixels.at(x, y) = Spectrum(static_cast<float>(x), static_cast<float>(y), 0.0f);
    }
    EnvironmentLight light;
    light.map = make_environment_map(pixels, "gradient");
    const auto pixel = [&](Vec3 d) { return environment_radiance(light, d); };
    EXPECT_NEAR(pixel({0.0f, 0.0f, -1.0f}).x, 31.5f, 1e-3f);
    EXPECT_NEAR(pixel({1.0f, 0.0f, 0.0f}).x, 47.5f, 1e-3f);
    EXPECT_NEAR(pixel({-1.0f, 0.0f, 0.0f}).x, 15.5f, 1e-3f);
    EXPECT_NEAR(pixel({0.0f, 1.0f, 0.0f}).y, 0.0f, 1e-3f);
    EXPECT_NEAR(pixel({0.0f, -1.0f, 0.0f}).y, 31.0f, 1e-3f);
}

TEST(Environment, AConstantImageIsAConstantEnvironment)
{
    const EnvironmentLight light = image_light(Buffer2D<Spectrum>(8, 4, Spectrum(0.5f)));
    EXPECT_NEAR(environment_fluence(light), 2.0f * pi, 1e-4f);
    for (uint32_t i = 0; i < 1000; ++i) {
        Rng rng(8, 0, Stream::Test, i, 0);
        const auto sample = sample_environment(light, rng);
        EXPECT_NEAR(sample->pdf_dir, inv_4pi, 1e-5f);
        EXPECT_NEAR(sample->Li.x, 0.5f, 1e-6f);
    }
}

TEST(Environment, BadPixelsCountAsBlackAndEmptyImagesAreRefused)
{
    Buffer2D<Spectrum> pixels(4, 2, Spectrum(1.0f));
    pixels.at(0, 0).x = std::numeric_limits<float>::quiet_NaN();
    pixels.at(1, 0).y = infinity;
    pixels.at(2, 0).z = -1.0f;
    const auto map = make_environment_map(pixels, "bad");
    for (int x = 0; x < 3; ++x) EXPECT_EQ(map->pixels.at(x, 0), Spectrum(0.0f));
    EXPECT_EQ(map->pixels.at(3, 0), Spectrum(1.0f));
    EXPECT_THROW(static_cast<void>(make_environment_map(Buffer2D<Spectrum>(0, 4), "none")), Error);
    EXPECT_THROW(static_cast<void>(make_environment_map(Buffer2D<Spectrum>(), "none")), Error);
}

TEST(Environment, BlackEnvironmentsGiveNoSample)
{
    EnvironmentLight black = image_light(Buffer2D<Spectrum>(4, 2));
    Rng rng(1, 0, Stream::Test, 0, 0);
    EXPECT_FALSE(sample_environment(black, rng));
    EXPECT_EQ(environment_pdf(black, Vec3(0.0f, 1.0f, 0.0f)), 0.0f);
    EXPECT_EQ(environment_fluence(black), 0.0f);
    EnvironmentLight dark;
    dark.radiance = Spectrum(0.0f);
    EXPECT_FALSE(sample_environment(dark, rng));
}

TEST(Environment, DirectionsThatAreNotFiniteSeeNothing)
{
    const EnvironmentLight light = image_light(test_image(16, 8));
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity}) {
        EXPECT_EQ(environment_radiance(light, Vec3(bad, 0.0f, 0.0f)), Spectrum(0.0f));
        EXPECT_EQ(environment_pdf(light, Vec3(0.0f, bad, 0.0f)), 0.0f);
    }
}

}  // namespace
}  // namespace mote
