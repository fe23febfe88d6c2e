#include <gtest/gtest.h>

#include "core/sampling.h"
#include "reference/render.h"

namespace mote {
namespace {

// One scattering event off a point light: L = integral over the camera ray of
//   T(camera, x) sigma_t(x) albedo phase(x) I / d(x)^2 T(x, light).

constexpr float sigma = 2.0f;
constexpr float albedo = 0.8f;

Scene sphere_scene(Vec3 light, float g)
{
    Scene scene;
    Volume volume = test::unit_sphere();
    volume.density_scale = sigma;
    volume.albedo = Spectrum(albedo);
    volume.phase.g = g;
    scene.media.volumes.push_back(volume);
    scene.lights.push_back(PointLight{light, Spectrum(3.0f)});
    return scene;
}

/// A point light is a spot without an edge.
SpotLight as_spot(const Light& light)
{
    if (const auto* spot = std::get_if<SpotLight>(&light)) return *spot;
    const auto& point = std::get<PointLight>(light);
    return {point.position, Vec3(0.0f, -1.0f, 0.0f), point.intensity, -2.0f, -3.0f};
}

/// The integral above by the midpoint rule on the grid; `depth` gives optical depths.
template <class Sigma, class Depth>
double quadrature(const Scene& scene, const Ray& ray, double t0, double t1, int steps,
                  Sigma&& sigma_t, Depth&& depth)
{
    const SpotLight light = as_spot(scene.lights[0]);
    const Phase& phase = scene.media.volumes[0].phase;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double t = t0 + (t1 - t0) * (i + 0.5) / steps;
        const Vec3 x = ray.at(static_cast<float>(t));
        const double density = sigma_t(x);
        if (density <= 0.0) continue;
        const Vec3 to_light = light.position - x;
        const auto distance2 = static_cast<double>(glm::dot(to_light, to_light));
        const auto scattering =
            static_cast<double>(eval_phase(phase, -ray.d, glm::normalize(to_light)));
        const double cosine =
            static_cast<double>(-glm::dot(light.direction, glm::normalize(to_light)));
        const double share = std::clamp((cosine - static_cast<double>(light.cos_outer)) /
                                            static_cast<double>(light.cos_inner - light.cos_outer),
                                        0.0, 1.0);
        const double falloff = share * share * (3.0 - 2.0 * share);
        const double tau = depth(ray.at(static_cast<float>(t0)), x) + depth(x, light.position);
        sum += std::exp(-tau) * density * scattering * falloff / distance2;
    }
    return sum * (t1 - t0) / steps * static_cast<double>(albedo * light.intensity.x);
}

double grid_quadrature(const Scene& scene, const Ray& ray, double t0, double t1)
{
    const Volume& volume = scene.media.volumes[0];
    return quadrature(
        scene, ray, t0, t1, 1000,
        [&](Vec3 x) { return static_cast<double>(test::sigma_at(volume, x)); },
        [&](Vec3 a, Vec3 b) { return test::marched_depth(volume, a, b, 200); });
}

/// Length of the segment a..b inside the unit sphere.
double chord(Vec3 a, Vec3 b)
{
    const Vec3d origin(a);
    const Vec3d d = glm::normalize(Vec3d(b) - origin);
    const double along = -glm::dot(origin, d);
    const double half2 = 1.0 - glm::dot(origin, origin) + along * along;
    if (half2 <= 0.0) return 0.0;
    const double half = std::sqrt(half2);
    const double end = glm::length(Vec3d(b) - origin);
    return std::max(0.0, std::min(end, along + half) - std::max(0.0, along - half));
}

const Ray through{Vec3(-3.0f, 0.2f, 0.1f), Vec3(1.0f, 0.0f, 0.0f), 0.0f};

struct Case {
    Vec3 light;
    float g;
};
const Case cases[] = {
    {{0.5f, 1.8f, 0.3f}, 0.0f}, {{0.3f, 0.75f, -0.2f}, 0.0f}, {{2.5f, 1.0f, 0.0f}, 0.6f}};

TEST(SingleScatteringStat, APointLightInAHomogeneousSphereMatchesQuadrature)
{
    // Ground truth is the trilinear grid; 5 standard errors fail once in 1.7 million seeds.
    for (const Case& c : cases) {
        const Scene scene = sphere_scene(c.light, c.g);
        const double exact = grid_quadrature(scene, through, 1.8, 4.2);
        for (const TransmittanceKind kind :
             {TransmittanceKind::Ratio, TransmittanceKind::ResidualRatio,
              TransmittanceKind::Exact}) {
            for (const bool equiangular : {false, true}) {
                PathTracerParams params;
                params.transmittance = kind;
                params.equiangular = equiangular;
                const RunningStats stats = test::trace(scene, params, through, 150'000, 1);
                // The quadrature itself is good to 2e-4.
                EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 2e-4 * exact)
                    << stats.mean << " " << exact;
                EXPECT_LT(stats.standard_error(), 0.008 * exact);
            }
        }
    }
}

/// A spot that lights part of what the ray `through` sees.
Scene spot_scene()
{
    Scene scene = sphere_scene(Vec3(0.0f), 0.3f);
    const Vec3 position(-0.6f, 1.6f, 0.4f);
    scene.lights = {SpotLight{position, glm::normalize(Vec3(-0.1f, 0.1f, 0.0f) - position),
                              Spectrum(3.0f), 0.98f, 0.9f}};
    return scene;
}

TEST(SingleScatteringStat, ASpotInAHomogeneousSphereMatchesQuadrature)
{
    // As above, and beside a second, dim light, so that the light is chosen.
    for (const bool is_chosen : {false, true}) {
        Scene scene = spot_scene();
        const double exact = grid_quadrature(scene, through, 1.8, 4.2);
        if (is_chosen) {
            scene.lights.push_back(PointLight{Vec3(0.0f, -1.5f, 0.0f), Spectrum(1e-6f)});
        }
        for (const auto sampler :
             {LightSamplerKind::Power, LightSamplerKind::PowerDistance, LightSamplerKind::Tree}) {
            for (const bool equiangular : {false, true}) {
                PathTracerParams params;
                params.light_sampler = sampler;
                params.equiangular = equiangular;
                const RunningStats stats = test::trace(scene, params, through, 100'000, 1);
                EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 3e-4 * exact)
                    << stats.mean << " " << exact;
                EXPECT_LT(stats.standard_error(), 0.02 * exact);
            }
        }
    }
}

TEST(SingleScatteringStat, ASpotOfAnotherAngleIsRejected)
{
    // Negative control: its cone is 1.4 degrees too narrow.
    Scene scene = spot_scene();
    const double exact = grid_quadrature(scene, through, 1.8, 4.2);
    std::get<SpotLight>(scene.lights[0]).cos_outer = 0.91f;
    PathTracerParams params;
    params.equiangular = true;
    const RunningStats stats = test::trace(scene, params, through, 100'000, 1);
    EXPECT_GT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 3e-4 * exact);
}

TEST(SingleScattering, TheGridSphereIsNearTheIdealSphere)
{
    // The closed-form sphere differs by its edge, smoothed over one voxel of 0.056: under 1.5 %.
    for (const Case& c : cases) {
        const Scene scene = sphere_scene(c.light, c.g);
        const double grid = grid_quadrature(scene, through, 1.8, 4.2);
        const double ideal = quadrature(
            scene, through, 1.8, 4.2, 20'000,
            [](Vec3 x) { return glm::dot(x, x) < 1.0f ? static_cast<double>(sigma) : 0.0; },
            [](Vec3 a, Vec3 b) { return static_cast<double>(sigma) * chord(a, b); });
        EXPECT_NEAR(grid / ideal, 1.0, 0.015);
    }
}

TEST(SingleScatteringStat, APhaseFunctionOffByOnePercentIsRejected)
{
    // Negative control, at the noise of 2 million paths: the radiance is linear in the phase
    // function, so a wrong normalisation scales the result.
    const Scene scene = sphere_scene(cases[0].light, 0.0f);
    PathTracerParams params;
    params.transmittance = TransmittanceKind::Exact;
    const double exact = grid_quadrature(scene, through, 1.8, 4.2);
    const RunningStats stats = test::trace(scene, params, through, 600'000, 2);
    EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 2e-4 * exact);
    for (const double wrong : {0.99, 1.01})
        EXPECT_GT(std::abs(wrong * stats.mean - exact),
                  5.0 * stats.standard_error() + 2e-4 * exact);
}

TEST(SingleScatteringStat, OneEventTooManyIsRejected)
{
    const Scene scene = sphere_scene(cases[0].light, 0.0f);
    PathTracerParams params;
    params.max_bounces = 2;
    const double exact = grid_quadrature(scene, through, 1.8, 4.2);
    const RunningStats stats = test::trace(scene, params, through, 50'000, 3);
    EXPECT_GT(stats.mean - exact, 5.0 * stats.standard_error());
}

TEST(SingleScattering, NoEventsMeansNoScatteredLight)
{
    Scene scene = sphere_scene(cases[0].light, 0.0f);
    scene.environment = EnvironmentLight{};
    PathTracerParams params;
    params.max_bounces = 0;
    const LightSampler lights = build_light_sampler(scene, params);
    double background = 0.0;
    for (uint32_t i = 0; i < 20'000; ++i) {
        Rng rng(4, 0, Stream::Test, i, 0);
        const PathResult result = trace_path(scene, lights, params, through, rng);
        EXPECT_EQ(result.direct, Spectrum(0.0f));
        EXPECT_EQ(result.indirect, Spectrum(0.0f));
        EXPECT_EQ(result.background.x, result.transmittance);
        EXPECT_EQ(result.cut, std::isfinite(result.depth) ? 1.0f : 0.0f);
        background += static_cast<double>(result.background.x) / 20'000;
    }
    // The environment is seen through the medium: binomial, 5 standard errors.
    const double T = std::exp(
        -test::marched_depth(scene.media.volumes[0], through.at(0.0f), through.at(6.0f), 4000));
    EXPECT_NEAR(background, T, 5.0 * std::sqrt(T * (1.0 - T) / 20'000));
}

TEST(SingleScatteringStat, AlbedoColoursTheLight)
{
    Scene scene = sphere_scene(cases[0].light, 0.0f);
    scene.media.volumes[0].albedo = Spectrum(1.0f, 0.5f, 0.0f);
    const LightSampler lights = build_light_sampler(scene, {});
    for (uint32_t i = 0; i < 1000; ++i) {
        Rng rng(5, 0, Stream::Test, i, 0);
        const PathResult result = trace_path(scene, lights, {}, through, rng);
        EXPECT_FLOAT_EQ(result.direct.y, 0.5f * result.direct.x);
        EXPECT_EQ(result.direct.z, 0.0f);
    }
}

TEST(SecondOrderStat, TwoEventsMatchABruteForceIntegral)
{
    // Second-order radiance of a distant light in the sphere by uniform sampling of the first
    // distance, the direction and the second distance, with marched transmittances: it shares
    // nothing with the tracers but the lookup. 5 combined standard errors.
    Scene scene = sphere_scene(Vec3(0.0f), 0.4f);
    const Vec3 sun = glm::normalize(Vec3(1.0f, 2.0f, 0.5f));
    scene.lights = {DistantLight{sun, Spectrum(2.0f)}};
    const Volume& volume = scene.media.volumes[0];
    const float reach = 2.4f;
    const RunningStats brute = test::run_trials(60'000, 6, [&](Rng& rng) {
        const Vec3 x1 = through.at(1.8f + reach * rng.uniform());
        const Vec3 w = sample_sphere(rng.uniform2());
        const Vec3 x2 = x1 + (reach * rng.uniform()) * w;
        const float scattering =
            test::sigma_at(volume, x1) * test::sigma_at(volume, x2) * sqr(albedo * reach) * 4.0f *
            pi * eval_phase(volume.phase, -through.d, w) * eval_phase(volume.phase, -w, sun);
        if (scattering == 0.0f) return 0.0;
        const double tau = test::marched_depth(volume, through.at(1.8f), x1, 40) +
                           test::marched_depth(volume, x1, x2, 40) +
                           test::marched_depth(volume, x2, x2 + reach * sun, 40);
        return 2.0 * static_cast<double>(scattering) * std::exp(-tau);
    });
    PathTracerParams params;
    params.max_bounces = 2;
    const LightSampler lights = build_light_sampler(scene, params);
    const RunningStats traced = test::run_trials(300'000, 7, [&](Rng& rng) {
        const PathResult result = trace_path(scene, lights, params, through, rng);
        return result.indirect.x;
    });
    EXPECT_LT(test::z_score(traced, brute), 5.0) << traced.mean << " " << brute.mean;
    EXPECT_LT(brute.standard_error(), 0.02 * brute.mean);
    // Control: with three events the same comparison fails.
    params.max_bounces = 3;
    const RunningStats three = test::run_trials(300'000, 8, [&](Rng& rng) {
        return trace_path(scene, lights, params, through, rng).indirect.x;
    });
    EXPECT_GT(test::z_score(three, brute), 5.0);
}

}  // namespace
}  // namespace mote
