#include <gtest/gtest.h>

#include <cmath>

#include "core/stats.h"
#include "render/one_pass.h"
#include "render/seen_lamps.h"
#include "support/media.h"
#include "support/surface_scene.h"
#include "volumes/tracking.h"

namespace mote {
namespace {

using test::Pass;

Scene smoky(int size, double distance)
{
    Scene scene;
    scene.camera.width = size;
    scene.camera.height = size;
    scene.camera.tan_half_fov_y = 0.5f;
    scene.camera.world_from_camera.keys[0].translate = Vec3d(0.0, 0.0, distance);
    scene.media.volumes.push_back(test::clumpy_cube());
    scene.media.volumes.back().density_scale = 2.0f;
    test::add_surfaces(
        scene, {{test::quad_mesh({-0.9f, -0.3f, 0.6f}, {1.2f, 0.2f, 0.0f}, {-0.1f, 0.5f, -0.3f}),
                 test::diffuse(Spectrum(0.8f))}});
    return scene;
}

void add_spheres(int count, Scene& scene)
{
    Rng rng(5, 0, Stream::Test, 0, 0);
    for (int i = 0; i < count; ++i) {
        const Vec3 p = 2.0f * rng.uniform3() - 1.0f;
        scene.lights.push_back(SphereLight{{0.6f * p.x, 0.6f * p.y, 0.5f * p.z},
                                           i % 3 == 0 ? 0.15f : 0.02f,
                                           Spectrum(1.0f + p.x, 1.0f, 2.0f)});
    }
}

/// Spheres smaller and larger than a pixel and a quad, in and behind smoke, a board before some.
Scene few_lamps()
{
    Scene scene = smoky(6, 2.0);
    add_spheres(12, scene);
    scene.lights.push_back(QuadLight{
        {-0.4f, 0.1f, -1.0f}, {0.5f, 0.1f, 0.0f}, {-0.1f, 0.5f, 0.0f}, Spectrum(0.7f), true});
    return scene;
}

/// The same through a lens that is not focused on them.
Scene few_blurred_lamps()
{
    Scene scene = few_lamps();
    scene.camera.lens_radius = 0.1f;
    scene.camera.focus_distance = 1.2f;
    return scene;
}

/// Through a camera that turns and travels while the shutter is open, by half a pixel and more.
Scene few_lamps_in_motion()
{
    Scene scene = few_lamps();
    MovingTransform& pose = scene.camera.world_from_camera;
    pose.keys.push_back(pose.keys[0]);
    pose.keys[1].translate += Vec3d(0.2, 0.1, -0.1);
    pose.keys[1].rotate = glm::angleAxis(0.1, glm::normalize(Vec3d(0.3, 1.0, 0.5)));
    return scene;
}

/// More than pixels can list.
Scene crowd()
{
    Scene scene = smoky(4, 2.0);
    add_spheres(120, scene);
    return scene;
}

/// A wide one, looked for at its edges, and narrow ones before and beside it.
Scene wide_and_narrow()
{
    Scene scene = smoky(14, 1.2);
    add_spheres(6, scene);
    scene.lights.push_back(QuadLight{
        {-0.5f, -0.4f, -0.6f}, {1.0f, 0.1f, 0.0f}, {-0.1f, 0.9f, 0.0f}, Spectrum(0.7f), true});
    return scene;
}

/// By one ray: lamps in front of surfaces, with the transmittance to each.
float brought(const Scene& scene, const Ray& ray)
{
    float sum = 0.0f;
    for (const Light& light : scene.lights) {
        const std::optional<LightHit> hit = hit_light(light, ray.o, ray.d);
        if (!hit || is_shadowed(*scene.surfaces, ray, hit->distance)) continue;
        sum +=
            luminance(hit->Le) * std::exp(-optical_depth(scene.media, ray, {0.0f, hit->distance}));
    }
    return sum;
}

struct Means {
    double largest_z = 0.0;
    double variance_ratio = 0.0;  ///< of one ray's over that of a pass, all pixels together
};

/// All that lamps bring to a pixel: those looked for, and those that its own ray meets. `scale`: of
/// what is looked for. Wrong if not 1.
Means compare(const Scene& scene, uint32_t runs, float scale)
{
    Pass pass(scene, 4, 1);
    pass.render.path.max_bounces = 0;
    const Camera& camera = scene.camera;
    Means means;
    double by_rays = 0.0;
    double by_passes = 0.0;
    for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x) {
            std::vector<FilmSample> samples(runs);
            LightRays rays;
            TileRays no_rays;
            std::vector<PathVertex> no_events;
            RunningStats alone;
            PassCounts counts;
            for (uint32_t n = 0; n < runs; ++n) {
                pass.render.seed = 1 + n;
                const auto owner = static_cast<int>(n);
                const PassKey key{x, y, 0};
                look_for_lamps(pass.inputs, key, owner, scale, rays);
                PixelDomain media;
                SurfaceDomain surface;
                make_pixel_domain(pass.domain, camera_ray(pass.inputs, key), media, counts.bins);
                begin_pass(pass.inputs, key, media, owner, surface, no_rays, no_events, samples[n],
                           counts);
                Rng rng(78, 0, Stream::Test, n, static_cast<uint32_t>(y * camera.width + x));
                const Vec2 film = Vec2(x, y) + rng.uniform2();
                const Ray ray = generate_ray(camera, film, rng.uniform2(), rng.uniform());
                alone.add(static_cast<double>(brought(pass.scene, ray)));
            }
            add_seen_lamps(pass.scene, rays, counts.lamps,
                           [&](int of) -> FilmSample& { return samples[static_cast<size_t>(of)]; });
            RunningStats together;
            for (const FilmSample& s : samples) {
                together.add(static_cast<double>(luminance(s.background)));
            }
            const double error = std::sqrt(together.variance_of_mean() + alone.variance_of_mean());
            if (!(error > 0.0)) continue;
            means.largest_z =
                std::max(means.largest_z, std::abs(together.mean - alone.mean) / error);
            by_rays += alone.variance();
            by_passes += together.variance();
        }
    }
    means.variance_ratio = by_rays / by_passes;
    return means;
}

