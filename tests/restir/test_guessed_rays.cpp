#include <gtest/gtest.h>

#include "clouds.h"
#include "core/sampling.h"
#include "restir/coarse_media.h"
#include "restir/correction_need.h"
#include "restir/guessed_rays.h"
#include "restir/runs.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

using test::TestScene;

constexpr uint32_t number_count = 2048;

/// What a ray brings in the mean over all numbers, and by how much that may be off.
struct Mean {
    double value = 0.0;
    double tolerance = 0.0;
};

/// What a chosen ray adds to its guess, given what it should add and its chance.
using Correction = double (*)(double right, double chance);

double right(double correction, double /*chance*/)
{
    return correction;
}
double without_chance(double correction, double chance)
{
    return correction * chance;
}
double left_out(double /*correction*/, double /*chance*/)
{
    return 0.0;
}

/// Rays of two owners from all over the clouds.
void add_rays(const Media& media, float number, GuessedRays& rays)
{
    const Bounds3 bounds = test::bounds_of(media);
    for (uint32_t i = 0; i < 20; ++i) {
        Rng rng(7, 0, Stream::Test, i, 0);
        const Vec3 x = bounds.lo + rng.uniform3() * bounds.extent();
        const Spectrum weight(1.0f + rng.uniform());
        rays.add(i < 12 ? 3 : 4, x, sample_sphere(rng.uniform2()), 0.5f, weight, infinity, number);
    }
}

/// Means over numbers 0 to 1: the chosen numbers of a ray are an interval as long as its chance, so
/// evenly spread numbers tell its length to two of their distances.
std::vector<Mean> means_of(const Scene& scene, const LightGuess& guess, Correction correction)
{
    std::vector<Mean> means;
    GuessedRays rays;
    for (uint32_t n = 0; n < number_count; ++n) {
        rays.clear();
        add_rays(scene.media, (static_cast<float>(n) + 0.5f) / number_count, rays);
        WalkCounts coarse;
        WalkCounts exact;
        rays.trace(scene, guess, coarse, exact);
        means.resize(rays.size());
        for (size_t i = 0; i < rays.size(); ++i) {
            const auto guessed = static_cast<double>(rays.guesses.value(i).x);
            const auto added = static_cast<double>(rays.values[i].x) - guessed;
            const auto chance =
                static_cast<double>(correction_chance(guess.slope, rays.guesses.depths[i]));
            means[i].value += (guessed + correction(added, chance)) / number_count;
            means[i].tolerance =
                std::max(means[i].tolerance, 2.0 / number_count * std::abs(added)) + 1e-9;
        }
    }
    return means;
}

/// Rays whose mean is not weight * T.
int wrong_rays(const Scene& scene, const LightGuess& guess, Correction correction)
{
    const std::vector<Mean> means = means_of(scene, guess, correction);
    GuessedRays rays;
    add_rays(scene.media, 0.5f, rays);
    WalkCounts counts;
    rays.guesses.trace(scene, counts);
    int wrong = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const auto exact = static_cast<double>(rays.guesses.value(i).x);
        wrong += std::abs(means[i].value - exact) > means[i].tolerance + 1e-5 ? 1 : 0;
    }
    return wrong;
}

Scene clouds()
{
    Scene scene;
    scene.media = test::two_clouds();
    return scene;
}

TEST(GuessedRays, BringExactTransmittanceInTheMeanWhateverIsGuessed)
{
    const Scene scene = clouds();
    Media dense = coarse_media(scene.media, 0.2f);
    for (Volume& volume : dense.volumes) volume.density_scale *= 50.0f;
    Media elsewhere = coarse_media(scene.media, 0.1f);
    elsewhere.volumes.resize(1);
    const LightGuess guesses[] = {{coarse_media(scene.media, 0.2f), 1.0f},
                                  {coarse_media(scene.media, 0.2f), 30.0f},
                                  {Media{}, 1.0f},
                                  {dense, 1.0f},
                                  {elsewhere, 0.0f}};
    for (const LightGuess& guess : guesses) {
        EXPECT_EQ(wrong_rays(scene, guess, right), 0) << &guess - guesses;
    }
}

TEST(GuessedRays, WrongCorrectionsAreFound)
{
    const Scene scene = clouds();
    const LightGuess guess{coarse_media(scene.media, 0.2f), 1.0f};
    EXPECT_GT(wrong_rays(scene, guess, without_chance), 4);
    EXPECT_GT(wrong_rays(scene, guess, left_out), 4);
}

