// Phase functions as narrow as scenes may make them.
#include <gtest/gtest.h>

#include "stress/play.h"
#include "stress/stress_scenes.h"

namespace mote {
namespace {

const Phase narrow[] = {{0.999f, 0.0f, 0.0f},
                        {-0.999f, 0.0f, 0.0f},
                        {0.999f, -0.999f, 0.5f},
                        {0.999f, 0.999f, 1.0f},
                        {0.0f, 0.999f, 1e-7f}};

TEST(StressPhase, NarrowLobesStaySound)
{
    for (const Phase& phase : narrow) {
        Volume volume = test::clumps(4.0f);
        volume.phase = phase;
        finalize(volume);
        Scene scene = test::lit_by_all(volume);
        scene.environment = test::image_sky();
        // A sun exactly behind the camera and one exactly before it: both peaks are hit.
        const Vec3 behind = glm::normalize(Vec3(0.5f, 0.4f, 3.2f));
        scene.lights.push_back(DistantLight{behind, Spectrum(1.0f)});
        scene.lights.push_back(DistantLight{-behind, Spectrum(1.0f)});
        test::expect_sound_in_every_way(scene, "g " + std::to_string(phase.g), 3);
    }
}

TEST(StressPhase, TheFurnaceStaysWhiteForThePathTracer)
{
    for (const Phase& phase : narrow) {
        Scene scene = test::furnace_scene(test::clumpy_cube(), 5.0f, 0.0f);
        scene.media.volumes[0].phase = phase;
        const LayeredImage image =
            test::play(test::repeated(scene, 1), test::path_way(1000, 1), "furnace").back();
        for (const float v : image.find("G")->data) EXPECT_NEAR(v, 1.0f, 1e-4f);
    }
}

TEST(StressPhaseStat, OneEventOfAConstantSkyIsTheSameInEveryWay)
{
    // A constant sky is found however narrow the lobe is; a lamp would be a lottery.
    for (const Phase& phase : narrow) {
        Scene scene = test::furnace_scene(test::clumpy_cube(), 5.0f, 0.0f);
        scene.camera = test::small_camera({0.0f, 0.3f, 3.0f});
        scene.media.volumes[0].phase = phase;
        finalize(scene.media.volumes[0]);
        test::expect_agreement(scene, "g " + std::to_string(phase.g), {10, 2, 4, 100});
    }
}

}  // namespace
}  // namespace mote
