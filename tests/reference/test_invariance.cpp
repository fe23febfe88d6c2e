#include <gtest/gtest.h>

#include "core/parallel.h"
#include "reference/render.h"
#include "scene/environment.h"

namespace mote {
namespace {

/// The same scene with lengths times s: extinction and volume emission over s, point intensities
/// and nothing else times s^2.
Scene scaled_scene(float s)
{
    Scene scene;
    Volume volume = test::clumpy_cube();
    volume.density_scale = 5.0f / s;
    volume.albedo = Spectrum(0.9f);
    volume.phase.g = 0.4f;
    volume.emission = volume.density;
    volume.emission_params.emission_scale = 0.2f / s;
    volume.world_from_object.keys[0].scale = Vec3d(static_cast<double>(s));
    scene.media.volumes.push_back(volume);
    scene.lights = {PointLight{s * Vec3(0.5f, 1.2f, 0.1f), Spectrum(s * s)},
                    SphereLight{s * Vec3(-0.5f, 1.3f, 0.0f), s * 0.3f, Spectrum(1.0f)},
                    QuadLight{s * Vec3(-1.0f, -1.3f, -1.0f), s * Vec3(0.0f, 0.0f, 2.0f),
                              s * Vec3(2.0f, 0.0f, 0.0f), Spectrum(0.3f), false},
                    DistantLight{glm::normalize(Vec3(1.0f, 1.0f, 0.0f)), Spectrum(0.5f)}};
    scene.environment = EnvironmentLight{Spectrum(0.2f), nullptr, Mat3(1.0f)};
    return scene;
}

TEST(InvarianceStat, RadianceDoesNotDependOnTheSceneScale)
{
    // The same random numbers at every scale: results differ by rounding, which now and then sends
    // a path another way. 5 standard errors of the paired differences plus 1e-4.
    for (const bool equiangular : {false, true}) {
        PathTracerParams params;
        params.max_bounces = 8;
        params.equiangular = equiangular;
        const auto trace = [&](const Scene& scene, const LightSampler& lights, float s,
                               uint32_t i) {
            Rng rng(1, 0, Stream::Test, i, 0);
            const Ray ray{s * Vec3(-3.0f, 0.2f, 0.1f), Vec3(1.0f, 0.0f, 0.0f), 0.0f};
            return static_cast<double>(luminance(trace_path(scene, lights, params, ray, rng).L()));
        };
        const Scene one = scaled_scene(1.0f);
        const LightSampler one_lights = build_light_sampler(one, params);
        for (const float s : {1e-3f, 0.03f, 7.0f, 1e3f}) {
            const Scene scene = scaled_scene(s);
            const LightSampler lights = build_light_sampler(scene, params);
            RunningStats difference;
            RunningStats base;
            for (uint32_t i = 0; i < 10'000; ++i) {
                base.add(trace(one, one_lights, 1.0f, i));
                difference.add(trace(scene, lights, s, i) - trace(one, one_lights, 1.0f, i));
            }
            EXPECT_LT(std::abs(difference.mean),
                      5.0 * difference.standard_error() + 1e-4 * base.mean)
                << s;
            EXPECT_LT(difference.standard_error(), 0.01 * base.mean) << s;
        }
    }
}

TEST(InvarianceStat, ForgettingToScaleTheExtinctionIsRejected)
{
    PathTracerParams params;
    params.max_bounces = 8;
    Scene wrong = scaled_scene(2.0f);
    wrong.media.volumes[0].density_scale *= 1.25f;
    const Ray ray{2.0f * Vec3(-3.0f, 0.2f, 0.1f), Vec3(1.0f, 0.0f, 0.0f), 0.0f};
    const RunningStats right = test::trace(scaled_scene(2.0f), params, ray, 60'000, 2);
    EXPECT_GT(test::z_score(test::trace(wrong, params, ray, 60'000, 3), right), 5.0);
}

TEST(Determinism, PathsDependOnTheirKeyAloneForAnyThreadCount)
{
    const Scene scene = scaled_scene(1.0f);
    PathTracerParams params;
    params.max_bounces = 20;
    const LightSampler lights = build_light_sampler(scene, params);
    const auto render = [&](int threads) {
        std::vector<Spectrum> pixels(2000);
        const auto trace = [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                Rng rng(5, 3, Stream::Path, static_cast<uint32_t>(i), 0);
                const Ray ray{Vec3(-3.0f, rng.uniform() - 0.5f, rng.uniform() - 0.5f),
                              Vec3(1.0f, 0.0f, 0.0f), 0.0f};
                pixels[i] = trace_path(scene, lights, params, ray, rng).L();
            }
        };
        run_with_threads(threads, [&] { parallel_for(pixels.size(), 7, trace); });
        return pixels;
    };
    const std::vector<Spectrum> one = render(1);
    for (const int threads : {2, 3, 8}) EXPECT_EQ(render(threads), one) << threads;
}

TEST(Extremes, ResultsStayFiniteAndPathsEnd)
{
    // Extinctions, intensities, sizes and distances far outside of what scenes use.
    for (const float sigma : {1e-20f, 1e3f, 1e8f}) {
        for (const float power : {1e-30f, 1e15f}) {
            for (const float g : {0.0f, 0.999f, -0.999f}) {
                Scene scene = scaled_scene(1.0f);
                Volume& volume = scene.media.volumes[0];
                volume.density_scale = sigma;
                volume.phase.g = g;
                scene.lights.push_back(PointLight{Vec3(0.05f), Spectrum(power)});
                scene.lights.push_back(SphereLight{Vec3(0.1f), 1e-6f, Spectrum(power)});
                scene.lights.push_back(SphereLight{Vec3(0.0f), 1e6f, Spectrum(power)});
                scene.lights.push_back(QuadLight{Vec3(-1e5f, 2.0f, -1e5f), Vec3(2e5f, 0.0f, 0.0f),
                                                 Vec3(0.0f, 0.0f, 2e5f), Spectrum(power), false});
                for (const bool equiangular : {false, true}) {
                    PathTracerParams params;
                    params.max_bounces = 50;
                    params.equiangular = equiangular;
                    const LightSampler lights = build_light_sampler(scene, params);
                    for (uint32_t i = 0; i < 300; ++i) {
                        Rng rng(6, 0, Stream::Test, i, 0);
                        const Ray ray{Vec3(-3.0f, 0.05f, 0.05f), Vec3(1.0f, 0.0f, 0.0f), 0.0f};
                        const PathResult result = trace_path(scene, lights, params, ray, rng);
                        EXPECT_TRUE(is_finite(result.L()))
                            << "sigma " << sigma << " power " << power << " g " << g;
                        EXPECT_GE(std::min({result.L().x, result.L().y, result.L().z}), 0.0f);
                    }
                }
            }
        }
    }
}

TEST(Extremes, ScenesWithoutMediaOrLightsWork)
{
    Scene empty;
    const Ray ray{Vec3(0.0f), Vec3(0.0f, 0.0f, 1.0f), 0.0f};
    Rng rng(1, 0, Stream::Test, 0, 0);
    PathResult result = trace_path(empty, build_light_sampler(empty, {}), {}, ray, rng);
    EXPECT_EQ(result.L(), Spectrum(0.0f));
    EXPECT_EQ(result.transmittance, 1.0f);
    EXPECT_EQ(result.depth, infinity);
    empty.environment = EnvironmentLight{Spectrum(2.0f), nullptr, Mat3(1.0f)};
    empty.lights.push_back(SphereLight{Vec3(0.0f, 0.0f, 5.0f), 1.0f, Spectrum(3.0f)});
    result = trace_path(empty, build_light_sampler(empty, {}), {}, ray, rng);
    EXPECT_EQ(result.background, Spectrum(5.0f));  // lamps do not block the environment
    Scene dark;
    dark.media.volumes.push_back(test::constant_cube());
    dark.lights.push_back(PointLight{Vec3(2.0f), Spectrum(0.0f)});
    PathTracerParams params;
    params.max_bounces = 10;
    EXPECT_EQ(trace_path(dark, build_light_sampler(dark, params), params, ray, rng).L(),
              Spectrum(0.0f));
}

}  // namespace
}  // namespace mote
