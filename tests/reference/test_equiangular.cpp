// Distances drawn towards a lamp: a density wherever the lamp is, and light as without them.
#include <gtest/gtest.h>

#include "reference/render.h"
#include "support/surface_scene.h"

namespace mote {
namespace {

Scene lit_by(const Light& lamp)
{
    Scene scene;
    scene.media.volumes.push_back(test::constant_cube());
    scene.media.volumes.back().density_scale = 0.5f;
    scene.lights.push_back(lamp);
    return scene;
}

const Ray through{Vec3(0.0f, 0.0f, -3.0f), Vec3(0.0f, 0.0f, 1.0f)};

/// Integral over the segment of the density of equiangular distances.
double whole_density(const Scene& scene, const Ray& ray)
{
    const PathTracerParams params;
    const LightSampler lights(scene, params);
    const TraceContext context{scene, lights, params};
    const std::optional<CameraSegment> segment = make_camera_segment(scene.media, ray, infinity);
    // Finer around the lamp: t = nearest + sinh(s), the density falls as 1 / t^2 on either side.
    const auto& lamp = std::get<PointLight>(scene.lights[0]);
    const auto nearest = static_cast<double>(glm::dot(lamp.position - ray.o, ray.d));
    const double scale = 1e-5;
    const double s0 = std::asinh((static_cast<double>(segment->range.t0) - nearest) / scale);
    const double s1 = std::asinh((static_cast<double>(segment->range.t1) - nearest) / scale);
    constexpr int steps = 4000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double s = s0 + (s1 - s0) * (i + 0.5) / steps;
        const FirstEvent event{&*segment, static_cast<float>(nearest + scale * std::sinh(s)), 1.0f};
        sum += static_cast<double>(equiangular_ratio(context, event, 0)) * scale * std::cosh(s);
    }
    return sum * (s1 - s0) / steps;
}

/// Angles are good to 1e-7 of at least 1e-4; there are none towards lamps that are too far away.
TEST(Equiangular, DistancesHaveADensityWhereverTheLampIs)
{
    const auto density_by = [](float x, float z) {
        return whole_density(lit_by(PointLight{Vec3(x, 0.0f, z), Spectrum(1.0f)}), through);
    };
    for (const float miss : {0.0f, 1e-6f, 1e-3f, 0.7f, 30.0f}) {
        for (const float z : {-2.0f, -1.0f, 0.0f, 0.3f, 1.0f, 2.0f}) {
            EXPECT_NEAR(density_by(miss, z), 1.0, 0.002) << miss << ' ' << z;
        }
    }
    EXPECT_EQ(density_by(0.0f, 1e5f), 0.0);
    EXPECT_EQ(density_by(1e5f, 1e5f), 0.0);
    EXPECT_EQ(density_by(0.0f, 1e9f), 0.0);
}

/// Rounding does not carry the nearest events behind the camera, there through a wall to the lamp.
TEST(Equiangular, EventsStayOnTheRay)
{
    constexpr uint32_t draws_zero = 47'216'831;
    for (int i = 0; i < 200; ++i) {
        const float z = -0.3f - 0.002f * static_cast<float>(i);
        Scene scene = lit_by(PointLight{Vec3(0.0f, 0.0f, z), Spectrum(1.0f)});
        test::add_surfaces(
            scene,
            {{test::quad_mesh({-9.0f, -9.0f, -1e-6f}, {18.0f, 0.0f, 0.0f}, {0.0f, 18.0f, 0.0f}),
              test::diffuse(Spectrum(0.5f))}});
        const PathTracerParams params;
        const LightSampler lights(scene, params);
        const TraceContext context{scene, lights, params};
        const auto segment =
            make_camera_segment(scene.media, {Vec3(0.0f), Vec3(0.0f, 0.0f, 1.0f)}, infinity);
        ASSERT_TRUE(segment);
        Rng rng(1, 0, Stream::Test, draws_zero, 0);
        ASSERT_EQ(Rng(rng).uniform(), 0.0f);
        EXPECT_EQ(estimate_equiangular(context, *segment, rng), Spectrum(0.0f)) << z;
    }
}

/// Distances to the lamp are not told apart any more; 5 standard errors, once in 1.7 million seeds.
TEST(EquiangularStat, LampsFarAwayLightAllTheSame)
{
    for (const float distance : {1e4f, 1e6f, 1e7f, 1e8f, 1e9f}) {
        for (const Vec3& way :
             {Vec3(0.6f, 0.0f, 0.8f), Vec3(0.6f, 0.0f, -0.8f), Vec3(0, 0, -1), Vec3(1, 0, 0)}) {
            const Scene scene = lit_by(PointLight{distance * way, Spectrum(distance) * distance});
            PathTracerParams params;
            const RunningStats plain = test::trace(scene, params, through, 4000, 1);
            params.equiangular = true;
            const RunningStats equiangular = test::trace(scene, params, through, 4000, 2);
            EXPECT_LT(test::z_score(plain, equiangular), 5.0)
                << distance << ' ' << way.z << ": " << plain.mean << ' ' << equiangular.mean;
        }
    }
}

}  // namespace
}  // namespace mote
