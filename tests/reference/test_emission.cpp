#include <gtest/gtest.h>

#include "reference/render.h"

namespace mote {
namespace {

const Ray through{Vec3(-3.0f, 0.2f, 0.1f), Vec3(1.0f, 0.0f, 0.0f), 0.0f};

/// Emits by an emission grid where there need not be any extinction.
Volume glowing_cube(float emission_scale, float sigma, float albedo)
{
    Volume volume = test::clumpy_cube();
    volume.emission = test::constant_cube(12, 1.4f).density;
    volume.emission_params.emission_scale = emission_scale;
    volume.emission_params.emission_color = Spectrum(1.0f, 0.5f, 0.25f);
    volume.density_scale = sigma;
    volume.albedo = Spectrum(albedo);
    return volume;
}

/// Integral of T j along the ray by the midpoint rule.
double emission_quadrature(const Volume& volume, const Ray& ray, double length)
{
    const int steps = 20'000;
    double depth = 0.0;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const Vec3 p = ray.at(static_cast<float>(length * (i + 0.5) / steps));
        const double tau = static_cast<double>(test::sigma_at(volume, p)) * length / steps;
        sum +=
            std::exp(-depth - 0.5 * tau) * static_cast<double>(luminance(emission_at(volume, p)));
        depth += tau;
    }
    return sum * length / steps;
}

TEST(EmissionStat, EmissionOnlyMatchesTheIntegral)
{
    // Absorption and emission, no scattering, thin to opaque and without any extinction.
    // 5 standard errors (a false alarm in 1.7 million seeds) and the quadrature's 1e-4.
    for (const float sigma : {0.0f, 1.0f, 8.0f, 60.0f}) {
        Scene scene;
        scene.media.volumes.push_back(glowing_cube(0.7f, sigma, 0.0f));
        const double exact = emission_quadrature(scene.media.volumes[0], through, 6.0);
        const RunningStats stats = test::trace(scene, {}, through, 40'000, 1);
        EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 1e-4 * exact)
            << sigma;
        EXPECT_LT(stats.standard_error(), 0.04 * exact);
    }
}

TEST(EmissionStat, BlackBodyEmissionMatchesTheIntegral)
{
    Scene scene;
    Volume volume = test::clumpy_cube();
    volume.temperature = test::constant_cube(12, 1.4f).density;
    volume.density_scale = 4.0f;
    volume.albedo = Spectrum(0.0f);
    volume.emission_params.blackbody_scale = 2.0f;
    volume.emission_params.temperature_scale = 800.0f;
    volume.emission_params.temperature_offset = 900.0f;
    scene.media.volumes.push_back(volume);
    const double exact = emission_quadrature(volume, through, 6.0);
    const RunningStats stats = test::trace(scene, {}, through, 40'000, 2);
    EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 1e-4 * exact);
}

TEST(EmissionStat, ScatteredEmissionIsTheSameHoweverItIsFound)
{
    // A dark cloud beside and inside a glowing one, single and multiple scattering. Scattered rays
    // alone are the plain estimate; 5 combined standard errors.
    Scene scene;
    scene.media.volumes.push_back(glowing_cube(3.0f, 2.0f, 0.8f));
    Volume beside = test::constant_cube();
    beside.density_scale = 0.5f;
    beside.albedo = Spectrum(0.9f);
    beside.phase.g = 0.5f;
    beside.world_from_object.keys[0].translate = Vec3d(0.3, 1.5, 0.0);
    beside.world_from_object.keys[0].scale = Vec3d(1.0, 0.8, 1.2);
    scene.media.volumes.push_back(beside);
    for (const int max_bounces : {1, 6}) {
        PathTracerParams params;
        params.max_bounces = max_bounces;
        params.light_strategy = LightStrategy::Phase;
        const RunningStats plain = test::trace(scene, params, through, 120'000, 3);
        for (const MisHeuristic mis : {MisHeuristic::Power, MisHeuristic::Balance}) {
            params.light_strategy = LightStrategy::Mis;
            params.mis = mis;
            const RunningStats weighted = test::trace(scene, params, through, 80'000, 4);
            EXPECT_LT(test::z_score(plain, weighted), 5.0) << plain.mean << " " << weighted.mean;
            EXPECT_LT(weighted.standard_error(), 0.01 * weighted.mean);
        }
    }
}

TEST(EmissionStat, CountingScatteredEmissionTwiceIsRejected)
{
    // Negative control: shadow rays to the emission without their MIS weight.
    Scene scene;
    scene.media.volumes.push_back(glowing_cube(3.0f, 4.0f, 0.9f));
    PathTracerParams params;
    params.light_strategy = LightStrategy::Phase;
    const LightSampler by_scattering = build_light_sampler(scene, params);
    const RunningStats plain = test::run_trials(60'000, 5, [&](Rng& rng) {
        return trace_path(scene, by_scattering, params, through, rng).direct.x;
    });
    params.light_strategy = LightStrategy::NextEvent;
    const LightSampler by_shadow_rays = build_light_sampler(scene, params);
    const RunningStats unweighted = test::run_trials(60'000, 6, [&](Rng& rng) {
        return trace_path(scene, by_shadow_rays, params, through, rng).direct.x;
    });
    EXPECT_LT(test::z_score(plain, unweighted), 5.0) << plain.mean << " " << unweighted.mean;
    EXPECT_GT(std::abs(unweighted.mean),
              10.0 * std::hypot(plain.standard_error(), unweighted.standard_error()));
}

TEST(Emission, GoesToTheLayersItBelongsTo)
{
    Scene scene;
    scene.media.volumes.push_back(glowing_cube(1.0f, 2.0f, 0.0f));
    const LightSampler lights = build_light_sampler(scene, {});
    for (uint32_t i = 0; i < 200; ++i) {
        Rng rng(7, 0, Stream::Test, i, 0);
        const PathResult result = trace_path(scene, lights, {}, through, rng);
        EXPECT_EQ(result.direct + result.indirect + result.background, Spectrum(0.0f));
        EXPECT_EQ(result.L(), result.emission);
    }
}

}  // namespace
}  // namespace mote
