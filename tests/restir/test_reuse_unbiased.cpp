#include "restir/hard_reuse_scenes.h"
#include "restir/reuse_judge.h"

namespace mote {
namespace {

using test::expect_unbiased;
using test::SceneCase;

const SceneCase scenes[] = {
    {"still", test::still_frames},
    {"camera", test::moving_camera_frames},
    {"flying", test::flying_smoke_frames},
    {"evolving", test::evolving_smoke_frames},
    {"everything", test::everything_moves_frames},
    {"lights", test::changing_lights_frames},
    {"overlapping", test::overlapping_frames},
    {"lamps", test::lamps_in_smoke_frames},
    {"flame", test::flame_frames},
    {"sun and sky", test::sun_and_sky_frames, false},
    {"burst", test::burst_frames},
    {"flicker", test::flickering_flame_frames, false},
    {"small sun", test::small_sun_frames, false},
    {"thousand lamps", test::thousand_lamps_frames},
    {"sparks", test::sparks_frames},
    {"camera inside", test::camera_inside_frames},
    {"bright inside", test::bright_lamp_inside_frames},
    {"backward", test::backward_frames, false},
    {"forward", test::forward_frames, false},
    {"thin", test::thin_frames},
    {"thick", test::thick_frames},
};

class ReuseScenesStat : public testing::TestWithParam<SceneCase> {};

/// 21 scenes, thirteen ways each, two tests of each: false once in 180 sets of seeds in all.
TEST_P(ReuseScenesStat, HasTheMeanOfThePathTracer)
{
    expect_unbiased(GetParam(), test::all_reuse_cases(), {});
}

class ReuseScenesLong : public testing::TestWithParam<SceneCase> {};

TEST_P(ReuseScenesLong, HasTheMeanOfThePathTracer)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    expect_unbiased(GetParam(), test::all_reuse_cases(), {4, 600, 32, 2000});
}

/// Passes of one frame reuse each other on rays of their own.
TEST(ReuseStat, SeveralPassesOfAFrameKeepTheMean)
{
    expect_unbiased({"passes", test::still_frames}, test::all_reuse_cases(), {1, 20, 32, 100, 6});
}

TEST(ReuseLong, SeveralPassesOfAFrameKeepTheMean)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    expect_unbiased({"passes", test::still_frames}, test::all_reuse_cases(), {1, 500, 32, 2000, 8});
}

/// Histories long enough to be at their most correlated.
TEST(ReuseLong, LongHistoriesKeepTheMean)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    for (const SceneCase& scene : {SceneCase{"still, 40th", test::still_frames},
                                   SceneCase{"smoke, 40th", test::evolving_smoke_frames}}) {
        expect_unbiased(scene, test::all_reuse_cases(), {40, 200, 32, 1000});
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReuseScenesStat, testing::ValuesIn(scenes), test::scene_case_name);
INSTANTIATE_TEST_SUITE_P(Scenes, ReuseScenesLong, testing::ValuesIn(scenes), test::scene_case_name);

}  // namespace
}  // namespace mote
