#include <algorithm>

#include <gtest/gtest.h>

#include "restir/runs.h"

// What a scene does not need is not done: the counters of --stats on scenes that have one thing
// each. What it saves is printed by bench_skips.

namespace mote {
namespace {

using test::TestScene;

constexpr int samples = 2;

FrameStats stats_of(const TestScene& test, FrameHistory& history, int max_bounces = 1)
{
    RenderDescription render = test::description(test, EstimatorKind::Restir, samples);
    render.path.max_bounces = max_bounces;
    FrameStats stats;
    (void)render_frame(test.scene, render, {}, history, nullptr, stats);
    return stats;
}

FrameStats stats_of(const TestScene& test)
{
    FrameHistory history;
    return stats_of(test, history);
}

int64_t passes_of(const TestScene& test)
{
    return int64_t{test.scene.camera.width} * test.scene.camera.height * samples;
}

/// Nothing but smoke that fills part of the image.
TestScene unlit()
{
    return {"unlit", test::lit_clumps(4.0f)};
}

/// Kinds of work on light, each of which only one kind of light calls for.
struct LightWork {
    bool maps = false;
    bool directions = false;
    bool local = false;  ///< list, cells and candidates
    bool emission = false;
};
void expect_work(const TestScene& test, const LightWork& work)
{
    SCOPED_TRACE(test.name);
    const FrameStats stats = stats_of(test);
    EXPECT_EQ(stats.caches.transmittance_maps > 0, work.maps);
    EXPECT_EQ(stats.caches.direction_sets > 0, work.directions);
    EXPECT_EQ(stats.caches.local_lights > 0, work.local);
    EXPECT_EQ(stats.caches.light_cells > 0, work.local);
    EXPECT_EQ(stats.candidates > 0, work.local);
    EXPECT_EQ(stats.emission_integrals > 0, work.emission);
    EXPECT_EQ(stats.light_rays > 0, work.maps || work.directions || work.local);
    EXPECT_EQ(stats.caches_built,
              int{work.maps} + int{work.directions} + int{work.local} + int{work.emission});
}

TEST(Skips, LightsThatASceneLacksCostNothing)
{
    TestScene test = unlit();
    expect_work(test, {});

    test = unlit();
    test.name = "lamp";
    test.scene.lights = {SphereLight{{0.9f, 0.8f, 0.3f}, 0.2f, Spectrum(3.0f)}};
    expect_work(test, {.local = true});

    test = unlit();
    test.name = "sun";
    test.scene.lights = {test::sun()};
    expect_work(test, {.maps = true});

    test = unlit();
    test.name = "sky";
    test.scene.environment = test::even_sky();
    expect_work(test, {.directions = true});

    test = unlit();
    test.name = "flame";
    test.scene.media.volumes.push_back(test::flame());
    expect_work(test, {.local = true, .emission = true});

    // Emission that is switched off.
    test.name = "cold flame";
    test.scene.media.volumes.back().emission_params = {};
    finalize(test.scene.media.volumes.back());
    expect_work(test, {});

    // Black lights are none.
    test = unlit();
    test.name = "black lights";
    test.scene.lights = {DistantLight{Vec3(0.0f, 1.0f, 0.0f), Spectrum(0.0f)},
                         SphereLight{{0.9f, 0.8f, 0.3f}, 0.2f, Spectrum(0.0f)}};
    test.scene.environment = EnvironmentLight{Spectrum(0.0f), nullptr, Mat3(1.0f)};
    expect_work(test, {});
}

TEST(Skips, PartsAreCounted)
{
    TestScene test = test::two_suns();
    test.scene.lights.push_back(PointLight{{0.0f, 2.0f, 0.0f}, Spectrum(1.0f)});
    test.scene.lights.push_back(PointLight{{2.0f, 0.0f, 0.0f}, Spectrum(1.0f)});
    test.scene.media.volumes.push_back(test::flame());
    const FrameStats stats = stats_of(test);
    EXPECT_EQ(stats.caches.transmittance_maps, 2);
    EXPECT_EQ(stats.caches.direction_sets, 0);
    EXPECT_EQ(stats.caches.local_lights, 3);
    EXPECT_EQ(stats.emission_integrals, passes_of(test));
}

/// Every camera ray is either let go by the bounds or tabulated.
TEST(Skips, EmptyPixelsStopAtTheBounds)
{
    TestScene test = test::sun_and_sky();
    const FrameStats filled = stats_of(test);
    EXPECT_GT(filled.camera_rays, 0);
    EXPECT_EQ(filled.camera_rays + filled.missed_rays, passes_of(test));

    // Twelve times the film, the same picture in its middle.
    constexpr int margin = 12;
    test.scene.camera.width *= margin;
    test.scene.camera.height *= margin;
    test.scene.camera.tan_half_fov_y *= margin;
    const FrameStats wide = stats_of(test);
    EXPECT_EQ(wide.camera_rays + wide.missed_rays, passes_of(test));
    // Smoke is as large as before in pixels, up to what is cut off at the borders.
    EXPECT_LT(wide.camera_rays, 3 * filled.camera_rays);
    EXPECT_LT(wide.cells, 3 * filled.cells);
    EXPECT_LT(wide.light_rays, 3 * filled.light_rays);
    EXPECT_GT(wide.missed_rays, passes_of(test) * 9 / 10);

    // Looks away.
    test.scene.camera = test::small_camera({0.0f, 0.0f, 9.0f});
    test.scene.camera.world_from_camera.keys[0].rotate = {0.0, 0.0, 1.0, 0.0};
    const FrameStats away = stats_of(test);
    EXPECT_EQ(away.missed_rays, passes_of(test));
    EXPECT_EQ(away.camera_rays, 0);
    EXPECT_EQ(away.cells, 0);
    EXPECT_EQ(away.caches_built, 0);

    test.scene.media.volumes.clear();
    EXPECT_EQ(stats_of(test).missed_rays, passes_of(test));
}

/// A cube of 48^3 voxels seen along its axis, light from there as well, so that no ray meets the
/// bricks at its sides, where density falls to 0.
TestScene cube(const std::function<float(Vec3)>& density)
{
    TestScene test{"cube", {}};
    test.scene.camera = test::small_camera({0.0f, 0.0f, 30.0f});
    test.scene.camera.tan_half_fov_y = 0.01f;
    Volume volume = test::cube_volume(48, 2.0f, density);
    finalize(volume);
    test.scene.media.volumes = {volume};
    test.scene.lights = {DistantLight{{0.0f, 0.0f, 1.0f}, Spectrum(1.0f)}};
    return test;
}

TEST(Skips, BricksOfOneValueTakeNoCells)
{
    const FrameStats constant = stats_of(cube([](Vec3) { return 1.0f; }));
    const FrameStats varied =
        stats_of(cube([](Vec3 p) { return 1.0f + 0.1f * std::sin(9.0f * p.z); }));
    EXPECT_EQ(varied.uniform_bricks, 0);
    EXPECT_EQ(constant.camera_rays, varied.camera_rays);
    // Six bricks in a row: the last at each end holds a border. A camera ray crosses four others.
    EXPECT_GE(constant.uniform_bricks, 4 * constant.camera_rays);
    // 48 cells in a row, or those of the bricks at the ends.
    EXPECT_GT(varied.cells, 48 * varied.camera_rays);
    EXPECT_LT(2 * constant.cells, varied.cells);
}

TEST(Skips, AnUnchangedFrameBuildsNothing)
{
    TestScene test = test::everything_at_once();
    FrameHistory history;
    const FrameStats first = stats_of(test, history);
    EXPECT_GT(first.caches_built, 0);
    EXPECT_EQ(first.caches_reused, 0);
    test.scene.frame = 2;
    const FrameStats second = stats_of(test, history);
    EXPECT_EQ(second.caches_built, 0);
    EXPECT_EQ(second.caches_reused, first.caches_built);
    EXPECT_EQ(second.caches.light_cells, first.caches.light_cells);
    // One light turns: the others' caches stay.
    std::get<DistantLight>(test.scene.lights[0]).direction = {0.0f, 1.0f, 0.0f};
    const FrameStats third = stats_of(test, history);
    EXPECT_EQ(third.caches_built, 1);
    EXPECT_EQ(third.caches_reused, first.caches_built - 1);
}

TEST(Skips, WhereAMediumGlowsIsFoundAgainOnlyWhenThatChanged)
{
    TestScene test = test::everything_at_once();
    FrameHistory history;
    const FrameStats first = stats_of(test, history);
    const auto glows = [](const Volume& volume) { return volume.emission_params.is_on(); };
    auto& volumes = test.scene.media.volumes;
    const auto flame = std::find_if(volumes.begin(), volumes.end(), glows);
    ASSERT_NE(flame, volumes.end());
    // A flame that brightens sends other power from its bricks: these and the light cells are made
    // anew, and nothing else.
    (flame->emission_params.emission_scale > 0.0f ? flame->emission_params.emission_scale
                                                  : flame->emission_params.blackbody_scale) *= 2.0f;
    const FrameStats second = stats_of(test, history);
    EXPECT_EQ(second.caches_built, 2);
    EXPECT_EQ(second.caches_reused, first.caches_built - 2);
    // One that moves takes its bricks along: they count in its own space.
    for (Trs& key : flame->world_from_object.keys) key.translate.x += 0.01;
    finalize(*flame);
    const FrameStats third = stats_of(test, history);
    EXPECT_EQ(third.caches_reused, 1);
    EXPECT_EQ(third.caches_built, first.caches_built - 1);
}

TEST(Skips, WithoutScatteringThereIsNoWorkOnLight)
{
    const TestScene test = test::everything_at_once();
    FrameHistory history;
    const FrameStats stats = stats_of(test, history, 0);
    EXPECT_EQ(stats.light_rays, 0);
    EXPECT_EQ(stats.candidates, 0);
}

}  // namespace
}  // namespace mote
