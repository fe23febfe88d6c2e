#include <gtest/gtest.h>

#include <map>

#include "core/sampling.h"
#include "reference/light_sampler.h"
#include "scene/environment.h"
#include "support/chi_squared.h"
#include "support/media.h"

namespace mote {
namespace {

constexpr LightSamplerKind kinds[] = {LightSamplerKind::Auto, LightSamplerKind::Power,
                                      LightSamplerKind::PowerDistance, LightSamplerKind::Tree};

/// Many lamps of all kinds, some without power, an image environment and an emissive volume.
Scene crowded_scene(int lamp_count)
{
    Scene scene;
    Volume volume = test::constant_cube();
    volume.emission = volume.density;
    volume.emission_params.emission_scale = 0.3f;
    scene.media.volumes.push_back(volume);
    for (int i = 0; i < lamp_count; ++i) {
        Rng rng(1, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        const Vec3 p = 4.0f * rng.uniform3() - 2.0f;
        const Spectrum color = i % 7 == 3 ? Spectrum(0.0f) : rng.uniform3();
        switch (i % 4) {
            case 0:
                scene.lights.push_back(PointLight{p, color});
                break;
            case 1:
                scene.lights.push_back(SphereLight{p, 0.1f * rng.uniform(), color});
                break;
            case 2:
                scene.lights.push_back(
                    QuadLight{p, rng.uniform3(), rng.uniform3() - 0.5f, color, false});
                break;
            default:
                scene.lights.push_back(DistantLight{sample_sphere(rng.uniform2()), 0.1f * color});
        }
    }
    EnvironmentLight environment;
    environment.map = make_environment_map(Buffer2D<Spectrum>(4, 2, Spectrum(0.1f)), "sky");
    scene.environment = environment;
    return scene;
}

TEST(LightSampler, ProbabilitiesSumToOneForEveryKind)
{
    // Tolerance: float rounding of a few hundred probabilities.
    for (const int count : {0, 1, 5, 300}) {
        const Scene scene = crowded_scene(count);
        for (const LightSamplerKind kind : kinds) {
            PathTracerParams params;
            params.light_sampler = kind;
            const LightSampler lights = build_light_sampler(scene, params);
            for (uint32_t k = 0; k < 20; ++k) {
                Rng rng(2, 0, Stream::Test, k, 0);
                const Vec3 x = k == 0 ? Vec3(1e4f) : 4.0f * rng.uniform3() - 2.0f;
                double sum = static_cast<double>(lights.pmf(LightSource::Environment, 0, x)) +
                             static_cast<double>(lights.pmf(LightSource::EmissiveVolume, 0, x));
                for (int i = 0; i < count; ++i)
                    sum += static_cast<double>(lights.pmf(LightSource::Lamp, i, x));
                EXPECT_NEAR(sum, 1.0, 1e-5) << count << " lamps, kind " << static_cast<int>(kind);
            }
        }
    }
}

TEST(LightSamplerStat, ChoicesFollowTheirProbabilities)
{
    // |z| > 5 once in 1.7 million seeds per case.
    for (const int count : {5, 300}) {
        const Scene scene = crowded_scene(count);
        for (const LightSamplerKind kind : kinds) {
            PathTracerParams params;
            params.light_sampler = kind;
            const LightSampler lights = build_light_sampler(scene, params);
            const Vec3 x(0.3f, -0.2f, 1.1f);
            const int trials = 100'000;
            std::vector<double> observed(static_cast<size_t>(count) + 2);
            std::vector<double> expected;
            Rng rng(3, 0, Stream::Test, 0, 0);
            for (int i = 0; i < trials; ++i) {
                const auto choice = lights.choose(x, rng);
                ASSERT_TRUE(choice);
                ASSERT_FLOAT_EQ(choice->pmf, lights.pmf(choice->source, choice->index, x));
                const bool is_lamp = choice->source == LightSource::Lamp;
                const int slot = is_lamp
                                     ? choice->index
                                     : count + (choice->source == LightSource::Environment ? 0 : 1);
                ++observed[static_cast<size_t>(slot)];
            }
            for (int i = 0; i < count; ++i)
                expected.push_back(trials *
                                   static_cast<double>(lights.pmf(LightSource::Lamp, i, x)));
            expected.push_back(trials *
                               static_cast<double>(lights.pmf(LightSource::Environment, 0, x)));
            expected.push_back(trials *
                               static_cast<double>(lights.pmf(LightSource::EmissiveVolume, 0, x)));
            EXPECT_LT(test::chi_squared_z(observed, expected), 5.0)
                << count << " lamps, kind " << static_cast<int>(kind);
        }
    }
}

TEST(LightSampler, LightsWithoutPowerAreNeverChosen)
{
    const Scene scene = crowded_scene(300);
    for (const LightSamplerKind kind : kinds) {
        PathTracerParams params;
        params.light_sampler = kind;
        const LightSampler lights = build_light_sampler(scene, params);
        for (int i = 3; i < 300; i += 7)
            EXPECT_EQ(lights.pmf(LightSource::Lamp, i, Vec3(0.0f)), 0.0f);
    }
    Scene black;
    black.lights.push_back(PointLight{Vec3(0.0f), Spectrum(0.0f)});
    Rng rng(1, 0, Stream::Test, 0, 0);
    EXPECT_FALSE(build_light_sampler(black, {}).choose(Vec3(1.0f), rng));
}

TEST(LightSampler, OneLightIsAlwaysChosen)
{
    Scene scene;
    scene.lights.push_back(PointLight{Vec3(0.0f), Spectrum(1.0f)});
    for (const LightSamplerKind kind : kinds) {
        PathTracerParams params;
        params.light_sampler = kind;
        const LightSampler lights = build_light_sampler(scene, params);
        Rng rng(1, 0, Stream::Test, 0, 0);
        // At the light itself too, where its distance is 0.
        EXPECT_EQ(lights.choose(Vec3(0.0f), rng)->pmf, 1.0f);
        EXPECT_EQ(lights.pmf(LightSource::Lamp, 0, Vec3(0.0f)), 1.0f);
    }
}

TEST(LightSampler, StandingOnALightGivesFiniteProbabilities)
{
    Scene scene;
    for (int i = 0; i < 20; ++i)
        scene.lights.push_back(PointLight{Vec3(static_cast<float>(i / 2)), Spectrum(1e20f)});
    for (const LightSamplerKind kind : kinds) {
        PathTracerParams params;
        params.light_sampler = kind;
        const LightSampler lights = build_light_sampler(scene, params);
        double sum = 0.0;
        for (int i = 0; i < 20; ++i)
            sum += static_cast<double>(lights.pmf(LightSource::Lamp, i, Vec3(3.0f)));
        EXPECT_NEAR(sum, 1.0, 1e-5);
    }
}

TEST(LightSampler, NearLightsAreFavouredUnlessByPowerAlone)
{
    Scene scene;
    for (int i = 0; i < 1000; ++i)
        scene.lights.push_back(PointLight{Vec3(static_cast<float>(i), 0.0f, 0.0f), Spectrum(1.0f)});
    const Vec3 x(500.0f, 0.1f, 0.0f);
    for (const LightSamplerKind kind : {LightSamplerKind::PowerDistance, LightSamplerKind::Tree}) {
        PathTracerParams params;
        params.light_sampler = kind;
        EXPECT_GT(build_light_sampler(scene, params).pmf(LightSource::Lamp, 500, x), 0.05f);
    }
    PathTracerParams params;
    params.light_sampler = LightSamplerKind::Power;
    EXPECT_NEAR(build_light_sampler(scene, params).pmf(LightSource::Lamp, 500, x), 1e-3f, 1e-6f);
}

TEST(LightSampler, FindsTheSameLampsOnARayAsTryingAll)
{
    const Scene scene = crowded_scene(400);
    const LightSampler lights = build_light_sampler(scene, {});
    int hits = 0;
    for (uint32_t k = 0; k < 500; ++k) {
        Rng rng(4, 0, Stream::Test, k, 0);
        const Ray ray{6.0f * rng.uniform3() - 3.0f, sample_sphere(rng.uniform2()), 0.0f};
        std::map<int, int> found;
        lights.for_each_lamp_on_ray(ray, [&](int index) {
            if (hit_light(scene.lights[static_cast<size_t>(index)], ray.o, ray.d)) ++found[index];
        });
        for (int i = 0; i < 400; ++i) {
            const auto hit = hit_light(scene.lights[static_cast<size_t>(i)], ray.o, ray.d);
            const bool shines = hit && luminance(hit->Le) > 0.0f;
            EXPECT_EQ(found.count(i) > 0 ? found[i] : 0, shines ? 1 : 0);
            hits += shines ? 1 : 0;
        }
    }
    EXPECT_GT(hits, 50);
}

TEST(LightSampler, AConstantEnvironmentTakesNoShadowRaysUnlessAsked)
{
    Scene scene;
    scene.environment = EnvironmentLight{};
    scene.lights.push_back(DistantLight{});
    PathTracerParams params;
    EXPECT_EQ(build_light_sampler(scene, params).pmf(LightSource::Environment, 0, Vec3(0.0f)),
              0.0f);
    params.light_strategy = LightStrategy::Mis;
    EXPECT_GT(build_light_sampler(scene, params).pmf(LightSource::Environment, 0, Vec3(0.0f)),
              0.0f);
}

}  // namespace
}  // namespace mote
