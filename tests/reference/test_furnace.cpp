#include <gtest/gtest.h>

#include "reference/render.h"
#include "scene/environment.h"

namespace mote {
namespace {

// White furnace: without absorption, in a constant environment of radiance 1, radiance is 1 along
// every ray, whatever the medium and its phase function.

const Ray diagonal{Vec3(-3.0f, -2.5f, -2.9f), glm::normalize(Vec3(3.0f, 2.6f, 3.0f)), 0.0f};

Scene furnace(Volume volume, float optical_depth_across, float g, float albedo = 1.0f)
{
    volume.density_scale = 1.0f;
    const float depth = optical_depth(volume, diagonal, {0.0f, infinity});
    volume.density_scale = optical_depth_across / depth;
    volume.phase.g = g;
    volume.albedo = Spectrum(albedo);
    Scene scene;
    scene.media.volumes.push_back(std::move(volume));
    scene.environment = EnvironmentLight{};
    return scene;
}

TEST(Furnace, EveryPathBringsOneWithoutShadowRays)
{
    // Scattered rays alone leave the albedo as a path's only weight: there is no noise at all.
    PathTracerParams params;
    params.max_bounces = 1'000'000;
    for (const Volume& volume : {test::constant_cube(), test::clumpy_cube()}) {
        for (const float depth : {0.1f, 1.0f, 10.0f, 100.0f}) {
            for (const float g : {-0.9f, 0.0f, 0.7f, 0.999f}) {
                const RunningStats stats = test::trace(furnace(volume, depth, g), params, diagonal,
                                                       depth > 50.0f ? 50 : 500, 1);
                EXPECT_NEAR(stats.mean, 1.0, 1e-5) << "depth " << depth << " g " << g;
            }
        }
    }
}

TEST(FurnaceStat, ShadowRaysAndMisBringOne)
{
    // 5 standard errors: a false alarm in 1.7 million seeds per case, 28 cases.
    for (const bool is_image : {false, true}) {
        for (const LightStrategy strategy : {LightStrategy::Mis, LightStrategy::NextEvent}) {
            for (const float depth : {1.0f, 10.0f}) {
                for (const float g : {-0.6f, 0.0f, 0.6f, 0.9f}) {
                    if (g > 0.8f && strategy == LightStrategy::NextEvent)
                        continue;  // too noisy to tell
                    PathTracerParams params;
                    params.max_bounces = 1'000'000;
                    params.light_strategy = strategy;
                    Scene scene = furnace(test::clumpy_cube(), depth, g);
                    if (is_image)
                        scene.environment->map =
                            make_environment_map(Buffer2D<Spectrum>(8, 4, Spectrum(1.0f)), "white");
                    const RunningStats stats = test::trace(scene, params, diagonal, 10'000, 2);
                    EXPECT_LT(test::z_score(stats, 1.0), 5.0)
                        << stats.mean << " depth " << depth << " g " << g;
                    EXPECT_LT(stats.standard_error(), 0.05);
                }
            }
        }
    }
}

TEST(FurnaceStat, OneEventFewerIsRejected)
{
    // Negative control: dropping what comes after 20 events at depth 10 must not pass.
    PathTracerParams params;
    params.max_bounces = 20;
    params.light_strategy = LightStrategy::Mis;
    const RunningStats stats =
        test::trace(furnace(test::clumpy_cube(), 10.0f, 0.0f), params, diagonal, 10'000, 3);
    EXPECT_GT(test::z_score(stats, 1.0), 5.0);
    EXPECT_LT(stats.mean, 1.0);
}

TEST(FurnaceStat, DoubleCountingTheEnvironmentIsRejected)
{
    // Negative control: shadow rays and scattered rays without MIS weights count it twice.
    const Scene scene = furnace(test::clumpy_cube(), 1.0f, 0.0f);
    PathTracerParams params;
    params.max_bounces = 1'000'000;
    const LightSampler no_lights = build_light_sampler(scene, params);
    params.light_strategy = LightStrategy::Mis;
    const LightSampler lights = build_light_sampler(scene, params);
    RunningStats doubled;
    for (uint32_t i = 0; i < 10'000; ++i) {
        PathTracerParams separate = params;
        separate.light_strategy = LightStrategy::NextEvent;
        Rng a(4, 0, Stream::Test, i, 0);
        Rng b(5, 0, Stream::Test, i, 0);
        const PathResult by_shadow_ray = trace_path(scene, lights, separate, diagonal, a);
        const PathResult by_scattering = trace_path(scene, no_lights, params, diagonal, b);
        doubled.add(static_cast<double>(
            (by_shadow_ray.L() + by_scattering.direct + by_scattering.indirect).x));
    }
    EXPECT_GT(test::z_score(doubled, 1.0), 5.0);
}

TEST(FurnaceStat, RouletteAndCountingAreUnbiasedWithAbsorption)
{
    // Two paths to the same expectation: roulette from the first event and none for 200 events.
    const Scene scene = furnace(test::clumpy_cube(), 8.0f, 0.3f, 0.8f);
    PathTracerParams with;
    with.max_bounces = 1'000'000;
    with.roulette_start = 0;
    PathTracerParams without = with;
    without.roulette_start = 200;
    const RunningStats a = test::trace(scene, with, diagonal, 60'000, 6);
    const RunningStats b = test::trace(scene, without, diagonal, 30'000, 7);
    EXPECT_LT(test::z_score(a, b), 5.0) << a.mean << " " << b.mean;
    EXPECT_LT(a.standard_error(), 0.01 * a.mean);
    EXPECT_LT(a.mean, 1.0);
}

TEST(FurnaceStat, AMediumInEquilibriumWithItsSurroundingsIsInvisible)
{
    // Emission (1 - albedo) sigma_t B beside an environment B: radiance is B everywhere.
    for (const LightStrategy strategy :
         {LightStrategy::Auto, LightStrategy::Mis, LightStrategy::Phase}) {
        Scene scene = furnace(test::clumpy_cube(), 5.0f, 0.4f, 0.7f);
        Volume& volume = scene.media.volumes[0];
        volume.emission = volume.density;
        volume.emission_params.emission_scale = 0.3f * volume.density_scale;
        PathTracerParams params;
        params.max_bounces = 1'000'000;
        params.light_strategy = strategy;
        const RunningStats stats = test::trace(scene, params, diagonal, 20'000, 8);
        EXPECT_LT(test::z_score(stats, 1.0), 5.0) << stats.mean << " +- " << stats.standard_error();
        EXPECT_LT(stats.standard_error(), 0.02);
    }
}

TEST(FurnaceStat, OverlappingMediaBringOne)
{
    Scene scene = furnace(test::clumpy_cube(), 3.0f, 0.5f);
    Volume other = test::constant_cube();
    other.density_scale = 0.8f;
    other.phase.g = -0.3f;
    other.world_from_object.keys[0].translate = Vec3d(0.4, 0.1, -0.3);
    other.world_from_object.keys[0].rotate =
        glm::angleAxis(0.6, glm::normalize(Vec3d(1.0, 2.0, 0.5)));
    other.world_from_object.keys[0].scale = Vec3d(1.3, 0.7, 0.9);
    scene.media.volumes.push_back(other);
    for (const LightStrategy strategy : {LightStrategy::Auto, LightStrategy::Mis}) {
        PathTracerParams params;
        params.max_bounces = 1'000'000;
        params.light_strategy = strategy;
        const RunningStats stats = test::trace(scene, params, diagonal, 5'000, 9);
        EXPECT_LT(test::z_score(stats, 1.0), strategy == LightStrategy::Auto ? 1e30 : 5.0);
        EXPECT_NEAR(stats.mean, 1.0, strategy == LightStrategy::Auto ? 1e-5 : 0.05);
    }
}

}  // namespace
}  // namespace mote
