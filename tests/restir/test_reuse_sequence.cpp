#include <cstring>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "restir/reuse_modes.h"
#include "restir/reuse_runs.h"
#include "restir/reuse_scenes.h"
#include "restir/steady_runs.h"

namespace mote {
namespace {

using test::expect_steady;
using test::mean_of;
using test::render_next;

std::vector<Scene> one_still_frame()
{
    return test::still_frames(1);
}

TEST(ReuseSequenceStat, TwoHundredStillFramesKeepTheMean)
{
    expect_steady(one_still_frame(),
                  test::reuse_params(ReuseMode::Both, ShiftKind::RandomNumbers, true), 200);
}

TEST(ReuseSequenceStat, TwoHundredFramesToAndFroKeepTheMean)
{
    expect_steady(test::everything_moves_frames(5),
                  test::reuse_params(ReuseMode::Both, ShiftKind::World, true), 200);
}

TEST(ReuseSequenceLong, AThousandFramesKeepTheMean)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    for (const ShiftKind shift :
         {ShiftKind::RandomNumbers, ShiftKind::World, ShiftKind::Fraction}) {
        for (const bool feedback : {false, true}) {
            const RestirParams restir = test::reuse_params(ReuseMode::Both, shift, feedback);
            expect_steady(one_still_frame(), restir, 1000);
            expect_steady(test::everything_moves_frames(5), restir, 1000);
        }
    }
}

/// As many frames as are given, larger than a tile.
std::vector<Scene> large_frames(int count, const std::string& camera)
{
    using namespace test::scene_text;
    return test::frames_of(image(40, 24) + camera + evolving_puff() + two_lamps + sun_and_sky,
                           count);
}

bool same_bits(const LayeredImage& a, const LayeredImage& b)
{
    if (a.channels.size() != b.channels.size() || a.channels.empty()) return false;
    for (size_t c = 0; c < a.channels.size(); ++c) {
        const Buffer2D<float>& x = a.channels[c].data;
        const Buffer2D<float>& y = b.channels[c].data;
        if (x.size() != y.size()) return false;
        if (std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) != 0) return false;
    }
    return true;
}

TEST(ReuseSequence, IsBitIdenticalForAnyThreadCount)
{
    const std::vector<Scene> frames = large_frames(3, test::scene_text::moving_camera);
    for (const ShiftKind shift : {ShiftKind::RandomNumbers, ShiftKind::World}) {
        RestirParams restir = test::reuse_params(ReuseMode::Both, shift, true);
        restir.candidates = 2;
        std::vector<LayeredImage> first;
        for (const int threads : {1, 2, 3, 8}) {
            std::vector<LayeredImage> images;
            run_with_threads(threads, [&] {
                FrameHistory history;
                for (const Scene& scene : frames) {
                    images.push_back(render_next(scene, restir, 7, history));
                }
            });
            if (threads == 1) first = images;
            for (size_t i = 0; i < images.size(); ++i) {
                EXPECT_TRUE(same_bits(first[i], images[i])) << threads << " frame " << i;
            }
        }
    }
}

/// A frame after a cut is the frame rendered alone.
TEST(ReuseSequence, CutsAreClean)
{
    const RestirParams restir = test::reuse_params(ReuseMode::Both, ShiftKind::World, true);
    const std::vector<Scene> frames = large_frames(2, test::scene_text::still_camera);
    Scene behind = frames[1];
    Trs& pose = behind.camera.world_from_camera.keys[0];
    pose.translate = -pose.translate;
    pose.rotate = glm::angleAxis(3.141592653589793, Vec3d(0.0, 1.0, 0.0));
    Scene smaller = frames[1];
    smaller.camera.width = 24;
    smaller.camera.height = 24;
    Scene empty = frames[1];
    empty.media.volumes.clear();
    for (const Scene& cut : {behind, smaller, empty}) {
        FrameHistory history;
        FrameHistory none;
        (void)render_next(frames[0], restir, 7, history);
        const LayeredImage after = render_next(cut, restir, 7, history);
        EXPECT_TRUE(same_bits(after, render_next(cut, restir, 7, none)));
        // And back again.
        const LayeredImage back = render_next(frames[1], restir, 8, history);
        EXPECT_GT(mean_of(back), 0.0);
    }
    // Without a cut, history does make a difference.
    FrameHistory history;
    FrameHistory none;
    (void)render_next(frames[0], restir, 7, history);
    EXPECT_FALSE(same_bits(render_next(frames[1], restir, 7, history),
                           render_next(frames[1], restir, 7, none)));
}

}  // namespace
}  // namespace mote
