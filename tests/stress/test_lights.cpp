// Lights of no power and of 1e30, of no size and larger than the scene, inside opaque voxels.
#include <gtest/gtest.h>

#include "stress/play.h"
#include "stress/stress_scenes.h"

namespace mote {
namespace {

/// One light of each kind, alone, of this power.
std::vector<Light> each_kind(float power)
{
    const Spectrum light(power);
    return {
        PointLight{{0.1f, 0.1f, 0.1f}, light},
        PointLight{{1.2f, 0.9f, 0.8f}, light},
        SphereLight{{0.2f, 0.1f, 0.1f}, 0.1f, light},
        DistantLight{glm::normalize(Vec3(0.7f, 0.6f, 0.2f)), light},
        QuadLight{{-0.5f, -0.2f, -0.4f}, {1.0f, 0.1f, 0.0f}, {0.0f, 0.2f, 0.9f}, light, true},
        TriangleLight{{-0.5f, -0.2f, -0.4f}, {1.0f, 0.1f, 0.0f}, {0.0f, 0.2f, 0.9f}, light, true},
        SpotLight{
            {0.9f, 0.8f, 0.6f}, glm::normalize(Vec3(-0.9f, -0.8f, -0.5f)), light, 0.9f, 0.8f}};
}

Scene lit_by(const Light& light, float density = 4.0f)
{
    Scene scene;
    scene.camera = test::stress_camera({0.5f, 0.4f, 3.2f});
    scene.media.volumes = {test::clumps(density)};
    scene.lights = {light};
    return scene;
}

TEST(StressLights, PowersAtBothEndsOfFloatStaySound)
{
    for (const float power : {0.0f, 1e-42f, 1e-30f, 1e30f}) {
        for (const Light& light : each_kind(power)) {
            test::expect_sound_in_every_way(
                lit_by(light),
                "power " + std::to_string(power) + " kind " + std::to_string(light.index()));
        }
        Scene sky = lit_by(PointLight{});
        sky.lights.clear();
        sky.environment = test::image_sky();
        sky.environment->radiance = Spectrum(power);
        test::expect_sound_in_every_way(sky, "sky " + std::to_string(power));
    }
}

TEST(StressLights, LightIsInProportionToPower)
{
    // Same random numbers and a power of two: the same picture to the last bits.
    for (const test::Way& way : test::all_ways()) {
        for (size_t kind = 0; kind < each_kind(1.0f).size(); ++kind) {
            const auto light = [&](float power) {
                const Scene scene = lit_by(each_kind(power)[kind]);
                const int frames = uses_history(way.render) ? 2 : 1;
                return test::mean_of(test::play(test::repeated(scene, frames), way, "power").back(),
                                     "G");
            };
            const double one = light(1.0f);
            EXPECT_NEAR(light(0x1p40f) * 0x1p-40, one, 1e-3 * one) << way.name << ", " << kind;
            EXPECT_NEAR(light(0x1p-40f) * 0x1p40, one, 1e-3 * one) << way.name << ", " << kind;
        }
    }
}

TEST(StressLightsStat, AMillionFoldBrighterLampDoesNotHideTheOthers)
{
    // The bright one is buried in a ball: exp(-114) of it gets out, which floats do not know. What
    // is seen is the dim one, as if it were alone. (The path tracer chooses lamps by power and
    // would hardly ever try it.)
    Scene scene = lit_by(PointLight{{1.5f, 1.2f, 1.4f}, Spectrum(1.0f)});
    Volume ball = test::unit_sphere(16);
    ball.density_scale = 120.0f;
    finalize(ball);
    scene.media.volumes = {ball};
    scene.camera = test::small_camera({0.5f, 0.4f, 3.2f});
    const Scene alone = scene;
    scene.lights.push_back(SphereLight{{0.0f, 0.0f, 0.0f}, 0.05f, Spectrum(1e6f)});
    test::expect_looks_like(scene, alone, "buried lamp");
}

TEST(StressLights, LightsInsideDenseVoxels)
{
    for (const float density : {1e3f, 1e8f}) {
        for (const Light& light : each_kind(1e6f)) {
            test::expect_sound_in_every_way(lit_by(light, density),
                                            "density " + std::to_string(density), 2);
        }
    }
}

TEST(StressLights, OddSizes)
{
    const Vec3 in(0.1f, 0.05f, -0.1f);
    const Light odd[] = {
        SphereLight{in, 0.0f, Spectrum(1.0f)},
        SphereLight{in, 1e-18f, Spectrum(1.0f)},
        SphereLight{in, 1e12f, Spectrum(1.0f)},
        SphereLight{Vec3(1e7f), 1e-7f, Spectrum(1.0f)},
        QuadLight{in, Vec3(0.0f), Vec3(0.0f), Spectrum(1.0f), true},
        QuadLight{in, {1.0f, 0.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, Spectrum(1.0f), true},
        QuadLight{in, {1e-12f, 0.0f, 0.0f}, {0.0f, 1e-12f, 0.0f}, Spectrum(1.0f), true},
        QuadLight{Vec3(-1e7f, -2.0f, -1e7f),
                  {2e7f, 0.0f, 0.0f},
                  {0.0f, 0.0f, 2e7f},
                  Spectrum(1.0f),
                  true},
        PointLight{Vec3(1e18f), Spectrum(1.0f)}};
    for (size_t i = 0; i < std::size(odd); ++i) {
        test::expect_sound_in_every_way(lit_by(odd[i]), "odd size " + std::to_string(i));
    }
}

}  // namespace
}  // namespace mote
