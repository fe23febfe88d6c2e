// Albedos of exactly 0 and exactly 1, and very many events.
#include <gtest/gtest.h>

#include "stress/play.h"
#include "stress/stress_scenes.h"

namespace mote {
namespace {

TEST(StressAlbedo, BlackSmokeScattersExactlyNothing)
{
    Volume black = test::clumps(6.0f);
    black.albedo = Spectrum(0.0f);
    finalize(black);
    for (const test::Way& way : test::all_ways(1000, 1)) {
        for (const LayeredImage& image :
             test::play(test::repeated(test::lit_by_all(black), 2), way, "albedo 0")) {
            for (const char* part : {"volume_direct.R", "volume_indirect.G"}) {
                for (const float v : image.find(part)->data) EXPECT_EQ(v, 0.0f) << way.name;
            }
            EXPECT_GT(test::mean_of(image, "A"), 0.1) << way.name;
        }
    }
}

TEST(StressAlbedo, OneBlackChannelStaysBlack)
{
    Volume red = test::clumps(6.0f);
    red.albedo = {1.0f, 0.0f, 0.0f};
    finalize(red);
    for (const test::Way& way : test::all_ways(1000, 1)) {
        const LayeredImage image =
            test::play(test::repeated(test::lit_by_all(red), 2), way, "albedo (1, 0, 0)").back();
        EXPECT_GT(test::mean_of(image, "volume_direct.R"), 0.0) << way.name;
        for (const float v : image.find("volume_direct.G")->data) EXPECT_EQ(v, 0.0f) << way.name;
    }
}

TEST(StressAlbedo, WithoutAbsorptionEveryPixelOfTheFurnaceIsOne)
{
    // Scattered rays alone find a constant sky, so the path tracer has no noise: sums of 1000
    // float factors of 1 are 1. 20 free paths across; 1000 events are as good as endless.
    const Scene scene = test::furnace_scene(test::constant_cube(), 10.0f, 0.0f);
    for (const test::Way& way : test::all_ways(1000, 1)) {
        if (way.render.estimator != EstimatorKind::Path) continue;
        const LayeredImage image = test::play(test::repeated(scene, 1), way, "furnace").back();
        for (const float v : image.find("G")->data) EXPECT_NEAR(v, 1.0f, 1e-4f) << way.name;
    }
}

TEST(StressAlbedoStat, ReSTIRKeepsTheFurnaceAtOne)
{
    // Student's test of the mean image of 12 runs, false-alarm rate 1e-5 each; 1e-4 for rounding.
    const Scene scene = test::furnace_scene(test::constant_cube(), 4.0f, 0.0f);
    for (const test::Way& way : test::restir_ways(1000, 1)) {
        const int frames = uses_history(way.render) ? 2 : 1;
        RunningStats means;
        for (uint32_t seed = 1; seed <= 12; ++seed) {
            means.add(test::mean_of(
                test::play(test::repeated(scene, frames), way, "furnace", seed).back(), "G"));
        }
        MeanEstimate off = estimate_mean(means);
        off.mean -= 1.0;
        EXPECT_GT(test_zero(off, 1e-4).p, test::alarm)
            << way.name << " " << means.mean << " +- " << means.standard_error();
        EXPECT_LT(means.standard_error(), 0.03) << way.name;
    }
}

TEST(StressAlbedoStat, OneEventMissingIsRejected)
{
    // Negative control of the test above: at 4 events instead of 1000 the furnace is darker.
    const Scene scene = test::furnace_scene(test::constant_cube(), 4.0f, 0.0f);
    RunningStats means;
    for (uint32_t seed = 1; seed <= 12; ++seed) {
        means.add(test::mean_of(
            test::play(test::repeated(scene, 1), test::restir_ways(4, 1)[0], "furnace", seed)
                .back(),
            "G"));
    }
    MeanEstimate off = estimate_mean(means);
    off.mean -= 1.0;
    EXPECT_LT(test_zero(off, 1e-4).p, test::alarm) << means.mean;
}

}  // namespace
}  // namespace mote
