#include "restir/hard_reuse_scenes.h"
#include "restir/reuse_judge.h"

// Presets, targets that know shadows from caches, and the weights between reservoirs: what is said
// to be unbiased is, and what is said to be biased is seen to be by the very same tests.

namespace mote {
namespace {

using test::expect_unbiased;
using test::JudgeEffort;
using test::ReuseCase;
using test::SceneCase;

ReuseCase preset(const char* name, RestirPreset which)
{
    return {name, make_restir_params(which)};
}

std::vector<ReuseCase> unbiased_presets()
{
    return {preset("default", RestirPreset::Default), preset("textbook", RestirPreset::Textbook)};
}

/// All ways to reuse, with targets from the caches.
std::vector<ReuseCase> cached_cases()
{
    std::vector<ReuseCase> cases = test::all_reuse_cases();
    for (ReuseCase& each : cases) {
        each.name += " cached";
        each.params.visibility = TargetVisibility::Cached;
    }
    return cases;
}

/// Every shift with the weights that `auto` does not take by itself, at rest or in motion.
std::vector<ReuseCase> mis_cases()
{
    std::vector<ReuseCase> cases;
    const std::pair<const char*, ReuseMis> forms[] = {{" pairwise", ReuseMis::Pairwise},
                                                      {" balance", ReuseMis::Balance}};
    for (const ReuseCase& each : test::all_reuse_cases()) {
        if (each.params.reuse != ReuseMode::Temporal && each.params.reuse != ReuseMode::Both) {
            continue;
        }
        for (const auto& [name, mis] : forms) {
            cases.push_back({each.name + name, each.params});
            cases.back().params.mis = mis;
        }
    }
    return cases;
}

/// Sun and sky that nothing changes.
std::vector<Scene> still_sun_and_sky_frames(int count)
{
    using namespace test::scene_text;
    return test::frames_of(image() + still_camera + puff() + sun_and_sky, count);
}

/// The same with smoke of more voxels.
std::vector<Scene> fine_sun_and_sky_frames(int count)
{
    using namespace test::scene_text;
    return test::frames_of(image() + still_camera +
                               "[[volumes]]\nprocedural = { type = \"puff\", voxel_size = 0.03, "
                               "noise = 0.5 }\ndensity_scale = 9\nalbedo = 0.9\nphase = 0.3\n" +
                               sun_and_sky,
                           count);
}

const SceneCase preset_scenes[] = {{"still", test::still_frames},
                                   {"everything", test::everything_moves_frames},
                                   {"lights", test::changing_lights_frames},
                                   {"sun and sky", test::sun_and_sky_frames},
                                   {"still sky", still_sun_and_sky_frames}};

class ReusePresetsStat : public testing::TestWithParam<SceneCase> {};

/// Five scenes, two presets, two tests of each: false once in 5000 sets of seeds. Textbook targets
/// know no lamp's shadow, so single runs are skewed: t-tests of 40 runs would be off.
TEST_P(ReusePresetsStat, UnbiasedOnesHaveTheMeanOfThePathTracer)
{
    expect_unbiased(GetParam(), unbiased_presets(), {4, 320});
}

class ReusePresetsLong : public testing::TestWithParam<SceneCase> {};

TEST_P(ReusePresetsLong, UnbiasedOnesHaveTheMeanOfThePathTracer)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    expect_unbiased(GetParam(), unbiased_presets(), {4, 1000, 32, 2000});
}

/// Caches know the shadows of lights at infinity, so these are among the candidates.
const SceneCase cached_scenes[] = {{"lights", test::changing_lights_frames},
                                   {"sun and sky", test::sun_and_sky_frames, false},
                                   {"still sky", still_sun_and_sky_frames, false},
                                   {"small sun", test::small_sun_frames, false},
                                   {"flicker", test::flickering_flame_frames, false}};

class CachedVisibilityStat : public testing::TestWithParam<SceneCase> {};

/// Five scenes, thirteen ways, two tests of each: false once in 770 sets of seeds.
TEST_P(CachedVisibilityStat, HasTheMeanOfThePathTracer)
{
    expect_unbiased(GetParam(), cached_cases(), {4, 60});
}

class CachedVisibilityLong : public testing::TestWithParam<SceneCase> {};

TEST_P(CachedVisibilityLong, HasTheMeanOfThePathTracer)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    expect_unbiased(GetParam(), cached_cases(), {4, 600, 32, 2000});
}

