#include <gtest/gtest.h>

#include "march/march.h"
#include "support/media.h"

namespace mote {
namespace {

constexpr Interval everything{0.0f, infinity};

/// A volume under one light.
Scene scene_of(Volume volume, const Light& light)
{
    Scene scene;
    volume.albedo = Spectrum(0.8f);
    finalize(volume);
    scene.media.volumes.push_back(std::move(volume));
    scene.lights.push_back(light);
    return scene;
}

double marched(const Scene& scene, const Ray& ray, const MarchParams& params)
{
    return double{Marcher(scene, params).march(ray).direct.x};
}

/// Steps and grid of 2, 1, 1/2, ... voxels.
MarchParams refined(int level)
{
    MarchParams params;
    params.step = std::ldexp(2.0f, -level);
    params.shadow_spacing = std::ldexp(2.0f, -level);
    return params;
}

/// Light scattered once, by the midpoint rule with optical depths in closed form.
double quadrature(const Scene& scene, const Ray& ray, double t0, double t1,
                  const std::function<MarchArrival(Vec3)>& arrives)
{
    constexpr int steps = 4000;
    const Volume& volume = scene.media.volumes.front();
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const auto t = static_cast<float>(t0 + (t1 - t0) * (i + 0.5) / steps);
        const Vec3 x = ray.at(t);
        const double sigma = double{test::sigma_at(volume, x)};
        if (sigma == 0.0) continue;
        const MarchArrival a = arrives(x);
        const double depth =
            double{optical_depth(scene.media, ray, {0.0f, t})} +
            double{optical_depth(scene.media, Ray{x, a.wi, 0.0f}, {0.0f, a.distance})};
        sum += sigma * std::exp(-depth) * double{a.Li.x} *
               double{eval_phase(volume.phase, -ray.d, a.wi)};
    }
    return sum * (t1 - t0) / steps * double{volume.albedo.x};
}

}  // namespace

TEST(March, SlabLitFromBehindTheCameraConvergesToTheClosedForm)
{
    // Light and eye see each point through the same depth: the integral of sigma exp(-2 tau) is
    // (1 - exp(-2 tau)) / 2, whatever the density.
    Volume slab = test::constant_cube(20, 2.0f);
    slab.density_scale = 1.5f;
    slab.phase.g = 0.4f;
    const Scene scene = scene_of(slab, DistantLight{Vec3(0.0f, 0.0f, 1.0f), Spectrum(3.0f)});
    const Ray ray{{0.13f, 0.21f, 4.0f}, {0.0f, 0.0f, -1.0f}};
    const double tau = double{optical_depth(scene.media, ray, everything)};
    const Phase& phase = scene.media.volumes.front().phase;
    const double exact = 0.8 * 3.0 * double{eval_phase(phase, -ray.d, Vec3(0.0f, 0.0f, 1.0f))} *
                         0.5 * (1.0 - std::exp(-2.0 * tau));
    double last = 1.0;
    for (int level = 0; level < 4; ++level) {
        const double error = std::abs(marched(scene, ray, refined(level)) / exact - 1.0);
        EXPECT_LT(error, std::max(last, 1e-4)) << level;  // below are floats' roundings
        last = error;
    }
    // Rules of second order at steps of a quarter voxel: (0.026 m * 1.5 / m)^2 and a margin.
    EXPECT_LT(last, 2e-3);
    // Negative control: a grid of eight nodes knows the corners alone, which lie in no shadow.
    MarchParams coarse = refined(3);
    coarse.node_budget = 8;
    EXPECT_GT(std::abs(marched(scene, ray, coarse) / exact - 1.0), 0.1);
}

TEST(March, SphereUnderALampConvergesToTheIntegral)
{
    Volume sphere = test::unit_sphere(30);
    sphere.density_scale = 2.0f;
    sphere.phase.g = -0.3f;
    const PointLight lamp{{0.4f, 1.9f, 0.6f}, Spectrum(5.0f)};
    const Scene scene = scene_of(sphere, lamp);
    const Ray ray{{0.2f, -0.1f, 3.0f}, glm::normalize(Vec3(-0.05f, 0.06f, -1.0f))};
    const double exact = quadrature(scene, ray, 1.5, 4.5, [&](Vec3 x) {
        const Vec3 to_lamp = lamp.position - x;
        const float distance = glm::length(to_lamp);
        return MarchArrival{to_lamp / distance, distance, lamp.intensity / sqr(distance)};
    });
    const double coarse = std::abs(marched(scene, ray, refined(0)) / exact - 1.0);
    EXPECT_LT(coarse, 0.2);
    EXPECT_LT(std::abs(marched(scene, ray, refined(2)) / exact - 1.0), 0.15 * coarse);
    // Negative control: a lamp 10 % nearer.
    Scene wrong = scene;
    std::get<PointLight>(wrong.lights.front()).position *= 0.9f;
    EXPECT_GT(std::abs(marched(wrong, ray, refined(2)) / exact - 1.0), 0.05);
}

