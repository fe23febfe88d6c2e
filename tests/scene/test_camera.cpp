#include <gtest/gtest.h>

#include "core/rng.h"
#include "scene/prepare_camera.h"

namespace mote {
namespace {

CameraDescription tilted_camera()
{
    CameraDescription description;
    description.position = {1.0, 2.0, 6.0};
    description.look_at = {0.3, 0.7, -1.0};
    description.up = {0.1, 1.0, 0.0};
    description.fov = 40.0;
    return description;
}

TEST(Camera, ProjectionInvertsRays)
{
    const Camera camera = make_camera(tilted_camera(), RenderDescription{}, 1.0, 1.0);
    Rng rng(1, 0, Stream::Test, 0, 0);
    for (int i = 0; i < 200; ++i) {
        const Vec2 pixel = rng.uniform2() * Vec2(640.0f, 360.0f);
        const Ray ray = generate_ray(camera, pixel, {0.5f, 0.5f}, 0.0f);
        EXPECT_NEAR(glm::length(ray.d), 1.0f, 1e-6f);
        const auto seen = project(camera, ray.at(0.5f + 10.0f * rng.uniform()), 0.0f);
        ASSERT_TRUE(seen.has_value());
        // Float rounding of the point, 1e-7 of 10 m, is 1e-6 of the 3.6 m wide view of 640 px.
        EXPECT_NEAR(seen->x, pixel.x, 2e-3f);
        EXPECT_NEAR(seen->y, pixel.y, 2e-3f);
    }
    const Ray middle = generate_ray(camera, {320.0f, 180.0f}, {0.5f, 0.5f}, 0.0f);
    EXPECT_FALSE(project(camera, middle.at(-1.0f), 0.0f).has_value());
}

TEST(Camera, LooksAtItsTargetWithUpUpwards)
{
    CameraDescription description;
    description.position = {0.0, 0.0, 5.0};
    description.look_at = {0.0, 0.0, 0.0};
    description.fov = 90.0;
    RenderDescription render;
    render.width = 200;
    render.height = 100;
    const Camera camera = make_camera(description, render, 0.0, 0.0);
    const Ray middle = generate_ray(camera, {100.0f, 50.0f}, {0.5f, 0.5f}, 0.0f);
    EXPECT_NEAR(middle.d.z, -1.0f, 1e-6f);
    // 90 degrees over the height: the upper edge is 45 degrees up, the right one twice as far out.
    const Ray top = generate_ray(camera, {100.0f, 0.0f}, {0.5f, 0.5f}, 0.0f);
    EXPECT_NEAR(top.d.y / -top.d.z, 1.0f, 1e-6f);
    const Ray right = generate_ray(camera, {200.0f, 50.0f}, {0.5f, 0.5f}, 0.0f);
    EXPECT_NEAR(right.d.x / -right.d.z, 2.0f, 1e-6f);
}

TEST(Camera, LensRaysMeetInTheFocusPlane)
{
    CameraDescription description = tilted_camera();
    description.lens_radius = 0.2;
    description.focus_distance = 4.0;
    const Camera camera = make_camera(description, RenderDescription{}, 1.0, 1.0);
    Camera pinhole = camera;
    pinhole.lens_radius = 0.0f;
    const Vec2 pixel(111.0f, 77.0f);
    const Vec3 axis = generate_ray(pinhole, {320.0f, 180.0f}, {0.5f, 0.5f}, 0.0f).d;
    const Ray straight = generate_ray(pinhole, pixel, {0.5f, 0.5f}, 0.0f);
    const Vec3 sharp = straight.at(4.0f / glm::dot(straight.d, axis));
    Rng rng(2, 0, Stream::Test, 0, 0);
    float widest = 0.0f;
    for (int i = 0; i < 100; ++i) {
        const Ray ray = generate_ray(camera, pixel, rng.uniform2(), 0.0f);
        const Vec3 to_sharp = sharp - ray.o;
        EXPECT_LT(glm::length(glm::cross(to_sharp, ray.d)), 1e-5f);
        EXPECT_NEAR(glm::dot(ray.o - straight.o, axis), 0.0f, 1e-5f);
        widest = std::max(widest, glm::length(ray.o - straight.o));
    }
    EXPECT_LE(widest, 0.2f + 1e-5f);
    EXPECT_GT(widest, 0.15f);
}

TEST(Camera, KeysMoveItOverTheShutter)
{
    CameraDescription description;
    description.position = {0.0, 0.0, 5.0};
    for (const double frame : {1.0, 3.0}) {
        CameraKey key;
        key.frame = frame;
        key.position = Vec3d(frame, 0.0, 5.0);
        key.look_at = Vec3d(frame, 0.0, 0.0);
        description.keys.push_back(key);
    }
    CameraKey zoom;
    zoom.frame = 2.0;
    zoom.fov = 20.0;
    description.keys.insert(description.keys.begin() + 1, zoom);

    const Camera camera = make_camera(description, RenderDescription{}, 2.0, 2.5);
    ASSERT_TRUE(camera.world_from_camera.is_moving());
    EXPECT_NEAR(generate_ray(camera, {320.0f, 180.0f}, {0.5f, 0.5f}, 0.0f).o.x, 2.0f, 1e-5f);
    EXPECT_NEAR(generate_ray(camera, {320.0f, 180.0f}, {0.5f, 0.5f}, 0.5f).o.x, 2.25f, 1e-5f);
    EXPECT_NEAR(generate_ray(camera, {320.0f, 180.0f}, {0.5f, 0.5f}, 1.0f).o.x, 2.5f, 1e-5f);
    // A key that leaves a value out does not hold it: the fov has one key and keeps its value.
    EXPECT_NEAR(camera.tan_half_fov_y, std::tan(glm::radians(10.0f)), 1e-6f);
    EXPECT_FALSE(
        make_camera(description, RenderDescription{}, 2.0, 2.0).world_from_camera.is_moving());
    EXPECT_FALSE(
        make_camera(description, RenderDescription{}, 7.0, 7.5).world_from_camera.is_moving());
}

TEST(Camera, FocusesOnItsTargetByDefault)
{
    CameraDescription description;
    description.position = {0.0, 3.0, 4.0};
    EXPECT_NEAR(make_camera(description, RenderDescription{}, 0.0, 0.0).focus_distance, 5.0f,
                1e-6f);
}

}  // namespace
}  // namespace mote