const SceneCase mis_scenes[] = {{"still", test::still_frames},
                                {"everything", test::everything_moves_frames},
                                {"lights", test::changing_lights_frames}};

class ReuseWeightsStat : public testing::TestWithParam<SceneCase> {};

/// Three scenes, eighteen ways, two tests of each: false once in 900 sets of seeds.
TEST_P(ReuseWeightsStat, HaveTheMeanOfThePathTracer)
{
    expect_unbiased(GetParam(), mis_cases(), {});
}

class ReuseWeightsLong : public testing::TestWithParam<SceneCase> {};

TEST_P(ReuseWeightsLong, HaveTheMeanOfThePathTracer)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    expect_unbiased(GetParam(), mis_cases(), {4, 600, 32, 2000});
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReusePresetsStat, testing::ValuesIn(preset_scenes),
                         test::scene_case_name);
INSTANTIATE_TEST_SUITE_P(Scenes, ReusePresetsLong, testing::ValuesIn(preset_scenes),
                         test::scene_case_name);
INSTANTIATE_TEST_SUITE_P(Scenes, CachedVisibilityStat, testing::ValuesIn(cached_scenes),
                         test::scene_case_name);
INSTANTIATE_TEST_SUITE_P(Scenes, CachedVisibilityLong, testing::ValuesIn(cached_scenes),
                         test::scene_case_name);
INSTANTIATE_TEST_SUITE_P(Scenes, ReuseWeightsStat, testing::ValuesIn(mis_scenes),
                         test::scene_case_name);
INSTANTIATE_TEST_SUITE_P(Scenes, ReuseWeightsLong, testing::ValuesIn(mis_scenes),
                         test::scene_case_name);

/// Must be rejected, with a bias of the documented kind: between `least` and `most` of the mean.
void expect_biased(const SceneCase& scene, const ReuseCase& each, const JudgeEffort& effort,
                   double least, double most)
{
    const test::ReuseVerdict verdict =
        test::judge_reuse(test::judged_scene(scene, effort), each, effort);
    EXPECT_LT(verdict.p, effort.alpha) << verdict.row;
    EXPECT_GT(verdict.bias.relative, least) << verdict.row;
    EXPECT_LT(verdict.bias.relative, most) << verdict.row;
}

/// 1/M weights count inputs that could not have made the sample: darker where domains differ, by
/// 11 % of the light beside a moving camera and 41 % in thick smoke.
TEST(BiasedPresetsStat, ConstantWeightsAreRejected)
{
    const ReuseCase constant = preset("constant", RestirPreset::BiasedConstantMis);
    expect_biased({"camera", test::moving_camera_frames}, constant, {4, 400}, -0.2, -0.04);
    expect_biased({"thick", test::thick_frames}, constant, {4, 100}, -0.6, -0.2);
}

/// Targets without shadows overrate what neighbours could have found: 21 % darker.
TEST(BiasedPresetsStat, ReuseWithoutShadowRaysIsRejected)
{
    expect_biased({"everything", test::everything_moves_frames},
                  preset("no visibility", RestirPreset::BiasedNoVisibility), {4, 100}, -0.3, -0.1);
}

/// Closed forms alone are wrong by what coarse caches do not know. With cache nodes eight voxels
/// apart and smoke of 35 voxels that varies from voxel to voxel this is a few percent.
TEST(BiasedPresetsStat, PreviewIsRejected)
{
    expect_biased({"fine sky", fine_sun_and_sky_frames}, preset("preview", RestirPreset::Preview),
                  {1, 60, 32, 400}, 0.02, 0.15);
}

}  // namespace
}  // namespace mote
