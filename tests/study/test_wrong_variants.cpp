#include <gtest/gtest.h>

#include "restir/reuse_scenes.h"
#include "runs/play_frames.h"
#include "study/study.h"

// Wrong variants of the renderer's picture: mote verify must reject each on the scene meant for it,
// and not the right one.

namespace mote {
namespace {

using Edit = std::function<void(Scene&, RenderDescription&)>;

RenderDescription restir_settings(const Scene& scene)
{
    RenderDescription render;
    render.width = scene.camera.width;
    render.height = scene.camera.height;
    render.samples = 8;
    render.estimator = EstimatorKind::Restir;
    render.restir.reuse = ReuseMode::Off;
    return render;
}

/// Runs of one frame, of which all are the last of a plan without history.
RunSource source_of(Scene scene, const RenderDescription& render)
{
    auto plan = std::make_shared<FramePlan>();
    plan->frames.push_back(std::move(scene));
    auto caches = std::make_shared<PlanCaches>();
    return [plan, caches, render](uint32_t seed) {
        RenderDescription seeded = render;
        seeded.seed = seed;
        LayeredImage last;
        play_frames(*plan, false, seeded, float_output({"volume_direct", "volume_indirect"}),
                    nullptr, render.estimator == EstimatorKind::Restir ? caches.get() : nullptr,
                    [&](size_t, const LayeredImage& image, const FrameStats&) { last = image; });
        return last;
    };
}

RunSource reference_of(const Scene& scene, int samples)
{
    RenderDescription render = restir_settings(scene);
    render.estimator = EstimatorKind::Path;
    render.path.transmittance = TransmittanceKind::Exact;
    render.path.equiangular = true;
    render.samples = samples;
    return source_of(scene, render);
}

StudyParams params_of(double budget)
{
    StudyParams params;
    params.question.budget = budget;
    params.question.tile_budget = 0.2;
    params.question.alpha = 1e-4;  // of the right variants: all of them fail falsely once in 1,500
    params.tile_size = 4;
    params.most_runs = 243;
    return params;
}

/// What a wrong variant makes of the right runs.
Verdict verdict_of(const Scene& scene, const Edit& edit, double budget = 0.02)
{
    Scene edited = scene;
    RenderDescription render = restir_settings(scene);
    edit(edited, render);
    const Study study =
        run_study(source_of(edited, render), reference_of(scene, 64), params_of(budget));
    return study.verdict();
}

Scene puff_in(const std::string& lights)
{
    using namespace test::scene_text;
    return test::frames_of(image(16, 12) + still_camera + puff() + lights, 1).front();
}

void change_nothing(Scene& /*scene*/, RenderDescription& /*render*/) {}

TEST(WrongVariantStat, OneEventTooMany)
{
    const Scene scene = puff_in(test::scene_text::sun_and_sky);
    EXPECT_EQ(verdict_of(scene, change_nothing), Verdict::NoBias);
    const Edit edit = [](Scene&, RenderDescription& render) { render.path.max_bounces = 2; };
    EXPECT_EQ(verdict_of(scene, edit), Verdict::BiasFound);
}

TEST(WrongVariantStat, HalfAVoxelToTheSide)
{
    const Scene scene = puff_in(test::scene_text::sun_and_sky);
    const Edit edit = [](Scene& wrong, RenderDescription&) {
        Volume& volume = wrong.media.volumes[0];
        volume.world_from_object.keys[0].translate += Vec3d(0.5 * 0.07, 0.0, 0.0);
        finalize(volume);
    };
    EXPECT_EQ(verdict_of(scene, edit), Verdict::BiasFound);
}

TEST(WrongVariantStat, PhaseFunctionNotNormalised)
{
    // Normalised to 1.03 instead of 1, which brightens all that is scattered by as much.
    const Scene scene = puff_in(test::scene_text::sun_and_sky);
    const Edit edit = [](Scene& wrong, RenderDescription&) {
        wrong.media.volumes[0].albedo *= 1.03f;
        finalize(wrong.media.volumes[0]);
    };
    EXPECT_EQ(verdict_of(scene, edit), Verdict::BiasFound);
}

TEST(WrongVariantStat, ScatteredLightOnePercentTooBright)
{
    // As of a W that is 1 % too large (test_reuse_faults.cpp has that of a real reservoir).
    const Scene scene = puff_in(test::scene_text::sun_and_sky);
    const RunSource right = source_of(scene, restir_settings(scene));
    const RunSource wrong = [&](uint32_t seed) {
        LayeredImage image = right(seed);
        for (size_t c = 0; c < 3; ++c) {
            Buffer2D<float>& direct = image.channels[4 + c].data;  // behind R, G, B and A
            for (size_t i = 0; i < direct.size(); ++i) {
                image.channels[c].data.data()[i] += 0.01f * direct.data()[i];
                direct.data()[i] *= 1.01f;
            }
        }
        return image;
    };
    const Study study = run_study(wrong, reference_of(scene, 128), params_of(0.003));
    EXPECT_EQ(study.verdict(), Verdict::BiasFound) << study.last().reason;
}

TEST(WrongVariantStat, ClosedFormsWithoutCorrections)
{
    const Scene scene = puff_in(test::scene_text::sun_and_sky);
    const Edit edit = [](Scene&, RenderDescription& render) { render.restir.corrections = false; };
    EXPECT_EQ(verdict_of(scene, edit), Verdict::BiasFound);
}

TEST(WrongVariantStat, RealRendersAgainstThemselvesAreRejectedNoMoreThanAtTheNominalRate)
{
    // 20 studies at 5 %; more than the bound once in 10,000 seeds.
    const Scene scene = puff_in(test::scene_text::two_lamps);
    RenderDescription render = restir_settings(scene);
    render.samples = 1;
    const RunSource source = source_of(scene, render);
    int64_t rejected = 0;
    for (uint32_t i = 0; i < 20; ++i) {
        StudyParams params = params_of(1e-4);
        params.question.alpha = 0.05;
        params.most_runs = 32;
        params.seed = 1 + 1000 * i;
        rejected += run_study(source, source, params).verdict() == Verdict::BiasFound ? 1 : 0;
    }
    EXPECT_LE(rejected, binomial_bound(20, 0.05, 1e-4));
}

}  // namespace
}  // namespace mote
