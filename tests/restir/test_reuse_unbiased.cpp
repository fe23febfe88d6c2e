#include <cstdio>

#include <fmt/format.h>

#include "core/error.h"
#include "restir/reuse_modes.h"
#include "restir/reuse_runs.h"
#include "restir/reuse_scenes.h"

namespace mote {
namespace {

using test::ReuseCase;

/// A scene's frames, of which the last is compared.
struct SceneCase {
    std::string name;
    std::vector<Scene> (*frames)(int count);
    bool control_variate = true;
};

/// For the names of tests.
void PrintTo(const SceneCase& scene, std::ostream* out)
{
    *out << scene.name;
}

/// How sharply to look.
struct Effort {
    int frames = 4;
    int runs = 40;
    int reference_runs = 32;
    int reference_samples = 100;
    int samples = 1;
    double alpha = 1e-5;  ///< false-alarm rate of one comparison
};

/// Plays every way to reuse against the reference path tracer. Observations are whole images and
/// tiles of independent runs; Welch's test of each, corrected for their number.
void expect_unbiased(const SceneCase& scene, const std::vector<ReuseCase>& cases,
                     const Effort& effort)
{
    const std::vector<Scene> frames = scene.frames(effort.frames);
    const test::FrameCaches caches = test::make_frame_caches(frames);
    const double start = process_cpu_seconds();
    const TileStats reference = test::path_traced_runs(frames.back(), effort.reference_samples,
                                                       {effort.reference_runs, 1'000'000});
    const double reference_seconds = process_cpu_seconds() - start;
    for (const ReuseCase& each : cases) {
        RestirParams params = each.params;
        params.control_variate = scene.control_variate;
        const double before = process_cpu_seconds();
        const test::ReuseRuns tested =
            test::play_runs(frames, caches, params, {effort.runs, 1, effort.samples});
        const RunComparison comparison = compare_runs(tested.images, reference);
        const test::Bias bias = test::bias_of(comparison);
        const test::AddedBias added = test::test_added(tested.added, reference);
        const std::string row = fmt::format(
            "{:12} {:18} {:+6.2f} +- {:4.2f} %  z {:+5.2f}  p {:8.2g}   added {:+6.2f} +- {:4.2f} "
            "%  "
            "z {:+5.2f}  p {:8.2g}   {:.1f} s ({:.1f} s)",
            scene.name, each.name, 100.0 * bias.relative, 100.0 * bias.standard_error, bias.z,
            comparison.p, 100.0 * added.whole_image.relative,
            100.0 * added.whole_image.standard_error, added.whole_image.z, added.p,
            process_cpu_seconds() - before, reference_seconds);
        if (std::getenv("MOTE_REPORT")) std::printf("%s\n", row.c_str());
        EXPECT_GT(comparison.p, effort.alpha) << row;
        EXPECT_GT(added.p, effort.alpha) << row;
        EXPECT_EQ(comparison.non_finite, 0) << row;
    }
}

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
};

class ReuseScenesStat : public testing::TestWithParam<SceneCase> {};

/// Twelve scenes, thirteen ways each, two tests of each: false once in 300 sets of seeds in all.
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

std::string name_of(const testing::TestParamInfo<SceneCase>& info)
{
    std::string name = info.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReuseScenesStat, testing::ValuesIn(scenes), name_of);
INSTANTIATE_TEST_SUITE_P(Scenes, ReuseScenesLong, testing::ValuesIn(scenes), name_of);

}  // namespace
}  // namespace mote
