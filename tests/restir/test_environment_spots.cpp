#include <gtest/gtest.h>

#include <set>

#include "core/sampling.h"
#include "restir/environment_spots.h"
#include "restir/scenes.h"
#include "support/trials.h"

namespace mote {
namespace {

TEST(EnvironmentSpots, SunsAreFoundAndTheRestIsEven)
{
    const EnvironmentParts parts = split_environment(test::sunny_sky());
    ASSERT_EQ(parts.spots.size(), 2u);
    std::set<uint32_t> pixels;
    for (const EnvironmentSpot& spot : parts.spots) {
        EXPECT_NEAR(glm::length(spot.direction), 1.0f, 1e-5f);
        EXPECT_GT(luminance(environment_radiance(parts.whole, spot.direction)), 10.0f);
        for (const uint32_t pixel : spot.pixels) {
            EXPECT_TRUE(pixels.insert(pixel).second) << "two spots share pixel " << pixel;
        }
    }
    EXPECT_GT(luminance(parts.spots[0].irradiance), luminance(parts.spots[1].irradiance));
    float most = 0.0f;
    for (const Spectrum& pixel : parts.rest.map->pixels) most = std::max(most, luminance(pixel));
    EXPECT_LT(most, 20.0f);  // of 800
}

/// What the parts claim holds exactly: the rest is below the whole, and outside the spots' squares
/// it is the whole.
TEST(EnvironmentSpots, OutsideTheSpotsNothingIsTaken)
{
    const EnvironmentParts parts = split_environment(test::sunny_sky());
    std::set<uint32_t> squares;
    for (const EnvironmentSpot& spot : parts.spots) {
        squares.insert(spot.pixels.begin(), spot.pixels.end());
    }
    const int width = parts.whole.map->pixels.width();
    const int height = parts.whole.map->pixels.height();
    Rng rng(1, 0, Stream::Test, 0, 0);
    int inside = 0;
    for (int i = 0; i < 200'000; ++i) {
        const int x = static_cast<int>(rng.uniform() * static_cast<float>(width));
        const int y = static_cast<int>(rng.uniform() * static_cast<float>(height));
        const float theta = pi * (static_cast<float>(y) + 0.01f + 0.98f * rng.uniform()) /
                            static_cast<float>(height);
        const Vec3 wi = environment_direction(
            parts.whole, static_cast<float>(x) + 0.01f + 0.98f * rng.uniform(), std::cos(theta));
        const Spectrum whole = environment_radiance(parts.whole, wi);
        const Spectrum rest = environment_radiance(parts.rest, wi);
        if (squares.count(static_cast<uint32_t>(y * width + x)) > 0) {
            ++inside;
            EXPECT_GE(whole.x, rest.x * 0.99999f);
        } else {
            EXPECT_EQ(whole, rest);
        }
    }
    EXPECT_GT(inside, 100);
}

TEST(EnvironmentSpotsStat, IrradianceIsTheIntegralOfTheRadiance)
{
    // Closed form against samples, in every channel: 5 standard errors, or float rounding where all
    // samples are alike.
    const EnvironmentParts parts = split_environment(test::sunny_sky());
    for (const EnvironmentSpot& spot : parts.spots) {
        for (int c = 0; c < 3; ++c) {
            const RunningStats stats = test::run_trials(200'000, 9, [&](Rng& rng) {
                const float u_pixel = rng.uniform();
                const LightSample sample = sample_spot(parts, spot, u_pixel, rng.uniform2());
                return sample.Li[c] / sample.pdf_dir;
            });
            const double exact = static_cast<double>(spot.irradiance[c]);
            EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 1e-5 * exact);
            EXPECT_LT(stats.standard_error(), 2e-3 * exact);
        }
    }
}

TEST(EnvironmentSpotsStat, SpotsAndRestGiveTheWholesLight)
{
    // Irradiance from all directions by uniform samples of the rest; 5 standard errors.
    const EnvironmentParts parts = split_environment(test::sunny_sky());
    const RunningStats rest = test::run_trials(100'000, 10, [&](Rng& rng) {
        return 4.0f * pi *
               luminance(environment_radiance(parts.rest, sample_sphere(rng.uniform2())));
    });
    double sum = rest.mean;
    for (const EnvironmentSpot& spot : parts.spots) {
        sum += static_cast<double>(luminance(spot.irradiance));
    }
    // The image's own sum of light is a midpoint rule in latitude: good to 1e-4 with 90 rows.
    EnvironmentLight grey = parts.whole;
    grey.radiance = Spectrum(1.0f);
    const EnvironmentParts of_grey = split_environment(grey);
    const double whole = static_cast<double>(environment_fluence(grey));
    double grey_sum =
        test::run_trials(100'000, 10, [&](Rng& rng) {
            return 4.0f * pi *
                   luminance(environment_radiance(of_grey.rest, sample_sphere(rng.uniform2())));
        }).mean;
    for (const EnvironmentSpot& spot : of_grey.spots) {
        grey_sum += static_cast<double>(luminance(spot.irradiance));
    }
    EXPECT_NEAR(grey_sum, whole, 5.0 * rest.standard_error() + 2e-4 * whole);
    EXPECT_LT(sum, grey_sum);
}

TEST(EnvironmentSpots, PlainEnvironmentsHaveNone)
{
    EXPECT_TRUE(split_environment(test::even_sky()).spots.empty());
    EXPECT_TRUE(split_environment(test::image_sky()).spots.empty());  // pixels of 22 degrees
    for (const float value : {0.0f, 1.0f}) {
        EnvironmentLight flat;
        flat.map = make_environment_map(Buffer2D<Spectrum>(128, 64, Spectrum(value)), "flat");
        const EnvironmentParts parts = split_environment(flat);
        EXPECT_TRUE(parts.spots.empty());
        EXPECT_EQ(parts.rest.map, flat.map);  // nothing copied
    }
}

TEST(EnvironmentSpots, PolesAndSinglePixelsAreFine)
{
    for (const int row : {0, 63}) {
        Buffer2D<Spectrum> pixels(128, 64, Spectrum(0.1f));
        pixels.at(127, row) = Spectrum(1e6f);
        EnvironmentLight light;
        light.map = make_environment_map(pixels, "pole");
        const EnvironmentParts parts = split_environment(light);
        ASSERT_EQ(parts.spots.size(), 1u);
        EXPECT_TRUE(is_finite(parts.spots[0].direction));
        const RunningStats stats = test::run_trials(200'000, 11, [&](Rng& rng) {
            const float u_pixel = rng.uniform();
            const LightSample sample = sample_spot(parts, parts.spots[0], u_pixel, rng.uniform2());
            return sample.Li.x / sample.pdf_dir;
        });
        const double exact = static_cast<double>(parts.spots[0].irradiance.x);
        EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 1e-5 * exact);
    }
}

}  // namespace
}  // namespace mote
