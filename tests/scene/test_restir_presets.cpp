#include <gtest/gtest.h>

#include <array>

#include "scene/estimator_text.h"
#include "support/scene_files.h"

namespace mote {
namespace {

RestirParams preset(const std::string& name, const std::string& more = "",
                    const std::vector<std::string>& overrides = {})
{
    return test::load_text("[render.restir]\npreset = \"" + name + "\"\n" + more, overrides)
        .render.restir;
}

void expect_same(const RestirParams& a, const RestirParams& b)
{
    EXPECT_EQ(a.reuse, b.reuse);
    EXPECT_EQ(a.candidates, b.candidates);
    EXPECT_EQ(a.control_variate, b.control_variate);
    EXPECT_EQ(a.distant_rays, b.distant_rays);
    EXPECT_EQ(a.environment_rays, b.environment_rays);
    EXPECT_EQ(a.surface.indirect_paths, b.surface.indirect_paths);
    EXPECT_EQ(a.indirect_paths, b.indirect_paths);
    EXPECT_EQ(a.corrections, b.corrections);
    EXPECT_EQ(a.shift, b.shift);
    EXPECT_EQ(a.mis, b.mis);
    EXPECT_EQ(a.visibility, b.visibility);
    EXPECT_EQ(a.temporal.cap, b.temporal.cap);
    EXPECT_EQ(a.temporal.validation, b.temporal.validation);
    EXPECT_EQ(a.spatial.neighbours, b.spatial.neighbours);
    EXPECT_EQ(a.spatial.radius_px, b.spatial.radius_px);
    EXPECT_EQ(a.spatial.feedback, b.spatial.feedback);
    EXPECT_EQ(a.surface.mis, b.surface.mis);
    EXPECT_EQ(a.surface.visibility, b.surface.visibility);
}

TEST(RestirPresets, DefaultIsWhatASceneWithoutOneHas)
{
    expect_same(preset("default"), test::load_text("").render.restir);
    expect_same(preset("default"), {});
}

/// 4 candidates, cached target, cap 20, 5 neighbours, everything among the candidates.
TEST(RestirPresets, TextbookIsThePapersConfiguration)
{
    RestirParams expected;
    expected.reuse = ReuseMode::Both;
    expected.candidates = 4;
    expected.control_variate = false;
    expected.shift = ShiftKind::World;
    expected.visibility = TargetVisibility::Cached;
    expected.temporal.cap = 20.0f;
    expected.temporal.validation = 0.0f;
    expected.spatial.neighbours = 5;
    expected.spatial.radius_px = 10.0f;
    expected.spatial.feedback = true;
    const RestirParams textbook = preset("textbook");
    EXPECT_EQ(textbook.preset, RestirPreset::Textbook);
    expect_same(textbook, expected);
}

TEST(RestirPresets, PreviewLeavesOutCorrectionsAlone)
{
    RestirParams expected;
    expected.corrections = false;
    const RestirParams preview = preset("preview");
    EXPECT_EQ(preview.preset, RestirPreset::Preview);
    expect_same(preview, expected);
}

TEST(RestirPresets, BiasedOnesDifferInOneThing)
{
    RestirParams expected;
    expected.reuse = ReuseMode::Both;
    expected.candidates = 4;
    expected.visibility = TargetVisibility::None;
    EXPECT_EQ(preset("biased-no-visibility").preset, RestirPreset::BiasedNoVisibility);
    expect_same(preset("biased-no-visibility"), expected);

    expected.visibility = TargetVisibility::Exact;
    expected.shift = ShiftKind::World;
    expected.mis = ReuseMis::Constant;
    EXPECT_EQ(preset("biased-constant-mis").preset, RestirPreset::BiasedConstantMis);
    expect_same(preset("biased-constant-mis"), expected);

    RestirParams surfaces;
    surfaces.reuse = ReuseMode::Both;
    surfaces.surface.visibility = SurfaceVisibility::Reused;
    expect_same(preset("biased-reused-visibility"), surfaces);
    surfaces.surface.visibility = SurfaceVisibility::Weighted;
    expect_same(preset("biased-weighted-visibility"), surfaces);
    surfaces.surface.mis = ReuseMis::Contribution;
    expect_same(preset("biased-weighted-visibility", "surface = { mis = \"contribution\" }\n"),
                surfaces);
}

TEST(RestirPresets, BiasedOnesAreKnownToBe)
{
    for (const char* name : {"biased-no-visibility", "biased-constant-mis",
                             "biased-reused-visibility", "biased-weighted-visibility", "preview"}) {
        EXPECT_FALSE(is_unbiased(preset(name))) << name;
    }
    for (const char* name : {"default", "textbook"}) EXPECT_TRUE(is_unbiased(preset(name))) << name;
}

TEST(RestirPresets, KeysGivenBesidesWin)
{
    RestirParams expected = make_restir_params(RestirPreset::Textbook);
    expected.candidates = 9;
    expected.temporal.cap = 5.0f;
    const std::string more = "candidates = 9\ntemporal = { cap = 5 }\n";
    expect_same(preset("textbook", more), expected);

    // On the command line as well, whatever the order.
    expected.mis = ReuseMis::Balance;
    expect_same(
        preset("default", more, {"render.restir.mis=balance", "render.restir.preset=textbook"}),
        expected);
}

/// What images say of themselves.
TEST(RestirPresets, EstimatorTextsTellReuseAndWhyImagesAreBiased)
{
    const auto text_of = [](const std::string& preset, const std::string& more = "") {
        return estimator_text(test::load_text("[render]\nestimator = \"restir\"\n[render.restir]\n"
                                              "preset = \"" +
                                              preset + "\"\n" + more)
                                  .render);
    };
    RenderDescription path;
    path.estimator = EstimatorKind::Path;
    EXPECT_EQ(estimator_text(path), "path, unbiased");
    EXPECT_EQ(estimator_text({}), "restir, reuse auto, unbiased");
    EXPECT_EQ(text_of("default"), "restir, reuse auto, unbiased");
    EXPECT_EQ(text_of("textbook"), "restir, reuse both, unbiased");
    EXPECT_EQ(text_of("default", "reuse = \"temporal\"\n"), "restir, reuse temporal, unbiased");
    EXPECT_EQ(text_of("preview"), "restir, reuse auto, biased: corrections = false");
    EXPECT_EQ(text_of("biased-no-visibility"), "restir, reuse both, biased: visibility = none");
    EXPECT_EQ(text_of("biased-constant-mis"),
              "restir, reuse both, biased: mis = constant, surface.mis = constant");
    EXPECT_EQ(text_of("biased-reused-visibility"),
              "restir, reuse both, biased: surface.visibility = reused");
    EXPECT_EQ(text_of("biased-weighted-visibility"),
              "restir, reuse both, biased: surface.visibility = weighted");
    EXPECT_EQ(text_of("biased-constant-mis", "reuse = \"off\"\n"), "restir, reuse off, unbiased");
    EXPECT_EQ(text_of("default", "indirect_reuse = \"both\"\n"),
              "restir, reuse auto, paths reused, unbiased");
    EXPECT_EQ(text_of("default",
                      "indirect_reuse = \"temporal\"\nindirect_suffix = \"biased-validated\"\n"),
              "restir, reuse auto, paths reused, biased: indirect_suffix = biased-validated");
}

TEST(RestirPresets, ImagesCallThemselvesBiasedExactlyWhereTheyAre)
{
    RenderDescription render;
    render.estimator = EstimatorKind::Restir;
    RestirParams& p = render.restir;
    for (int bits = 0; bits < 5 * 2 * 3 * 4 * 2; ++bits) {
        int rest = bits;
        const auto take = [&](int count) {
            const int value = rest % count;
            rest /= count;
            return value;
        };
        p.reuse = static_cast<ReuseMode>(take(5));
        p.visibility = take(2) == 0 ? TargetVisibility::Exact : TargetVisibility::None;
        p.mis = std::array{ReuseMis::Auto, ReuseMis::Pairwise,
                           ReuseMis::Constant}[static_cast<size_t>(take(3))];
        p.indirect_reuse = static_cast<IndirectReuse>(take(4));
        p.indirect_suffix = static_cast<IndirectSuffix>(take(2));
        const bool says_biased = estimator_text(render).find("unbiased") == std::string::npos;
        EXPECT_EQ(says_biased, !is_unbiased(p)) << estimator_text(render);
    }
}

TEST(RestirPresets, UnknownOnesAreNamedWithThoseThereAre)
{
    const std::string problems = test::problems_of("[render.restir]\npreset = \"textbok\"\n");
    EXPECT_NE(problems.find("scene.toml:2:"), std::string::npos) << problems;
    for (const char* name :
         {"default", "textbook", "preview", "biased-no-visibility", "biased-constant-mis"}) {
        EXPECT_NE(problems.find(name), std::string::npos) << problems;
    }
}

}  // namespace
}  // namespace mote
