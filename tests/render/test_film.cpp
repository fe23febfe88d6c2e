#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/rng.h"
#include "render/film.h"
#include "support/expect_error.h"

namespace mote {
namespace {

FilmSample random_sample(Rng& rng)
{
    FilmSample s;
    s.direct = rng.uniform3();
    s.indirect = 0.1f * rng.uniform3();
    s.emission = 0.2f * rng.uniform3();
    s.background = 3.0f * rng.uniform3();
    s.transmittance = rng.uniform();
    s.collided = rng.uniform() < 0.7f;
    s.depth = 5.0f + rng.uniform();
    s.albedo = rng.uniform3();
    s.motion = rng.uniform2();
    s.optical_depth = 4.0f * rng.uniform();
    return s;
}

TEST(Film, MeanAndVarianceOfTheMeanAgreeWithTheFormula)
{
    // var(mean) = sum (x - mean)^2 / (n (n - 1)), here in two passes.
    constexpr int n = 50;
    PixelFilm pixel;
    std::vector<double> values;
    Rng rng(1, 0, Stream::Test, 0, 0);
    for (int i = 0; i < n; ++i) {
        const FilmSample s = random_sample(rng);
        values.push_back(static_cast<double>(s.L().y));
        EXPECT_TRUE(pixel.add(s));
    }
    double mean = 0.0;
    for (const double v : values) mean += v / n;
    double m2 = 0.0;
    for (const double v : values) m2 += (v - mean) * (v - mean);
    EXPECT_NEAR(pixel.mean().y, mean, 1e-6 * mean);
    EXPECT_NEAR(pixel.variance_of_mean().y, m2 / (n * (n - 1.0)), 1e-6 * m2);
}

TEST(Film, SmallVarianceOnALargeMeanSurvives)
{
    // Alternating 1000 -+ 1/8: sums of squares in float would lose it. var(mean) = (1/64) / (n -
    // 1).
    PixelFilm pixel;
    for (int i = 0; i < 1000; ++i) {
        FilmSample s;
        s.background = Spectrum(i % 2 == 0 ? 999.875f : 1000.125f);
        pixel.add(s);
    }
    EXPECT_NEAR(pixel.variance_of_mean().x, 1.0 / 64.0 / 999.0, 1e-9);
}

TEST(FilmStat, VarianceOfTheMeanPredictsTheSpreadOfMeans)
{
    // 4000 pixels of 16 uniform samples: var(mean) is 1/12/16 on average; the mean of the reported
    // variances has a relative standard error of sqrt(0.8/16/4000) = 0.35 %, 5 of them 1.8 %.
    RunningStats means, variances;
    for (uint32_t p = 0; p < 4000; ++p) {
        PixelFilm pixel;
        for (uint32_t i = 0; i < 16; ++i) {
            FilmSample s;
            s.direct = Spectrum(Rng(2, 0, Stream::Test, p, i).uniform());
            pixel.add(s);
        }
        means.add(static_cast<double>(pixel.mean().x));
        variances.add(static_cast<double>(pixel.variance_of_mean().x));
    }
    EXPECT_NEAR(variances.mean, 1.0 / 192.0, 0.018 / 192.0);
    // Variance of a variance of 4000 near-normal means: relative error sqrt(2/4000) = 2.2 %.
    EXPECT_NEAR(means.variance(), 1.0 / 192.0, 5.0 * 0.0224 / 192.0);
}

TEST(Film, SamplesThatAreNotFiniteCountAsBlack)
{
    PixelFilm pixel;
    FilmSample good;
    good.direct = Spectrum(4.0f);
    FilmSample bad = good;
    bad.indirect.y = std::numeric_limits<float>::quiet_NaN();
    FilmSample infinite = good;
    infinite.background.x = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(pixel.add(good));
    EXPECT_FALSE(pixel.add(bad));
    EXPECT_FALSE(pixel.add(infinite));
    EXPECT_TRUE(pixel.add(good));
    EXPECT_EQ(pixel.count(), 4);
    EXPECT_FLOAT_EQ(pixel.mean().x, 2.0f);
}

TEST(Film, PartsCountByTheirWeights)
{
    FilmSample wall;
    wall.weight = 0.25f;
    wall.surface_direct = Spectrum(4.0f);
    wall.transmittance = 0.0f;
    wall.has_surface = true;
    wall.normal = Vec3(0.0f, 0.0f, 1.0f);
    wall.collided = true;
    wall.on_surface = true;
    wall.depth = 3.0f;
    wall.albedo = Spectrum(0.8f);
    wall.exact_rays = 2.0f;
    FilmSample sky;
    sky.weight = 0.75f;
    sky.background = Spectrum(0.4f);
    sky.exact_rays = 1.0f;
    PixelFilm pixel;
    const FilmSample parts[] = {sky, wall};
    EXPECT_TRUE(pixel.add(parts));
    EXPECT_TRUE(pixel.add(parts));
    EXPECT_EQ(pixel.count(), 2);
    EXPECT_FLOAT_EQ(pixel.mean().x, 1.3f);
    EXPECT_FLOAT_EQ(pixel.variance_of_mean().x, 0.0f);
    EXPECT_FLOAT_EQ(pixel.alpha(), 0.25f);
    const auto layer = [&](Aov aov) {
        float values[3] = {};
        pixel.layer(aov, values);
        return Vec3(values[0], values[1], values[2]);
    };
    EXPECT_FLOAT_EQ(layer(Aov::Direct).x, 1.0f);
    EXPECT_FLOAT_EQ(layer(Aov::Background).y, 0.3f);
    EXPECT_FLOAT_EQ(layer(Aov::Normal).z, 1.0f);
    EXPECT_FLOAT_EQ(layer(Aov::Albedo).x, 0.2f);
    EXPECT_FLOAT_EQ(layer(Aov::Z).x, 3.0f);
    EXPECT_FLOAT_EQ(layer(Aov::Cost).x, 3.0f);  // rays, whatever they stand for
    const FilmSample bad[] = {sky, [&] {
                                  FilmSample s = wall;
                                  s.direct.x = std::numeric_limits<float>::quiet_NaN();
                                  return s;
                              }()};
    EXPECT_FALSE(pixel.add(bad));
    EXPECT_EQ(pixel.count(), 3);
}

TEST(Film, DepthsOfCollisionsOnly)
{
    PixelFilm pixel;
    float values[3];
    pixel.add(FilmSample{});
    pixel.layer(Aov::Z, values);
    EXPECT_EQ(values[0], background_depth);
    pixel.layer(Aov::VolumeZ, values);
    EXPECT_EQ(values[0], background_depth);
    for (const float depth : {7.0f, 5.0f, 6.0f}) {
        FilmSample s;
        s.collided = true;
        s.depth = depth;
        s.albedo = Spectrum(0.8f);
        s.motion = {depth, -1.0f};
        pixel.add(s);
    }
    pixel.layer(Aov::Z, values);
    EXPECT_EQ(values[0], 5.0f);
    pixel.layer(Aov::VolumeZ, values);
    EXPECT_FLOAT_EQ(values[0], 6.0f);
    pixel.layer(Aov::Albedo, values);
    EXPECT_FLOAT_EQ(values[1], 0.75f * 0.8f);  // one of four paths met nothing
    pixel.layer(Aov::Motion, values);
    EXPECT_FLOAT_EQ(values[0], 6.0f);
    EXPECT_FLOAT_EQ(values[1], -1.0f);
    pixel.layer(Aov::Samples, values);
    EXPECT_EQ(values[0], 4.0f);
}

TEST(Film, HoldsWhatWasAskedForAndNothingElse)
{
    const AovSet none;
    Film plain(4, 3, none, PixelType::Half);
    const LayeredImage rgba = plain.take();
    ASSERT_EQ(rgba.channels.size(), 4u);
    EXPECT_EQ(rgba.channels[3].name, "A");
    for (const AovInfo& info : aov_table()) {
        Film film(4, 3, parse_aovs({info.name}), PixelType::Half);
        const LayeredImage image = film.take();
        ASSERT_EQ(image.channels.size(), 4 + info.channels.size()) << info.name;
        for (size_t c = 0; c < info.channels.size(); ++c) {
            EXPECT_EQ(image.channels[4 + c].name, info.channels[c]);
            EXPECT_EQ(image.channels[4 + c].type,
                      info.always_float ? PixelType::Float : PixelType::Half);
        }
    }
}

TEST(Aov, TableIsInTheOrderOfTheEnumWithDistinctNames)
{
    std::set<std::string> names;
    ASSERT_EQ(aov_table().size(), aov_count);
    for (size_t i = 0; i < aov_count; ++i) {
        EXPECT_EQ(static_cast<size_t>(aov_table()[i].aov), i);
        EXPECT_LE(aov_table()[i].channels.size(), 3u);
        EXPECT_TRUE(names.insert(aov_table()[i].name).second);
        for (const std::string& channel : aov_table()[i].channels) {
            EXPECT_TRUE(names.insert("channel " + channel).second);
        }
    }
}

TEST(Aov, UnknownNamesSuggestTheNearest)
{
    expect_error(
        [] {
            (void)parse_aovs({"Z", "albdeo"});
        },
        ExitCode::Input, {"output.aovs", "\"albdeo\"", "did you mean \"albedo\"?"});
    EXPECT_TRUE(parse_aovs({"Z", "albedo"}).has(Aov::Albedo));
    EXPECT_FALSE(parse_aovs({"Z", "albedo"}).has(Aov::Motion));
    EXPECT_TRUE(parse_aovs({"motion"}).needs_motion());
}

}  // namespace
}  // namespace mote
