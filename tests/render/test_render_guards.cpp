// Samples that are no numbers, pixels without any, and views of what is opaque, in the way or
// nowhere: images hold numbers, and what is seen is not lost.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "render/film.h"
#include "render/frame.h"
#include "render/motion.h"
#include "render/one_pass.h"
#include "render/surface_pass.h"
#include "support/media.h"
#include "support/surface_scene.h"

namespace mote {
namespace {

using test::Pass;

constexpr float none = std::numeric_limits<float>::quiet_NaN();

TEST(FilmGuards, NoPartOfASampleMayBeNoNumber)
{
    FilmSample good;
    good.direct = Spectrum(4.0f);
    good.collided = good.has_surface = true;
    good.depth = 1.0f;
    good.optical_depth = infinity;  // opaque
    const std::function<void(FilmSample&)> spoilers[] = {
        [](FilmSample& s) { s.surface_direct.z = none; },
        [](FilmSample& s) { s.transmittance = none; },
        [](FilmSample& s) { s.albedo.y = infinity; },
        [](FilmSample& s) { s.motion.x = infinity; },
        [](FilmSample& s) { s.motion.y = none; },
        [](FilmSample& s) { s.optical_depth = none; },
        [](FilmSample& s) { s.reservoir.y = infinity; },
        [](FilmSample& s) { s.normal.x = none; },
        [](FilmSample& s) { s.position.z = infinity; },
        [](FilmSample& s) { s.depth = infinity; },
    };
    PixelFilm pixel;
    EXPECT_TRUE(pixel.add(good));
    for (const auto& spoil : spoilers) {
        FilmSample bad = good;
        spoil(bad);
        EXPECT_FALSE(pixel.add(bad)) << &spoil - spoilers;
        EXPECT_TRUE(is_finite(pixel.mean()));
    }
    good.collided = false;
    good.depth = infinity;
    EXPECT_TRUE(pixel.add(good));
}

TEST(FilmGuards, PixelsWithoutSamplesAreEmpty)
{
    const PixelFilm pixel;
    EXPECT_EQ(pixel.alpha(), 0.0f);
    EXPECT_EQ(pixel.mean(), Spectrum(0.0f));
    for (const AovInfo& info : aov_table()) {
        float values[3] = {};
        pixel.layer(info.aov, values);
        for (const float v : values) EXPECT_TRUE(std::isfinite(v)) << info.name;
    }
}

Scene slab(float density)
{
    Scene scene;
    scene.camera.width = 4;
    scene.camera.height = 4;
    scene.camera.world_from_camera.keys[0].translate = Vec3d(0.0, 0.0, 3.0);
    scene.camera.tan_half_fov_y = 0.2f;
    scene.media.volumes.push_back(test::constant_cube());
    scene.media.volumes.back().density_scale = density;
    return scene;
}

LayeredImage image_of(const Scene& scene, EstimatorKind estimator, std::vector<std::string> aovs)
{
    RenderDescription render;
    render.width = scene.camera.width;
    render.height = scene.camera.height;
    render.samples = 4;
    render.estimator = estimator;
    OutputDescription output;
    output.aovs = std::move(aovs);
    output.color_type = PixelType::Float;
    FrameHistory history;
    FrameStats stats;
    LayeredImage image = render_frame(scene, render, output, history, nullptr, stats);
    EXPECT_EQ(stats.dropped_non_finite, 0);
    return image;
}

TEST(MarchGuards, WhatIsOpaqueHasAnOpticalDepth)
{
    const LayeredImage image = image_of(slab(1e6f), EstimatorKind::March, {"optical_depth"});
    for (const float tau : image.find("opticalDepth.Y")->data) {
        EXPECT_TRUE(std::isfinite(tau));
        EXPECT_GT(tau, 80.0f);
    }
}

TEST(MotionGuards, WhatIsNowhereDoesNotMove)
{
    Scene scene = slab(1.0f);
    scene.next = NextFrame{scene.camera, {scene.media.volumes[0].world_from_object}, {}};
    scene.next->world_from_object[0].keys[0].translate.x += 1.0;
    const Ray ray = generate_ray(scene.camera, Vec2(2.0f), Vec2(0.5f), 0.0f);
    EXPECT_GT(film_motion(scene, ray, 3.0f).x, 1.0f);
    for (const float nowhere : {0.5f, 20.0f}) {
        EXPECT_EQ(film_motion(scene, ray, nowhere), Vec2(0.0f)) << nowhere;
    }
    // But for the camera's own motion.
    scene.next->camera.world_from_camera.keys[0].translate.x += 0.1;
    for (const float nowhere : {0.5f, 20.0f}) {
        const float px = 2.0f / 0.2f * -0.1f / nowhere;
        EXPECT_NEAR(film_motion(scene, ray, nowhere).x, px, 1e-3f * std::abs(px));
    }
    // What the next frame's camera has behind it has no place on its film.
    scene.next->camera.world_from_camera.keys[0].translate.z = -3.0;
    EXPECT_EQ(film_motion(scene, ray, 3.0f), Vec2(0.0f));
    EXPECT_EQ(film_motion(scene, ray, 1.0f), Vec2(0.0f));
}

/// In the wall itself: distances to both are rounded.
TEST(CameraPassGuards, LampsOnWallsAreSeenWhole)
{
    const Vec3 corner(-13.0f, -9.0f, -2.7f);
    const Vec3 u(26.0f, 0.3f, 4.7f);
    const Vec3 v(0.2f, 19.0f, -3.3f);
    Scene scene;
    scene.camera.width = 32;
    scene.camera.height = 32;
    scene.lights = {QuadLight{corner, u, v, Spectrum(1.0f), true}};
    test::add_surfaces(
        scene, {{test::quad_mesh(corner - u - v, 3.0f * u, 3.0f * v), test::diffuse(Spectrum())}});
    for (const EstimatorKind estimator : {EstimatorKind::Path, EstimatorKind::Restir}) {
        const LayeredImage image = image_of(scene, estimator, {});
        for (const float r : image.find("R")->data) EXPECT_NEAR(r, 1.0f, 1e-6f);
    }
}

/// Whatever shadows are in the targets: reservoirs that count have one, and what is known to be in
/// the shadow does not count.
TEST(SurfacePassGuards, ReservoirsOfNoLightAreEmpty)
{
    Scene scene;
    scene.camera.width = 16;
    scene.camera.height = 16;
    scene.camera.tan_half_fov_y = 1.0f;
    scene.lights = {PointLight{Vec3(0.0f, 0.0f, 1.0f), Spectrum(1.0f)}};
    // A board behind the camera is between the lamp and the middle of the wall.
    test::add_surfaces(
        scene, {{test::quad_mesh({-9.0f, -9.0f, -4.0f}, {18.0f, 0.0f, 0.0f}, {0.0f, 18.0f, 0.0f}),
                 test::diffuse(Spectrum(0.5f))},
                {test::quad_mesh({-0.3f, -0.3f, 0.5f}, {0.6f, 0.0f, 0.0f}, {0.0f, 0.6f, 0.0f}),
                 test::diffuse(Spectrum(0.5f))}});
    Pass pass(std::move(scene), 1, 1);
    const Camera& camera = pass.scene.camera;
    for (const SurfaceVisibility visibility :
         {SurfaceVisibility::Exact, SurfaceVisibility::None, SurfaceVisibility::Reused}) {
        pass.domain.params.surface.visibility = visibility;
        Buffer2D<SurfaceDomain> domains(camera.width, camera.height);
        PixelDomain media;
        BinCounts bins;
        for (int y = 0; y < camera.height; ++y) {
            for (int x = 0; x < camera.width; ++x) {
                make_pixel_domain(pass.domain, camera_ray(pass.inputs, {x, y, 0}), media, bins);
                domains.at(x, y) = make_surface_domain(pass.domain, media, 0.5f);
            }
        }
        SurfaceBuffers out;
        out.current = out.next = Buffer2D<PixelReservoir>(camera.width, camera.height);
        out.colors = Buffer2D<Spectrum>(camera.width, camera.height);
        Buffer2D<FilmSample> samples(camera.width, camera.height);
        PassCounts counts;
        fill_surface_reservoirs(pass.inputs, {0, 0, camera.width, camera.height}, 0, domains, out,
                                samples, counts);
        int empty = 0;
        for (const PixelReservoir& p : out.current) {
            empty += p.r.W > 0.0f ? 0 : 1;
            EXPECT_EQ(p.r.W > 0.0f, p.r.p_hat > 0.0f && p.r.V > 0.0f && p.r.W > 0.0f);
        }
        const bool knows_shadows = visibility != SurfaceVisibility::None;
        EXPECT_EQ(empty > 0, knows_shadows);
        EXPECT_LT(empty, 256);
    }
}

}  // namespace
}  // namespace mote
