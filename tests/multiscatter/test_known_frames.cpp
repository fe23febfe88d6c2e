// What frames know of the light of many events from the frames before, in motion and at rest.

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "render/restir_frame.h"
#include "restir/reuse_scenes.h"
#include "restir/room_scenes.h"
#include "restir/runs.h"

namespace mote {
namespace {

constexpr int max_bounces = 16;

RenderDescription description_of(const Scene& scene, ReuseMode reuse)
{
    const test::TestScene test{"", scene, max_bounces};
    RenderDescription render = test::description(test, EstimatorKind::Restir, 1);
    render.restir.reuse = reuse;
    return render;
}

/// The last of several frames; `history` starts empty.
LayeredImage play(const std::vector<Scene>& frames, const RenderDescription& render,
                  FrameHistory& history)
{
    OutputDescription output;
    output.aovs = test::part_names;
    output.color_type = PixelType::Float;
    LayeredImage image;
    FrameStats stats;
    for (const Scene& scene : frames) {
        image = render_frame(scene, render, output, history, nullptr, stats);
        EXPECT_EQ(stats.dropped_non_finite, 0);
    }
    return image;
}

std::vector<Scene> still_frames(int count)
{
    std::vector<Scene> frames = test::sun_and_sky_frames(1);
    frames.resize(static_cast<size_t>(count), frames[0]);
    for (int i = 0; i < count; ++i) frames[static_cast<size_t>(i)].frame = 1 + i;
    return frames;
}

/// Camera and smoke move and history is reused; or nothing moves, and passes accumulate.
TEST(KnownFramesStat, HaveTheMeanOfThePathTracer)
{
    for (const bool moves : {true, false}) {
        const std::vector<Scene> frames = moves ? test::sun_and_sky_frames(3) : still_frames(3);
        const test::TestScene last{"", frames.back(), max_bounces};
        const TileStats reference = test::reference_runs(last, {32, 1, 24});
        RenderDescription render =
            description_of(frames.back(), moves ? ReuseMode::Both : ReuseMode::Auto);
        const TileStats tested = test::collect(32, 1, [&](uint32_t seed) {
            FrameHistory history;
            render.seed = seed;
            LayeredImage image = play(frames, render, history);
            EXPECT_EQ(history.impl().known->frames, 3);
            return image;
        });
        const RunComparison comparison = compare_runs(tested, reference);
        EXPECT_GT(comparison.p, test::alarm)
            << test::summary(moves ? "moves" : "rests", comparison);
    }
}

/// Where nothing is reused, frames are the same whatever was rendered before.
TEST(KnownFrames, MovingFramesUnderAutoStandAlone)
{
    const std::vector<Scene> frames = test::sun_and_sky_frames(3);
    const RenderDescription render = description_of(frames.back(), ReuseMode::Auto);
    FrameHistory history;
    const LayeredImage played = play(frames, render, history);
    FrameHistory none;
    const LayeredImage alone = play({frames.back()}, render, none);
    const Buffer2D<float>& a = played.channels[0].data;
    const Buffer2D<float>& b = alone.channels[0].data;
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin()));
}

TEST(KnownFrames, AreTheSameForAnyThreadCount)
{
    const std::vector<Scene> frames = test::sun_and_sky_frames(3);
    const RenderDescription render = description_of(frames.back(), ReuseMode::Both);
    std::vector<float> one;
    for (const int threads : {1, 2, 3, 8}) {
        run_with_threads(threads, [&] {
            FrameHistory history;
            const LayeredImage image = play(frames, render, history);
            const Buffer2D<float>& data = image.channels[0].data;
            const std::vector<float> red(data.begin(), data.end());
            if (threads == 1) one = red;
            EXPECT_EQ(red, one) << threads;
        });
    }
}

}  // namespace
}  // namespace mote