/// 196 pixels at most: 5 standard errors are exceeded once in 9,000 seeds, in one of five scenes
/// once in 2,500. Sixteen strata leave less than a sixteenth of the variance.
TEST(SeenLampsStat, TheirMeanIsThePixels)
{
    const Means few = compare(few_lamps(), 2000, 1.0f);
    EXPECT_LT(few.largest_z, 5.0);
    EXPECT_GT(few.variance_ratio, 16.0);
    EXPECT_GT(compare(few_lamps(), 2000, 0.9f).largest_z, 6.0);
    EXPECT_LT(compare(few_blurred_lamps(), 2000, 1.0f).largest_z, 5.0);
    EXPECT_LT(compare(few_lamps_in_motion(), 2000, 1.0f).largest_z, 5.0);
    const Means many = compare(crowd(), 2000, 1.0f);
    EXPECT_LT(many.largest_z, 5.0);
    EXPECT_GT(many.variance_ratio, 16.0);
    EXPECT_LT(compare(wide_and_narrow(), 500, 1.0f).largest_z, 5.0);
}

/// A lamp of a thousandth of a pixel's area that one ray in a thousand meets.
TEST(SeenLampsStat, TinyLampsMakeLittleNoise)
{
    Scene scene;
    scene.camera.width = scene.camera.height = 9;
    scene.camera.tan_half_fov_y = 0.5f;
    scene.lights.push_back(SphereLight{{0.02f, 0.01f, -1.0f}, 0.002f, Spectrum(1e4f)});
    Pass pass(scene, 4, 1);
    RunningStats found;
    for (uint32_t n = 0; n < 500; ++n) {
        pass.render.seed = 1 + n;
        LightRays rays;
        WalkCounts counts;
        FilmSample sample;
        look_for_lamps(pass.inputs, {4, 4, 0}, 0, 1.0f, rays);
        add_seen_lamps(scene, rays, counts, [&](int) -> FilmSample& { return sample; });
        found.add(static_cast<double>(sample.background.y));
    }
    const double radius_px = 0.002 * 9.0;
    EXPECT_NEAR(found.mean, 1e4 * static_cast<double>(pi) * radius_px * radius_px, 0.5);
    EXPECT_LT(found.variance(), 0.04 * found.mean * found.mean);
}

