#include <gtest/gtest.h>

#include "restir/light_caches.h"
#include "restir/runs.h"

namespace mote {
namespace {

using test::TestScene;

TEST(LightCaches, ThereAreNoneWithoutMediaOrLights)
{
    TestScene test = test::everything_at_once();
    test.scene.media.volumes.clear();
    EXPECT_EQ(make_light_caches(test.scene, {}, nullptr)->built, 0);
    test.scene.media.volumes.emplace_back();
    EXPECT_EQ(make_light_caches(test.scene, {}, nullptr)->built, 0);
    test = test::sun_and_sky();
    test.scene.lights.clear();
    test.scene.environment.reset();
    EXPECT_EQ(make_light_caches(test.scene, {}, nullptr)->built, 0);
}

TEST(LightCaches, WhatDidNotChangeIsTakenOver)
{
    TestScene test = test::overlapping();  // a sun, an environment, a lamp
    const auto first = make_light_caches(test.scene, {}, nullptr);
    EXPECT_EQ(first->built, 3);
    EXPECT_EQ(first->reused, 0);
    const auto second = make_light_caches(test.scene, {}, first);
    EXPECT_EQ(second->built, 0);
    EXPECT_EQ(second->reused, 3);
    EXPECT_EQ(second->distant[0].map, first->distant[0].map);

    // Colours and cameras leave them alone.
    std::get<DistantLight>(test.scene.lights[0]).irradiance *= 2.0f;
    test.scene.environment->radiance *= 0.5f;
    test.scene.camera = test::small_camera({2.0f, 0.0f, 2.0f});
    EXPECT_EQ(make_light_caches(test.scene, {}, first)->reused, 3);

    // The lamp moves, the sun turns, the medium changes.
    std::get<PointLight>(test.scene.lights[1]).position.x += 0.1f;
    EXPECT_EQ(make_light_caches(test.scene, {}, first)->built, 1);
    std::get<DistantLight>(test.scene.lights[0]).direction = {0.0f, 1.0f, 0.0f};
    EXPECT_EQ(make_light_caches(test.scene, {}, first)->built, 2);
    test.scene.media.volumes[0].density_scale *= 1.01f;
    EXPECT_EQ(make_light_caches(test.scene, {}, first)->built, 3);
    EXPECT_EQ(make_light_caches(test.scene, {}, first)->reused, 0);
}

}  // namespace
}  // namespace mote
