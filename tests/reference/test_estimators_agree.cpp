#include <gtest/gtest.h>

#include "reference/render.h"
#include "scene/environment.h"

namespace mote {
namespace {

const Ray through{Vec3(-3.0f, 0.2f, 0.1f), Vec3(1.0f, 0.0f, 0.0f), 0.0f};

/// A clumpy medium with lamps of every kind in and around it and an image environment with a sun.
Scene busy_scene(int extra_lamps)
{
    Scene scene;
    Volume volume = test::clumpy_cube();
    volume.density_scale = 6.0f;
    volume.albedo = Spectrum(0.9f);
    volume.phase = Phase{0.6f, -0.3f, 0.25f};
    scene.media.volumes.push_back(volume);
    scene.lights = {
        PointLight{Vec3(0.4f, 0.7f, 0.9f), Spectrum(0.4f)},
        SphereLight{Vec3(-0.2f, 1.1f, 0.0f), 0.3f, Spectrum(1.5f)},
        QuadLight{Vec3(-1.0f, -1.3f, -1.0f), Vec3(0.0f, 0.0f, 2.0f), Vec3(2.0f, 0.0f, 0.0f),
                  Spectrum(0.3f), false},
        DistantLight{glm::normalize(Vec3(1.0f, 1.0f, 0.0f)), Spectrum(0.5f)},
        QuadLight{Vec3(1.0f, -0.2f, -0.2f), Vec3(0.1f, 0.5f, 0.0f), Vec3(0.0f, 0.1f, 0.6f),
                  Spectrum(1.0f), true},
    };
    for (int i = 0; i < extra_lamps; ++i) {
        Rng rng(1, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        scene.lights.push_back(SphereLight{3.0f * rng.uniform3() - 1.5f, 0.05f, rng.uniform3()});
    }
    Buffer2D<Spectrum> pixels(16, 8, Spectrum(0.1f));
    pixels.at(3, 2) = Spectrum(20.0f);
    EnvironmentLight environment;
    environment.map = make_environment_map(pixels, "sky with a sun");
    scene.environment = environment;
    return scene;
}

PathTracerParams base_params(int max_bounces)
{
    PathTracerParams params;
    params.max_bounces = max_bounces;
    params.roulette_start = 3;
    return params;
}

std::vector<PathTracerParams> variants(int max_bounces)
{
    std::vector<PathTracerParams> list;
    for (const TransmittanceKind kind : {TransmittanceKind::Ratio, TransmittanceKind::Exact}) {
        list.push_back(base_params(max_bounces));
        list.back().transmittance = kind;
    }
    for (const LightSamplerKind kind :
         {LightSamplerKind::Power, LightSamplerKind::PowerDistance, LightSamplerKind::Tree}) {
        list.push_back(base_params(max_bounces));
        list.back().light_sampler = kind;
    }
    for (const LightStrategy strategy :
         {LightStrategy::Mis, LightStrategy::NextEvent, LightStrategy::Phase}) {
        list.push_back(base_params(max_bounces));
        list.back().light_strategy = strategy;
    }
    list.push_back(base_params(max_bounces));
    list.back().mis = MisHeuristic::Balance;
    list.push_back(base_params(max_bounces));
    list.back().equiangular = true;
    list.push_back(list.back());
    list.back().mis = MisHeuristic::Balance;
    list.push_back(base_params(max_bounces));
    list.back().roulette_start = 0;
    return list;
}

TEST(EstimatorsAgreeStat, EveryVariantHasTheSameMean)
{
    // 5 combined standard errors for about 50 comparisons: a false alarm in 34,000 seeds.
    for (const int lamps : {0, 60}) {
        const Scene scene = busy_scene(lamps);
        for (const int max_bounces : {1, 5}) {
            const RunningStats base =
                test::trace(scene, base_params(max_bounces), through, 40'000, 2);
            EXPECT_LT(base.standard_error(), 0.02 * base.mean);
            int number = 0;
            for (const PathTracerParams& params : variants(max_bounces)) {
                const RunningStats stats = test::trace(scene, params, through, 25'000, 3);
                EXPECT_LT(test::z_score(stats, base), 5.0)
                    << "variant " << number << ", " << lamps << " lamps, " << max_bounces
                    << " bounces: " << stats.mean << " +- " << stats.standard_error() << " against "
                    << base.mean;
                ++number;
            }
        }
    }
}

TEST(EstimatorsAgreeStat, ALampLeftOutIsRejected)
{
    // Negative control: one of the five lamps, a few per cent of the light, is missing.
    Scene scene = busy_scene(0);
    const RunningStats base = test::trace(scene, base_params(1), through, 80'000, 4);
    scene.lights.pop_back();
    const RunningStats stats = test::trace(scene, base_params(1), through, 80'000, 5);
    EXPECT_GT(test::z_score(stats, base), 5.0);
}

TEST(EstimatorsAgreeStat, EquiangularDistancesTameALampInsideThinMedium)
{
    // A lamp 0.02 beside the ray: free flights seldom get near it, and 1/d^2 makes spikes of those
    // that do. Both agree, at a variance at least 10 times lower.
    Scene scene;
    Volume volume = test::constant_cube();
    volume.density_scale = 0.2f;
    scene.media.volumes.push_back(volume);
    scene.lights = {PointLight{through.at(3.1f) + Vec3(0.0f, 0.02f, 0.0f), Spectrum(1.0f)}};
    PathTracerParams params = base_params(1);
    const RunningStats flights = test::trace(scene, params, through, 100'000, 7);
    params.equiangular = true;
    const RunningStats both = test::trace(scene, params, through, 20'000, 8);
    EXPECT_LT(test::z_score(flights, both), 5.0) << flights.mean << " " << both.mean;
    EXPECT_LT(10.0 * both.variance(), flights.variance());
}

TEST(EstimatorsAgreeStat, DistanceMattersAmongThousandsOfLamps)
{
    // 4000 lamps scattered over a box 60 times as long as the medium: the tree agrees with power
    // alone at a fraction of its variance.
    Scene scene = busy_scene(0);
    scene.environment.reset();
    scene.lights.clear();
    for (int i = 0; i < 4000; ++i) {
        Rng rng(1, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        const Vec3 p = Vec3(120.0f, 3.0f, 3.0f) * (rng.uniform3() - 0.5f);
        scene.lights.push_back(SphereLight{p, 0.05f, rng.uniform3()});
    }
    PathTracerParams params = base_params(1);
    params.light_sampler = LightSamplerKind::Power;
    const RunningStats power = test::trace(scene, params, through, 30'000, 9);
    params.light_sampler = LightSamplerKind::Tree;
    const RunningStats tree = test::trace(scene, params, through, 30'000, 10);
    EXPECT_LT(test::z_score(power, tree), 5.0) << power.mean << " " << tree.mean;
    EXPECT_LT(2.0 * tree.variance(), power.variance());
}

TEST(EstimatorsAgreeStat, LampsAreSeenByTheCameraThroughTheMedium)
{
    // background = sum over the lamps on the ray of Le T(camera, lamp), and the environment.
    Scene scene = busy_scene(0);
    scene.lights = {SphereLight{Vec3(0.0f, 0.2f, 0.1f), 0.05f, Spectrum(2.0f)},
                    QuadLight{Vec3(2.0f, -1.0f, -1.0f), Vec3(0.0f, 0.0f, 2.0f),
                              Vec3(0.0f, 2.0f, 0.0f), Spectrum(1.0f), false}};
    scene.environment.reset();
    const Volume& volume = scene.media.volumes[0];
    const double near = test::marched_depth(volume, through.o, Vec3(-0.05f, 0.2f, 0.1f), 4000);
    const double far = test::marched_depth(volume, through.o, Vec3(2.0f, 0.2f, 0.1f), 4000);
    const double exact = 2.0 * std::exp(-near) + std::exp(-far);
    const RunningStats stats = test::trace(scene, base_params(0), through, 100'000, 6);
    EXPECT_LT(test::z_score(stats, exact), 5.0) << stats.mean << " " << exact;
}

}  // namespace
}  // namespace mote
