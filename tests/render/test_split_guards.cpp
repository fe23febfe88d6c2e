// Lamps around, behind and far from the camera, and pixels that see too much, or too far to the
// right for floats: marks are where lamps are seen, and parts make a whole pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "render/lamp_marks.h"
#include "render/one_pass.h"
#include "render/pixel_parts.h"
#include "support/surface_scene.h"

namespace mote {
namespace {

using test::Pass;

Camera small_camera(int width, int height)
{
    Camera camera;
    camera.width = width;
    camera.height = height;
    camera.tan_half_fov_y = 1.0f;
    return camera;
}

Bounds3 box_around(Vec3 centre, float half)
{
    return {centre - half, centre + half};
}

/// Pixels that are marked.
std::ptrdiff_t count_marks(const LampMarks& marks, const Camera& camera, float share = 1.0f)
{
    Buffer2D<uint8_t> map(camera.width, camera.height, 1);
    marks.mark(4, share, map);
    return std::count(map.begin(), map.end(), uint8_t{4});
}

TEST(LampMarksGuards, LampsAroundTheCameraAreWide)
{
    const Camera camera = small_camera(16, 16);
    LampMarks marks(camera, 0.5f);
    for (const float z : {-0.5f, -1e-30f, 0.0f, 0.5f}) {
        EXPECT_FALSE(marks.add(box_around(Vec3(0.0f, 0.0f, z), 1.0f), 1.0f)) << z;
    }
    EXPECT_EQ(count_marks(marks, camera), 0);
}

TEST(LampMarksGuards, LampsBehindTheCameraMarkNothing)
{
    const Camera camera = small_camera(16, 16);
    LampMarks marks(camera, 0.5f);
    for (const float x : {-0.8f, 0.2f, 1.2f}) {
        EXPECT_TRUE(marks.add(box_around(Vec3(x, 0.3f, 4.0f), 0.01f), 1.0f));
    }
    EXPECT_EQ(count_marks(marks, camera), 0);
}

/// The film has no place for them: a size of 0, infinitely near to the camera's plane.
TEST(LampMarksGuards, PointsBesideTheCameraAreWide)
{
    const Camera camera = small_camera(16, 16);
    LampMarks marks(camera, 0.5f);
    EXPECT_FALSE(marks.add(box_around(Vec3(1.0f, 0.0f, -1e-45f), 0.0f), 1.0f));
    EXPECT_EQ(count_marks(marks, camera), 0);
}

/// Their squares are none.
TEST(LampMarksGuards, LampsOfNextToNoSizeOrLightAreMarked)
{
    const Camera camera = small_camera(16, 16);
    for (const float half : {1e-4f, 1e-7f}) {
        for (const float radiance : {0.0f, 1e-30f, 1.0f}) {
            LampMarks marks(camera, 0.5f);
            EXPECT_TRUE(marks.add(box_around(Vec3(0.3f, 0.3f, -4.0f), half), radiance));
            EXPECT_GE(count_marks(marks, camera), 1) << half << ' ' << radiance;
        }
    }
}

TEST(LampMarksGuards, SmallImagesHaveRoomForOneMark)
{
    const Camera camera = small_camera(2, 2);
    LampMarks marks(camera, 0.5f);
    EXPECT_TRUE(marks.add(box_around(Vec3(0.0f, 0.0f, -4.0f), 1e-3f), 1.0f));
    EXPECT_EQ(count_marks(marks, camera, 1.0f / 16.0f), 1);
}

/// Boards side by side before a wall, of different brightness, all within a pixel.
Scene striped_scene(int width)
{
    Scene scene;
    scene.camera = small_camera(width, 1);
    std::vector<test::Thing> things{
        {test::quad_mesh({-9.0f, -9.0f, -4.0f}, {18.0f, 0.0f, 0.0f}, {0.0f, 18.0f, 0.0f}),
         test::diffuse(Spectrum(0.5f))}};
    for (int i = 0; i < 8; ++i) {
        const float x = -1.0f + 0.25f * static_cast<float>(i);
        things.push_back(
            {test::quad_mesh({x, -1.0f, -1.0f}, {0.2f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}),
             test::diffuse(Spectrum(0.2f), Spectrum(static_cast<float>(1 << i)))});
    }
    test::add_surfaces(scene, std::move(things));
    return scene;
}

float whole(const std::vector<PixelPart>& parts)
{
    return std::accumulate(parts.begin(), parts.end(), 0.0f,
                           [](float sum, const PixelPart& p) { return sum + p.weight; });
}

TEST(PixelPartsGuards, WhatIsTooMuchToTellApartIsOnePart)
{
    Pass pass(striped_scene(1), 1, 1);
    pass.inputs.split.parts = SplitMap(1, 1, 8);
    std::vector<PixelPart> parts;
    for (uint32_t n = 0; n < 50; ++n) {
        const PassKey key{0, 0, n};
        split_pixel(pass.inputs, key, camera_ray(pass.inputs, key), parts);
        EXPECT_EQ(parts.size(), size_t{most_parts});
        EXPECT_NEAR(whole(parts), 1.0f, 1e-6f);
    }
}

/// There the film's points are rounded, some to the end of the pixel.
TEST(PixelPartsGuards, PixelsFarToTheRightAreWhole)
{
    constexpr int width = 60'000;
    Pass pass(striped_scene(width), 1, 1);
    pass.inputs.split.parts = SplitMap(width, 1, 3);
    std::vector<PixelPart> parts;
    int at_end = 0;
    for (uint32_t n = 0; n < 4000; ++n) {
        const PassKey key{width - 1, 0, n};
        at_end += camera_film(pass.inputs, key).x == static_cast<float>(width) ? 1 : 0;
        split_pixel(pass.inputs, key, camera_ray(pass.inputs, key), parts);
        ASSERT_NEAR(whole(parts), 1.0f, 1e-6f) << n;
    }
    EXPECT_GT(at_end, 0);
}

}  // namespace
}  // namespace mote
