#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>

#include "restir/room_scenes.h"
#include "restir/runs.h"

namespace mote {
namespace {

using test::TestScene;

struct Variant {
    const char* name;
    RestirParams params;
};

bool has_light_at_infinity(const Scene& scene)
{
    for (const Light& light : scene.lights) {
        if (std::holds_alternative<DistantLight>(light)) return true;
    }
    return scene.environment.has_value();
}

/// Ways to sample the same image.
std::vector<Variant> variants(const Scene& scene)
{
    std::vector<Variant> list{{"defaults", {}}};
    RestirParams few;
    few.candidates = 1;
    few.distant_rays = 1;
    few.environment_rays = 1;
    list.push_back({"one of each", few});
    if (has_light_at_infinity(scene)) {
        RestirParams candidates;
        candidates.control_variate = false;
        list.push_back({"lights at infinity among the candidates", candidates});
    }
    return list;
}

/// Fails where a variant and the path tracer differ; the long form tells what was measured.
void expect_unbiased(const TestScene& scene, const test::Effort& effort, bool tell)
{
    const TileStats reference = test::reference_runs(scene, effort);
    uint32_t seed = 1;
    for (const Variant& variant : variants(scene.scene)) {
        RenderDescription render = test::description(scene, EstimatorKind::Restir, effort.samples);
        render.restir = variant.params;
        render.restir.reuse = ReuseMode::Off;
        const TileStats tested = test::render_runs(scene, render, effort.runs, seed);
        seed += 1000;
        const RunComparison comparison = compare_runs(tested, reference);
        const std::string text = test::summary(scene.name + ", " + variant.name, comparison);
        EXPECT_GT(comparison.p, test::alarm) << text;
        EXPECT_EQ(comparison.non_finite, 0) << text;
        if (tell) std::printf("%s\n", text.c_str());
    }
}

class UnbiasedStat : public testing::TestWithParam<TestScene> {};

TEST_P(UnbiasedStat, AgreesWithThePathTracer)
{
    expect_unbiased(GetParam(), {}, false);
}

class UnbiasedLong : public testing::TestWithParam<TestScene> {};

TEST_P(UnbiasedLong, AgreesWithThePathTracerWithinLittle)
{
    if (!std::getenv("MOTE_LONG_TESTS")) GTEST_SKIP() << "MOTE_LONG_TESTS is not set";
    test::Effort effort;
    effort.runs *= 2;
    effort.samples *= 12;
    effort.reference_samples *= 16;
    expect_unbiased(GetParam(), effort, true);
}

std::string test_name(const testing::TestParamInfo<TestScene>& scene)
{
    std::string name;
    for (const char c : scene.param.name) {
        name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(Rooms, UnbiasedStat, testing::ValuesIn(test::room_scenes()), test_name);
INSTANTIATE_TEST_SUITE_P(Rooms, UnbiasedLong, testing::ValuesIn(test::room_scenes()), test_name);
INSTANTIATE_TEST_SUITE_P(Scenes, UnbiasedStat, testing::ValuesIn(test::all_scenes()), test_name);
INSTANTIATE_TEST_SUITE_P(Scenes, UnbiasedLong, testing::ValuesIn(test::all_scenes()), test_name);

}  // namespace
}  // namespace mote
