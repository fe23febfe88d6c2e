// Light of a constant sky that is left to the paths of many events, that scattered once included.

#include <gtest/gtest.h>

#include "render/indirect_plan.h"
#include "restir/room_scenes.h"
#include "restir/runs.h"

namespace mote {
namespace {

using test::TestScene;

/// 20 x 18 pixels close up: means of rare events are not normal.
TestScene close_up(Scene scene)
{
    scene.camera.width = 20;
    scene.camera.height = 18;
    scene.camera.tan_half_fov_y *= 0.25f;
    return {"", std::move(scene), 8};
}

TestScene courtyard_under_the_sky()
{
    return close_up(test::courtyard(false));
}

TestScene smoke_under_the_sky()
{
    Scene scene = test::lit_clumps(4.0f);
    scene.environment = test::even_sky();
    return close_up(std::move(scene));
}

/// p of ReSTIR against the path tracer. `change` makes the tested one another.
double judge(const TestScene& scene,
             const std::function<void(TestScene&, RenderDescription&)>& change)
{
    const test::Effort effort{32, 2, 16};
    const TileStats reference = test::reference_runs(scene, effort);
    TestScene tested = scene;
    RenderDescription render = test::description(scene, EstimatorKind::Restir, effort.samples);
    change(tested, render);
    EXPECT_TRUE(surface_paths_bring_sky(tested.scene, render) ||
                paths_bring_sky(tested.scene, render) ||
                render.path.light_strategy != LightStrategy::Auto);
    const RunComparison comparison =
        compare_runs(test::render_runs(tested, render, effort.runs, 1), reference);
    EXPECT_EQ(comparison.non_finite, 0);
    return comparison.p;
}

void nothing(TestScene&, RenderDescription&) {}

TEST(SkyByPathsStat, SurfacesGetIt)
{
    EXPECT_GT(judge(courtyard_under_the_sky(), nothing), test::alarm);
}

TEST(SkyByPathsStat, SmokeAloneGetsIt)
{
    EXPECT_GT(judge(smoke_under_the_sky(), nothing), test::alarm);
}

/// Where shadow rays look for the sky, scattered rays bring none of it.
TEST(SkyByPathsStat, ItIsNotLeftToPathsThatUseShadowRays)
{
    const auto with_shadow_rays = [](TestScene&, RenderDescription& render) {
        render.path.light_strategy = LightStrategy::NextEvent;
    };
    EXPECT_GT(judge(courtyard_under_the_sky(), with_shadow_rays), test::alarm);
    EXPECT_GT(judge(smoke_under_the_sky(), with_shadow_rays), test::alarm);
}

/// The negative control: the same effort finds out a sky that is a tenth too bright.
TEST(SkyByPathsStat, TooBrightASkyIsFoundOut)
{
    const auto brighten = [](TestScene& tested, RenderDescription&) {
        tested.scene.environment->radiance *= 1.1f;
    };
    EXPECT_LT(judge(courtyard_under_the_sky(), brighten), test::alarm);
    EXPECT_LT(judge(smoke_under_the_sky(), brighten), test::alarm);
}

}  // namespace
}  // namespace mote
