#include "restir/reuse_judge.h"
#include "restir/room_scenes.h"

namespace mote {
namespace {

using test::RoomState;
using test::SceneCase;

/// Rooms of `count` frames; `state` tells each one's.
std::vector<Scene> rooms(int count, RoomState (*state)(float step))
{
    std::vector<Scene> frames;
    for (int i = 0; i < count; ++i) {
        frames.push_back(test::room(state(static_cast<float>(i))));
        frames.back().frame = 1 + i;
    }
    return frames;
}

/// The same scene, meshes included, in frames of their own: nothing has changed.
std::vector<Scene> still_frames_of(const Scene& scene, int count)
{
    std::vector<Scene> frames(static_cast<size_t>(count), scene);
    for (int i = 0; i < count; ++i) frames[static_cast<size_t>(i)].frame = 1 + i;
    return frames;
}

std::vector<Scene> still_rooms(int count)
{
    return still_frames_of(test::room(), count);
}

std::vector<Scene> moving_cameras(int count)
{
    return rooms(count, [](float step) {
        RoomState state;
        state.camera = {0.5f - 0.25f * step, 0.4f + 0.1f * step, 3.2f - 0.1f * step};
        return state;
    });
}

std::vector<Scene> moving_objects(int count)
{
    return rooms(count, [](float step) {
        RoomState state;
        state.block = {-0.8f + 0.3f * step, -0.7f + 0.1f * step, 0.4f};
        state.block_angle = 0.3 * static_cast<double>(step);
        return state;
    });
}

/// The sphere flies, the panel is switched off and on again.
std::vector<Scene> changing_lights(int count)
{
    return rooms(count, [](float step) {
        RoomState state;
        state.lamp = {1.0f - 0.4f * step, 0.3f, 0.8f};
        state.lamp_radiance = 5.0f + step;
        state.panel = static_cast<int>(step) % 2 == 0 ? 0.5f : 20.0f;
        return state;
    });
}

std::vector<Scene> courtyards(int count)
{
    return still_frames_of(test::courtyard(true), count);
}

const SceneCase scenes[] = {
    {"still room", still_rooms},           {"camera in a room", moving_cameras},
    {"objects in a room", moving_objects}, {"lights in a room", changing_lights},
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
