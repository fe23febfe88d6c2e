// How many rays correct what is known, and those that guess, at the ends of their ranges.
#include <gtest/gtest.h>

#include <cmath>

#include "restir/correction_need.h"
#include "restir/domains.h"
#include "restir/guessed_rays.h"
#include "restir/room_scenes.h"

namespace mote {
namespace {

const Vec3 up(0.0f, 1.0f, 0.0f);

TEST(CorrectionGuards, RaysAreCountedWhateverIsKnown)
{
    for (const float u : {0.0f, 0.5f, one_minus_epsilon}) {
        EXPECT_EQ(rays_needed(8, 0.0f, 0.0f, u).count, 8);
        EXPECT_EQ(rays_needed(8, 1e30f, 1e-30f, u).count, 32);
        EXPECT_GE(rays_needed(16, 0.0f, 1.0f, u).count, 1);
        EXPECT_TRUE(std::isfinite(rays_needed(1, 0.0f, 1.0f, u).share));
    }
}

TEST(CorrectionGuards, WithoutSmokeInViewNothingIsKnown)
{
    Scene scene = test::sun_and_sky().scene;
    Trs pose;
    pose.translate = Vec3d(0.0, 0.0, 50.0);
    pose.rotate = glm::angleAxis(pi, Vec3(0.0f, 1.0f, 0.0f));
    const FrameDomain seen = test::make_domain(scene);
    scene.camera.world_from_camera.keys = {pose};
    FrameDomain unseen = test::make_domain(scene);
    unseen.caches = seen.caches;
    EXPECT_EQ(mean_known_light(unseen), Vec2(0.0f));
}

TEST(CorrectionGuards, DepthsThatMatterAreBounded)
{
    EXPECT_EQ(depth_that_matters(Spectrum(1.0f), 0.0f), 104.0f);
    EXPECT_EQ(depth_that_matters(Spectrum(0.0f), 0.0f), 104.0f);
    EXPECT_EQ(depth_that_matters(Spectrum(1e30f), 1e-30f), 104.0f);
    EXPECT_EQ(depth_that_matters(Spectrum(1e-30f), 1.0f), 18.0f);
    EXPECT_EQ(depth_that_matters(Spectrum(0.0f), 1.0f), 18.0f);
}

TEST(GuessGuards, ChancesAreBounded)
{
    EXPECT_EQ(correction_chance(1.0f, 0.0f), 1.0f / 32.0f);
    EXPECT_EQ(correction_chance(0.0f, 1.0f), 1.0f / 32.0f);
    EXPECT_EQ(correction_chance(1.0f, 1e30f), 1.0f / 32.0f);
    EXPECT_EQ(correction_chance(100.0f, 0.5f), 1.0f);
}

/// Rays that a surface ends bring nothing, and the choice among the rest goes on.
TEST(GuessGuards, RaysBehindSurfacesBringNothing)
{
    Scene scene = test::lit_clumps(2.0f);
    test::add_surfaces(scene, {{test::box_mesh(Vec3(-5.0f), Vec3(5.0f, 1.5f, 5.0f)), {}}});
    LightGuess guess{scene.media, 100.0f};
    GuessedRays rays;
    for (const Vec3& wi : {up, Vec3(0.0f, -1.0f, 0.0f), up}) {
        rays.add(0, Vec3(0.1f), wi, 0.5f, Spectrum(1.0f), infinity, 0.5f);
    }
    // In clear air one of 32 is corrected: that of the second owner.
    rays.add(0, Vec3(0.1f, 1.6f, 0.1f), up, 0.5f, Spectrum(1.0f), infinity, 0.5f);
    rays.add(1, Vec3(0.1f, 1.6f, 0.1f), up, 0.5f, Spectrum(1.0f), infinity, 0.99f);
    WalkCounts counts;
    rays.trace(scene, guess, counts, counts);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(rays.values[static_cast<size_t>(i)], Spectrum(0.0f));
    EXPECT_EQ(rays.corrections.size(), 1u);
    EXPECT_NEAR(rays.values[3].x, 1.0f, 1e-5f);
}

}  // namespace
}  // namespace mote
