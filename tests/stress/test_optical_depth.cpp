// Optical depths from 1e-8 to 1e8.
#include <gtest/gtest.h>

#include "stress/play.h"
#include "stress/stress_scenes.h"

namespace mote {
namespace {

TEST(StressOpticalDepth, EveryWayStaysSound)
{
    for (const float density : {1e-8f, 1e-4f, 1.0f, 1e4f, 1e8f}) {
        test::expect_sound_in_every_way(test::lit_by_all(test::clumps(density)),
                                        "density " + std::to_string(density), 3);
    }
}

TEST(StressOpticalDepth, AlphaIsWhatTheDepthSays)
{
    // Telephoto view through a slab of 2.2 m, where 1 - exp(-tau) is tau or 1 to float precision.
    // ReSTIR has it in closed form: rounding of a sum over 11 cells, 1e-5. The path tracer's is a
    // share of 288 paths: none collides at 1e-8, all do at 1e8.
    for (const double tau : {1e-8, 1e-5, 1e-2, 1.0, 1e2, 1e5, 1e8}) {
        Volume slab = test::constant_cube(11, 2.0f);
        slab.density_scale = static_cast<float>(tau / 2.2);
        finalize(slab);
        Scene scene = test::lit_by_all(slab);
        scene.camera = test::stress_camera({0.0f, 0.0f, 4.0f});
        scene.camera.tan_half_fov_y = 1e-3f;
        for (const test::Way& way : test::all_ways()) {
            const double alpha = test::mean_of(
                test::play(test::repeated(scene, 1), way, std::to_string(tau)).back(), "A");
            const double exact = -std::expm1(-tau);
            if (way.render.estimator == EstimatorKind::Restir) {
                EXPECT_NEAR(alpha, exact, 1e-5 * exact + 6e-8) << way.name << " " << tau;
            } else if (tau <= 1e-5) {
                EXPECT_NEAR(alpha, 0.0, 5.0 / 288.0) << way.name;
            } else if (tau >= 1e2) {
                EXPECT_EQ(alpha, 1.0) << way.name;
            }
        }
    }
}

TEST(StressOpticalDepth, ThinSmokeScattersInProportion)
{
    // Same random numbers: images at 1e-8 and 1e-6 differ by the factor 100, and by the light lost
    // in 1e-6 of depth. Float rounding of optical depths: 1e-4.
    for (const test::Way& way : test::all_ways()) {
        if (way.render.estimator == EstimatorKind::Path) continue;  // hits once in 1e8 paths
        const auto light_at = [&](float density) {
            const Scene scene = test::lit_by_all(test::clumps(density));
            const int frames = uses_history(way.render) ? 3 : 1;
            return test::mean_of(test::play(test::repeated(scene, frames), way, "thin").back(),
                                 "volume_direct.G");
        };
        const double thin = light_at(1e-8f);
        EXPECT_GT(thin, 0.0) << way.name;
        EXPECT_NEAR(light_at(1e-6f) / thin, 100.0, 0.01) << way.name;
    }
}

TEST(StressOpticalDepthStat, DenseMediaAgreeWithThePathTracer)
{
    for (const float density : {1e3f, 1e6f}) {
        Scene scene = test::lit_by_all(test::clumps(density));
        scene.camera = test::small_camera({0.5f, 0.4f, 3.2f});
        test::expect_agreement(scene, "density " + std::to_string(density));
    }
}

TEST(StressOpticalDepthStat, TheComparisonSeesTwentyPercent)
{
    // Negative control: lamps of 1.2 times the power must not pass for the same.
    Scene scene = test::lit_by_all(test::clumps(1e3f));
    scene.camera = test::small_camera({0.5f, 0.4f, 3.2f});
    const auto frames = test::repeated(scene, 1);
    const TileStats reference = test::last_frames(frames, test::path_way(1, 300), 16, 7, "right");
    Scene wrong = scene;
    for (Light& light : wrong.lights) {
        if (auto* lamp = std::get_if<SphereLight>(&light)) lamp->radiance *= 1.2f;
        if (auto* lamp = std::get_if<PointLight>(&light)) lamp->intensity *= 1.2f;
        if (auto* sun = std::get_if<DistantLight>(&light)) sun->irradiance *= 1.2f;
    }
    const test::Way way = test::restir_ways(1, 12)[0];
    const TileStats tested = test::last_frames(test::repeated(wrong, 1), way, 16, 1, "wrong");
    EXPECT_LT(compare_runs(tested, reference).p, test::alarm);
}

}  // namespace
}  // namespace mote