/// Every ray that meets a lamp goes through its box, and the box is not much larger.
TEST(SeenLamps, BoxesHoldTheLampsTightly)
{
    for (int kind = 0; kind < 3; ++kind) {
        Scene scene = kind == 0   ? few_lamps()
                      : kind == 1 ? few_blurred_lamps()
                                  : few_lamps_in_motion();
        scene.camera.width = scene.camera.height = 60;
        Rng rng(6, 0, Stream::Test, 0, 0);
        int met = 0;
        for (const Light& light : scene.lights) {
            scene.camera.tan_half_fov_y = 2.0f;  // all of them are narrow
            const std::optional<FilmBox> box =
                film_box(scene.camera, shutter_poses(scene.camera), light);
            ASSERT_TRUE(box.has_value());
            FilmBox seen{Vec2(infinity), Vec2(-infinity)};
            for (int i = 0; i < 20000; ++i) {
                const Vec2 film = box->lo - 1.0f + (box->extent() + 2.0f) * rng.uniform2();
                const Ray ray = generate_ray(scene.camera, film, rng.uniform2(), rng.uniform());
                if (!hit_light(light, ray.o, ray.d)) continue;
                ++met;
                seen = {glm::min(seen.lo, film), glm::max(seen.hi, film)};
            }
            EXPECT_GE(seen.lo.x, box->lo.x);
            EXPECT_GE(seen.lo.y, box->lo.y);
            EXPECT_LE(seen.hi.x, box->hi.x);
            EXPECT_LE(seen.hi.y, box->hi.y);
            if (kind > 0) continue;  // few rays through the lens's rim, at the ends of time
            EXPECT_LT(seen.lo.x - box->lo.x, 0.1f + 0.1f * box->extent().x);
            EXPECT_LT(box->hi.y - seen.hi.y, 0.1f + 0.1f * box->extent().y);
        }
        EXPECT_GT(met, 1000);
    }
}

/// Far from the origin rays start where floats have the eye.
TEST(SeenLamps, BoxesHoldLampsThatAreFarFromTheOrigin)
{
    Camera camera;
    camera.width = 1920;
    camera.height = 1080;
    Rng rng(7, 0, Stream::Test, 0, 0);
    for (const Vec3d& eye : {Vec3d(1000.123, 20.2, 3333.3), Vec3d(100.1, 20.2, 333.3)}) {
        for (const bool is_quad : {false, true}) {
            camera.world_from_camera.keys[0].translate = eye;
            const Vec3 at = Vec3(eye) + Vec3(0.3f, 0.2f, -5.0f);
            const Light light =
                is_quad ? Light(QuadLight{at, {0.002f, 0.0f, 0.0f}, {0.0f, 0.002f, 0.0f}, {}, true})
                        : Light(SphereLight{at, 0.001f, {}});
            const std::optional<FilmBox> box = film_box(camera, shutter_poses(camera), light);
            ASSERT_TRUE(box && !box->is_empty());
            int met = 0;
            for (int i = 0; i < 100000; ++i) {
                const Vec2 film = box->lo - 0.5f + (box->extent() + 1.0f) * rng.uniform2();
                const Ray ray = generate_ray(camera, film, Vec2(0.5f), 0.0f);
                if (!hit_light(light, ray.o, ray.d)) continue;
                ++met;
                ASSERT_TRUE(glm::all(glm::greaterThanEqual(film, box->lo)) &&
                            glm::all(glm::lessThanEqual(film, box->hi)));
            }
            EXPECT_GT(met, 1000);
        }
    }
}

TEST(SeenLamps, LampsWithoutABox)
{
    Camera camera;
    const auto box_of = [&](Light light) { return film_box(camera, shutter_poses(camera), light); };
    EXPECT_FALSE(box_of(SphereLight{{0.0f, 0.0f, -1.0f}, 0.5f, {}}));  // wide
    EXPECT_FALSE(box_of(SphereLight{{0.0f, 0.0f, 0.0f}, 1e-6f, {}}));  // around the eye
    EXPECT_FALSE(box_of(SphereLight{{1.0f, 0.0f, 0.0f}, 1e-6f, {}}));  // beside it
    EXPECT_FALSE(box_of(QuadLight{{0.0f, 0.0f, -1.0f}, {0.0f, 0.0f, 2.0f}, {1e-4f, 0.0f, 0.0f}}));
    EXPECT_FALSE(box_of(PointLight{}));
    const std::optional<FilmBox> outside = box_of(SphereLight{{9.0f, 0.0f, -1.0f}, 1e-5f, {}});
    EXPECT_TRUE(outside && outside->is_empty());
    camera.world_from_camera.keys.push_back({});
    camera.world_from_camera.keys.back().translate = Vec3d(0.0, 0.0, -2.0);
    EXPECT_FALSE(box_of(SphereLight{{0.0f, 0.0f, -1.0f}, 1e-6f, {}}));  // it flies through
}

}  // namespace
}  // namespace mote