TEST(GuessedRays, FewAreWalkedExactly)
{
    const Scene scene = clouds();
    const LightGuess guess{coarse_media(scene.media, 0.2f), 1.0f};
    GuessedRays rays;
    WalkCounts coarse;
    WalkCounts exact;
    for (int n = 0; n < 100; ++n) {
        rays.clear();
        add_rays(scene.media, 0.01f * static_cast<float>(n), rays);
        rays.trace(scene, guess, coarse, exact);
    }
    // The chance is at most exp(-1/2) / sqrt(2) = 0.43.
    EXPECT_LT(2 * exact.rays, coarse.rays);
    EXPECT_GT(40 * exact.rays, coarse.rays);
}

/// Sun and sky on clumps of many voxels each, which coarser ones show well.
TestScene smooth_clumps()
{
    TestScene test = test::sun_and_sky();
    test.name = "smooth clumps";
    Volume volume = test::clumpy_cube(96);
    volume.density_scale = 6.0f;
    volume.albedo = Spectrum(0.9f, 0.8f, 0.5f);
    volume.phase.g = 0.4f;
    finalize(volume);
    test.scene.media.volumes = {volume};
    return test;
}

TEST(LightGuess, IsMadeWhereCoarseMediaAreGoodEnough)
{
    const Media media = smooth_clumps().scene.media;
    const DirectionTransmittance directions(media);
    const LightGuess guess = make_light_guess(media, directions);
    ASSERT_FALSE(guess.empty());
    EXPECT_NE(guess.media.volumes[0].density, media.volumes[0].density);
    EXPECT_GT(guess.slope, 0.0f);
    EXPECT_LT(guess.slope, 2.5f);
    EXPECT_EQ(guess.slope, make_light_guess(media, directions).slope);
    // Sharp at the size of a voxel, and nothing at all.
    const Media sharp = test::sun_and_sky(100.0f).scene.media;
    EXPECT_TRUE(make_light_guess(sharp, DirectionTransmittance(sharp)).empty());
    EXPECT_TRUE(make_light_guess(Media{}, DirectionTransmittance(Media{})).empty());
}

TEST(LightGuess, StaysWithItsDirections)
{
    TestScene test = smooth_clumps();
    const auto first = make_light_caches(test.scene, {}, nullptr);
    EXPECT_EQ(make_light_caches(test.scene, {}, first)->guess, first->guess);
    test.scene.media.volumes[0].density_scale *= 2.0f;
    EXPECT_NE(make_light_caches(test.scene, {}, first)->guess, first->guess);
}

TEST(GuessedRaysStat, ImagesAgreeWithThePathTracer)
{
    const TestScene test = smooth_clumps();
    const test::Effort effort{32, 6, 100};
    const TileStats reference = test::reference_runs(test, effort);
    const RenderDescription render = test::description(test, EstimatorKind::Restir, effort.samples);
    FrameHistory history;
    FrameStats stats;
    (void)render_frame(test.scene, render, {}, history, nullptr, stats);
    EXPECT_GT(stats.coarse_rays, stats.light_rays);
    const RunComparison comparison =
        compare_runs(test::render_runs(test, render, effort.runs, 1), reference);
    EXPECT_GT(comparison.p, test::alarm) << test::summary(test.name, comparison);
    EXPECT_EQ(comparison.non_finite, 0);
}

TEST(CorrectionNeed, RoulettePreservesTheMean)
{
    for (const float known : {0.0f, 1e-6f, 0.003f, 0.1f, 0.5f, 1.0f, 3.0f, 1e6f, 1e30f}) {
        for (const int usual : {1, 2, 8}) {
            constexpr int steps = 100'000;
            double shares = 0.0;
            double roulette_forgotten = 0.0;
            double counts = 0.0;
            for (int i = 0; i < steps; ++i) {
                const float u = (static_cast<float>(i) + 0.5f) / steps;
                const RayCount rays = rays_needed(usual, known, 0.5f, u);
                ASSERT_GE(rays.count, 0);
                ASSERT_LE(rays.count, 4 * usual + 1);
                shares += static_cast<double>(static_cast<float>(rays.count) * rays.share) / steps;
                roulette_forgotten += (rays.count > 0 ? 1.0 : 0.0) / steps;
                counts += static_cast<double>(rays.count) / steps;
            }
            // The numbers tell a chance of at least 1/16 to 1 in 100,000.
            EXPECT_NEAR(shares, 1.0, 1e-3) << known << " " << usual;
            if (counts < 0.9) {
                EXPECT_LT(roulette_forgotten, 0.95);
            }
        }
    }
}

TEST(CorrectionNeed, WithoutAMeanEveryPixelGetsTheSame)
{
    for (const float u : {0.0f, 0.5f, one_minus_epsilon}) {
        EXPECT_EQ(rays_needed(8, 3.0f, 0.0f, u).count, 8);
        EXPECT_EQ(rays_needed(8, 3.0f, 0.0f, u).share, 0.125f);
    }
}

}  // namespace
}  // namespace mote
