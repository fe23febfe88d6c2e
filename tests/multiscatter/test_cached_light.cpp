// Images whose light of many events corrects a cache of radiance, against the path tracer.

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "restir/room_scenes.h"
#include "restir/runs.h"

namespace mote {
namespace {

using test::TestScene;

RenderDescription cached(const TestScene& scene, int samples)
{
    RenderDescription render = test::description(scene, EstimatorKind::Restir, samples);
    render.restir.indirect = IndirectLight::Cached;
    return render;
}

constexpr test::Effort effort{32, 2, 8};

/// Close up, so that smoke fills the tiles: means of rare events are not normal.
TestScene close_up(TestScene scene, int max_bounces)
{
    scene.max_bounces = max_bounces;
    scene.scene.camera.width = 12;
    scene.scene.camera.height = 10;
    scene.scene.camera.tan_half_fov_y *= 0.25f;
    return scene;
}

TEST(CachedLightStat, ImagesAgreeWithThePathTracer)
{
    for (const TestScene& scene :
         {close_up(test::sun_and_sky(), 6), close_up({"courtyard", test::courtyard(true)}, 4)}) {
        const RunComparison comparison =
            compare_runs(test::render_runs(scene, cached(scene, 2), effort.runs, 1),
                         test::reference_runs(scene, effort));
        EXPECT_GT(comparison.p, test::alarm) << test::summary(scene.name, comparison);
        EXPECT_EQ(comparison.non_finite, 0) << scene.name;
    }
}

/// The negative control: the same effort finds out an event too few.
TEST(CachedLightStat, OneEventTooFewIsFoundOut)
{
    TestScene scene = close_up(test::sun_and_sky(), 3);
    const TileStats reference = test::reference_runs(scene, effort);
    scene.max_bounces = 2;
    const TileStats tested = test::render_runs(scene, cached(scene, 2), effort.runs, 1);
    EXPECT_LT(compare_runs(tested, reference).p, test::alarm);
}

/// Albedo 1 in an even environment: radiance 1 everywhere, whatever the smoke.
TEST(CachedLightStat, WhiteFurnaceStaysWhite)
{
    for (const float g : {0.0f, 0.85f}) {
        TestScene furnace = close_up({"furnace", test::lit_clumps(8.0f)}, 100'000);
        furnace.scene.media.volumes[0].albedo = Spectrum(1.0f);
        furnace.scene.media.volumes[0].phase = {g};
        furnace.scene.environment = EnvironmentLight{Spectrum(1.0f), nullptr, Mat3(1.0f)};
        RenderDescription render = cached(furnace, 1);
        RunningStats means;
        for (uint32_t seed = 1; seed <= 32; ++seed) {
            render.seed = seed;
            FrameHistory history;
            FrameStats stats;
            OutputDescription output;
            output.color_type = PixelType::Float;
            const LayeredImage image =
                render_frame(furnace.scene, render, output, history, nullptr, stats);
            double sum = 0.0;
            const Buffer2D<float>& green = image.channels[1].data;
            for (size_t i = 0; i < green.size(); ++i) sum += static_cast<double>(green.data()[i]);
            means.add(sum / static_cast<double>(green.size()));
        }
        const MeanEstimate mean = estimate_mean(means);
        // False alarms: 1e-5 each.
        EXPECT_TRUE(confidence_interval(mean, 1.0 - 1e-5).contains(1.0))
            << mean.mean << " +- " << mean.standard_error();
        EXPECT_LT(mean.standard_error(), 0.04);
    }
}

TEST(CachedLight, ImagesAreTheSameForAnyThreadCount)
{
    const TestScene scene = close_up(test::sun_and_sky(), 8);
    const RenderDescription render = cached(scene, 2);
    const auto red = [](const LayeredImage& image) {
        const Buffer2D<float>& data = image.channels[0].data;
        return std::vector<float>(data.data(), data.data() + data.size());
    };
    std::vector<float> one;
    for (const int threads : {1, 2, 3, 8}) {
        run_with_threads(threads, [&] {
            FrameHistory history;
            FrameStats stats;
            const LayeredImage image =
                render_frame(scene.scene, render, {}, history, nullptr, stats);
            if (threads == 1) one = red(image);
            EXPECT_EQ(red(image), one) << threads;
        });
    }
}

}  // namespace
}  // namespace mote
