#include "restir/surface_forms.h"

namespace mote {
namespace {

using test::SceneCase;

std::vector<Scene> courtyards(int count)
{
    return test::still_frames_of(test::courtyard(true), count);
}

const SceneCase scenes[] = {
    {"still room", test::still_rooms},
    {"camera in a room", test::moving_cameras},
    {"objects in a room", test::moving_objects},
    {"lights in a room", test::changing_lights},
    {"courtyard", courtyards, false},
};

std::vector<test::ReuseCase> surface_cases()
{
    using test::reuse_params;
    const ShiftKind numbers = ShiftKind::RandomNumbers;
    std::vector<test::ReuseCase> cases{
        {"off", reuse_params(ReuseMode::Off, numbers)},
        {"temporal", reuse_params(ReuseMode::Temporal, numbers)},
        {"spatial", reuse_params(ReuseMode::Spatial, numbers)},
        {"both", reuse_params(ReuseMode::Both, numbers)},
        {"auto", reuse_params(ReuseMode::Auto, numbers)},
        {"textbook", make_restir_params(RestirPreset::Textbook)},
    };
    // Few pixels: neighbours that are not alike must be among those that take part.
    for (test::ReuseCase& c : cases) c.params.surface.radius_px = 3.0f;
    return cases;
}

class SurfaceReuseStat : public testing::TestWithParam<SceneCase> {};

/// Five scenes, six ways each, two tests of each: false once in 1600 sets of seeds.
TEST_P(SurfaceReuseStat, HasTheMeanOfThePathTracer)
{
    test::expect_unbiased(GetParam(), surface_cases(), {});
}

class SurfaceReuseLong : public testing::TestWithParam<SceneCase> {};

TEST_P(SurfaceReuseLong, HasTheMeanOfThePathTracer)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    test::expect_unbiased(GetParam(), surface_cases(), {4, 600, 32, 2000});
}

INSTANTIATE_TEST_SUITE_P(Rooms, SurfaceReuseStat, testing::ValuesIn(scenes), test::scene_case_name);
INSTANTIATE_TEST_SUITE_P(Rooms, SurfaceReuseLong, testing::ValuesIn(scenes), test::scene_case_name);

}  // namespace
}  // namespace mote
