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

constexpr int size = 6;

/// Spheres smaller and larger than a pixel and a quad, in and behind smoke, a board before some.
Scene make_scene()
{
    Scene scene;
    scene.camera.width = size;
    scene.camera.height = size;
    scene.camera.tan_half_fov_y = 0.5f;
    scene.camera.world_from_camera.keys[0].translate = Vec3d(0.0, 0.0, 2.0);
    scene.media.volumes.push_back(test::clumpy_cube());
    scene.media.volumes.back().density_scale = 2.0f;
    Rng rng(5, 0, Stream::Test, 0, 0);
    for (int i = 0; i < 12; ++i) {
        const Vec3 p = 2.0f * rng.uniform3() - 1.0f;
        scene.lights.push_back(SphereLight{{0.6f * p.x, 0.6f * p.y, 0.5f * p.z},
                                           i % 3 == 0 ? 0.15f : 0.02f,
                                           Spectrum(1.0f + p.x, 1.0f, 2.0f)});
    }
    scene.lights.push_back(QuadLight{
        {-0.4f, 0.1f, -1.0f}, {0.5f, 0.1f, 0.0f}, {-0.1f, 0.5f, 0.0f}, Spectrum(0.7f), true});
    test::add_surfaces(
        scene, {{test::quad_mesh({-0.9f, -0.3f, 0.6f}, {1.2f, 0.2f, 0.0f}, {-0.1f, 0.5f, -0.3f}),
                 test::diffuse(Spectrum(0.8f))}});
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

/// `scale`: of what a pass brings. Wrong if not 1.
Means compare(float scale)
{
    constexpr uint32_t runs = 2000;
    Pass pass(make_scene(), 4, 1);
    WalkCounts counts;
    Means means;
    double by_rays = 0.0;
    double by_passes = 0.0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            if (!has_lamp_rays(pass.inputs, {x, y, 0})) continue;
            std::vector<FilmSample> samples(runs);
            LightRays rays;
            RunningStats alone;
            for (uint32_t n = 0; n < runs; ++n) {
                pass.render.seed = 1 + n;
                look_for_lamps(pass.inputs, {x, y, 0}, static_cast<int>(n), scale, rays);
                Rng rng(78, 0, Stream::Test, n, static_cast<uint32_t>(y * size + x));
                const Ray ray =
                    generate_ray(pass.scene.camera, Vec2(x, y) + rng.uniform2(), Vec2(0.5f), 0.0f);
                alone.add(static_cast<double>(brought(pass.scene, ray)));
            }
            add_seen_lamps(pass.scene, rays, counts,
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

/// 36 pixels at most: 4.5 standard errors are exceeded once in 4,000 seeds. Sixteen strata leave
/// less than a sixteenth of the variance.
TEST(SeenLampsStat, TheirMeanIsThePixels)
{
    const Means means = compare(1.0f);
    EXPECT_LT(means.largest_z, 4.5);
    EXPECT_GT(means.variance_ratio, 16.0);
    EXPECT_GT(compare(0.9f).largest_z, 6.0);
}

}  // namespace
}  // namespace mote
