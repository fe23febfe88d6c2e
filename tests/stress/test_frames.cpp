// Very many frames: nothing drifts, nothing grows, nothing breaks.
#include <gtest/gtest.h>

#include "restir/reuse_scenes.h"
#include "restir/steady_runs.h"
#include "stress/play.h"

namespace mote {
namespace {

/// The ways that keep most: what goes wrong in one frame stays longest in them.
std::vector<std::pair<const char*, RestirParams>> keepers()
{
    RestirParams textbook = make_restir_params(RestirPreset::Textbook);
    return {{"numbers", test::reuse_params(ReuseMode::Both, ShiftKind::RandomNumbers, true)},
            {"world", test::reuse_params(ReuseMode::Both, ShiftKind::World, true)},
            {"textbook", textbook}};
}

TEST(StressFramesStat, TwoHundredFramesOfTheTextbookKeepTheMean)
{
    // Other parameters have their sequences in tests/restir.
    const RestirParams textbook = make_restir_params(RestirPreset::Textbook);
    test::expect_steady(test::still_frames(1), textbook, 200);
    test::expect_steady(test::everything_moves_frames(5), textbook, 200);
}

TEST(StressFramesLong, TenThousandFramesKeepTheMean)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    for (const auto& [name, restir] : keepers()) {
        SCOPED_TRACE(name);
        test::expect_steady(test::still_frames(1), restir, 10'000, 1000);
        test::expect_steady(test::everything_moves_frames(5), restir, 10'000, 1000);
    }
}

/// Whole frames as the command line renders them: caches are built and taken over, all layers are
/// written, light of two events. Memory at the end of a cycle must not grow.
void expect_constant_memory(std::vector<Scene> cycle, int frame_count)
{
    const auto length = static_cast<int>(cycle.size());
    const int period = std::max(1, 2 * length - 2);
    for (const auto& [name, restir] : keepers()) {
        test::Way way = test::restir_way(name, restir, 2, 1);
        way.render.width = cycle[0].camera.width;
        way.render.height = cycle[0].camera.height;
        FrameHistory history;
        size_t heap = 0;
        for (int frame = 0; frame < frame_count; ++frame) {
            Scene& scene = cycle[test::to_and_fro(frame, length)];
            scene.frame = frame + 1;
            FrameStats stats;
            const LayeredImage image =
                render_frame(scene, way.render, test::every_layer(), history, nullptr, stats);
            ASSERT_EQ(stats.dropped_non_finite, 0) << name << ", frame " << frame;
            test::expect_sound(image, way.is_signed, name);
            test::expect_sound(history.impl().before, name);
            if (testing::Test::HasFailure()) return;
            if (frame == 4 * period) heap = test::heap_bytes();
            if (frame > 4 * period && frame % period == 0) {
                ASSERT_LT(test::heap_bytes(), heap + 64 * 1024) << name << ", frame " << frame;
            }
        }
    }
}

TEST(StressFrames, MemoryIsConstantAndEveryFrameSound)
{
    expect_constant_memory(test::still_frames(1), 60);
    expect_constant_memory(test::everything_moves_frames(3), 40);
}

TEST(StressFramesLong, MemoryIsConstantAndEveryFrameSound)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    expect_constant_memory(test::still_frames(1), 10'000);
    expect_constant_memory(test::everything_moves_frames(5), 2'000);
}

}  // namespace
}  // namespace mote