TEST(March, ThinSmokeUnderAnEvenSkyHasItsBrightness)
{
    // Isotropic: every direction counts 1 / 4 pi, so that the sky's cut does not matter.
    Volume thin = test::constant_cube(20, 2.0f);
    thin.density_scale = 1e-4f;
    Scene scene = scene_of(thin, PointLight{{0.0f, 9.0f, 0.0f}, Spectrum(0.0f)});
    scene.environment = EnvironmentLight{Spectrum(2.0f), nullptr, Mat3(1.0f)};
    const Ray ray{{0.1f, 0.2f, 4.0f}, {0.0f, 0.0f, -1.0f}};
    const double tau = double{optical_depth(scene.media, ray, everything)};
    const MarchResult result = Marcher(scene, refined(2)).march(ray);
    EXPECT_NEAR(double{result.direct.x} / (0.8 * 2.0 * tau), 1.0, 2e-3);
    EXPECT_NEAR(double{result.background.x}, 2.0 * std::exp(-tau), 1e-5);
}

TEST(March, GlowIsThatOfAnOpaqueBody)
{
    // Source function S, optical depth 2.2 * 5: S (1 - exp(-tau)).
    Volume glowing = test::constant_cube(20, 2.0f);
    glowing.density_scale = 5.0f;
    glowing.emission_params.blackbody_scale = 0.7f;
    glowing.emission_params.temperature_offset = 1500.0f;
    Scene scene = scene_of(glowing, PointLight{{0.0f, 9.0f, 0.0f}, Spectrum(0.0f)});
    const Ray ray{{0.1f, 0.2f, 4.0f}, {0.0f, 0.0f, -1.0f}};
    const double tau = double{optical_depth(scene.media, ray, everything)};
    const double source = double{luminance(source_at(scene.media.volumes.front(), Vec3(0.0f)))};
    const MarchResult result = Marcher(scene, refined(2)).march(ray);
    EXPECT_NEAR(double{luminance(result.emission)} / (source * (1.0 - std::exp(-tau))), 1.0, 1e-3);
}

TEST(March, LampsOfAnySizeKeepTheirPower)
{
    // Far away a lamp's shape is gone: irradiance is radiance times solid angle.
    Scene scene;
    scene.lights = {
        SphereLight{{0.0f, 100.0f, 0.0f}, 1.0f, Spectrum(2.0f)},
        QuadLight{
            {-0.5f, 100.0f, -0.5f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, Spectrum(2.0f), false},
        TriangleLight{
            {0.0f, 100.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, Spectrum(2.0f), false}};
    const std::vector<MarchLight> lights = march_lights(scene, 4);
    ASSERT_EQ(lights.size(), 3u);
    const auto irradiance = [&](size_t i) { return double{arrival(lights[i], Vec3(0.0f)).Li.x}; };
    const double e4 = 1e-4;
    EXPECT_NEAR(irradiance(0), 2.0 * double{pi} * e4, 1e-7);
    EXPECT_NEAR(irradiance(1), 2.0 * e4, 1e-7);
    EXPECT_NEAR(irradiance(2), 1.0 * e4, 1e-7);
}

TEST(March, EmptyAndBlackScenesEnd)
{
    Scene scene;
    const Ray ray{{0.0f, 0.0f, 4.0f}, {0.0f, 0.0f, -1.0f}};
    const MarchResult empty = Marcher(scene, {}).march(ray);
    EXPECT_EQ(empty.transmittance, 1.0f);
    EXPECT_EQ(empty.direct, Spectrum(0.0f));
    Volume cube = test::constant_cube();
    finalize(cube);
    scene.media.volumes = {cube};
    const MarchResult unlit = Marcher(scene, {}).march(ray);
    EXPECT_LT(unlit.transmittance, 1.0f);
    EXPECT_EQ(unlit.direct, Spectrum(0.0f));
}

}  // namespace mote
