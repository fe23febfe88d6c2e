// Light of many events by shared paths and by paths of the pixel's own, against the path tracer.

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/parallel.h"
#include "multiscatter/still_scene.h"
#include "restir/room_scenes.h"
#include "restir/runs.h"

namespace mote {
namespace {

using test::TestScene;

TestScene with_bounces(TestScene scene, int max_bounces, const std::string& name)
{
    scene.max_bounces = max_bounces;
    scene.name = name;
    return scene;
}

/// 20 x 18 pixels: four tiles, three of them cut. Close up, so that pixels are worth sharing and
/// smoke fills the tiles: means of rare events are not normal.
void use_large_camera(Scene& scene)
{
    scene.camera.width = 20;
    scene.camera.height = 18;
    scene.camera.tan_half_fov_y *= 0.25f;
}

TestScene dense_cloud(int max_bounces)
{
    TestScene out{"dense cloud", test::lit_clumps(10.0f), max_bounces};
    Volume& volume = out.scene.media.volumes[0];
    volume.albedo = Spectrum(0.999f);
    volume.phase = {0.85f};
    out.scene.lights = {test::sun()};
    out.scene.environment = test::even_sky();
    return out;
}

TestScene lamps_inside(int max_bounces)
{
    TestScene out{"lamps inside smoke", test::lit_clumps(3.0f), max_bounces};
    for (uint32_t i = 0; i < 40; ++i) {
        Rng rng(5, 0, Stream::Test, i, 0);
        const Vec3 p = 1.6f * (rng.uniform3() - Vec3(0.5f));
        const float L = std::exp2(4.0f * rng.uniform());
        out.scene.lights.emplace_back(SphereLight{p, 0.08f, L * rng.uniform3()});
    }
    return out;
}

/// The camera travels while the shutter is open, through an open lens.
TestScene moving_camera()
{
    TestScene out = test::sun_and_sky();
    MovingTransform& pose = out.scene.camera.world_from_camera;
    Trs end = pose.keys[0];
    end.translate += Vec3d(0.3, -0.1, 0.0);
    pose.keys.push_back(end);
    out.scene.camera.lens_radius = 0.05f;
    out.scene.camera.focus_distance = 3.0f;
    return out;
}

TestScene closed_room()
{
    return {"closed room", test::room(), 3};
}

std::vector<TestScene> scenes()
{
    std::vector<TestScene> list{with_bounces(test::sun_and_sky(), 2, "two events"),
                                with_bounces(test::sun_and_sky(), 4, "four events"),
                                with_bounces(test::sun_and_sky(), 1000, "any number of events"),
                                dense_cloud(16),
                                lamps_inside(5),
                                with_bounces(moving_camera(), 4, "moving camera and lens"),
                                with_bounces(test::overlapping(), 4, "overlapping volumes"),
                                with_bounces(test::camera_inside(), 4, "camera inside"),
                                {"courtyard", test::courtyard(true), 4},
                                {"courtyard of many events", test::courtyard(true), 8},
                                closed_room()};
    for (TestScene& scene : list) use_large_camera(scene.scene);
    return list;
}

void expect_unbiased(const TestScene& scene, const test::Effort& effort, bool tell)
{
    const TileStats reference = test::reference_runs(scene, effort);
    uint32_t seed = 1;
    struct Form {
        const char* name;
        IndirectLight indirect;
        bool is_guided;
    };
    for (const Form& form : {Form{", paths", IndirectLight::Paths, false},
                             Form{", shared", IndirectLight::Shared, false},
                             Form{", shared and guided", IndirectLight::Shared, true}}) {
        RenderDescription render = test::description(scene, EstimatorKind::Restir, effort.samples);
        render.restir.indirect = form.indirect;
        render.restir.indirect_guide = form.is_guided;
        const TileStats tested = test::render_runs(scene, render, effort.runs, seed);
        seed += 1000;
        const RunComparison comparison = compare_runs(tested, reference);
        const std::string text = test::summary(scene.name + form.name, comparison);
        EXPECT_GT(comparison.p, test::alarm) << text;
        EXPECT_EQ(comparison.non_finite, 0) << text;
        if (tell) std::printf("%s\n", text.c_str());
    }
}

class SharedPathsStat : public testing::TestWithParam<TestScene> {};

TEST_P(SharedPathsStat, AgreeWithThePathTracer)
{
    expect_unbiased(GetParam(), {32, 2, 16}, false);
}

class SharedPathsLong : public testing::TestWithParam<TestScene> {};

TEST_P(SharedPathsLong, AgreeWithThePathTracerWithinLittle)
{
    if (!std::getenv("MOTE_LONG_TESTS")) GTEST_SKIP() << "MOTE_LONG_TESTS is not set";
    expect_unbiased(GetParam(), {64, 16, 256}, true);
}

std::string test_name(const testing::TestParamInfo<TestScene>& scene)
{
    std::string name;
    for (const char c : scene.param.name) name += c == ' ' ? '_' : c;
    return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, SharedPathsStat, testing::ValuesIn(scenes()), test_name);
INSTANTIATE_TEST_SUITE_P(Scenes, SharedPathsLong, testing::ValuesIn(scenes()), test_name);

/// Albedo 1 in an even environment: radiance 1 everywhere, whatever the smoke.
TEST(SharedPathsStat, WhiteFurnaceStaysWhite)
{
    for (const float g : {0.0f, 0.85f}) {
        TestScene furnace{"furnace", test::lit_clumps(8.0f), 100'000};
        furnace.scene.media.volumes[0].albedo = Spectrum(1.0f);
        furnace.scene.media.volumes[0].phase = {g};
        furnace.scene.environment = EnvironmentLight{Spectrum(1.0f), nullptr, Mat3(1.0f)};
        use_large_camera(furnace.scene);
        RenderDescription render = test::description(furnace, EstimatorKind::Restir, 2);
        render.restir.indirect = IndirectLight::Shared;
        RunningStats means;
        for (uint32_t seed = 1; seed <= 32; ++seed) {
            render.seed = seed;
            FrameHistory history;
            FrameStats stats;
            OutputDescription output;
            output.color_type = PixelType::Float;
            const LayeredImage image =
                render_frame(furnace.scene, render, output, history, nullptr, stats);
            double sum = 0.0;
            const Buffer2D<float>& green = image.channels[1].data;
            for (size_t i = 0; i < green.size(); ++i) sum += static_cast<double>(green.data()[i]);
            means.add(sum / static_cast<double>(green.size()));
        }
        const MeanEstimate mean = estimate_mean(means);
        // False alarms: 1e-5 each.
        EXPECT_TRUE(confidence_interval(mean, 1.0 - 1e-5).contains(1.0))
            << mean.mean << " +- " << mean.standard_error();
        EXPECT_LT(mean.standard_error(), 0.04);
    }
}

TEST(SharedPaths, ImagesAreTheSameForAnyThreadCount)
{
    TestScene scene = with_bounces(test::sun_and_sky(), 8, "");
    use_large_camera(scene.scene);
    RenderDescription render = test::description(scene, EstimatorKind::Restir, 2);
    render.restir.indirect = IndirectLight::Shared;
    for (const ReuseMode reuse : {ReuseMode::Off, ReuseMode::Both}) {
        render.restir.reuse = reuse;
        std::vector<float> one;
        const auto red = [](const LayeredImage& image) {
            const Buffer2D<float>& data = image.channels[0].data;
            return std::vector<float>(data.data(), data.data() + data.size());
        };
        for (const int threads : {1, 2, 3, 8}) {
            run_with_threads(threads, [&] {
                FrameHistory history;
                FrameStats stats;
                const LayeredImage image =
                    render_frame(scene.scene, render, {}, history, nullptr, stats);
                if (threads == 1) one = red(image);
                EXPECT_EQ(red(image), one) << threads;
            });
        }
    }
}

TEST(SharedPaths, NeedAShutterDuringWhichOnlyTheCameraMoves)
{
    Scene scene = test::sun_and_sky().scene;
    EXPECT_TRUE(is_still_but_for_camera(scene));
    scene.camera.world_from_camera.keys.push_back({});
    EXPECT_TRUE(is_still_but_for_camera(scene));
    scene.media.volumes[0].world_from_object.keys.push_back({});
    EXPECT_FALSE(is_still_but_for_camera(scene));
}

/// The negative control of the comparisons above: the same effort finds out an event too few.
TEST(SharedPathsStat, OneEventTooFewIsFoundOut)
{
    TestScene scene = with_bounces(test::sun_and_sky(), 3, "");
    use_large_camera(scene.scene);
    const test::Effort effort{32, 2, 16};
    const TileStats reference = test::reference_runs(scene, effort);
    scene.max_bounces = 2;
    for (const IndirectLight indirect : {IndirectLight::Paths, IndirectLight::Shared}) {
        RenderDescription render = test::description(scene, EstimatorKind::Restir, effort.samples);
        render.restir.indirect = indirect;
        const TileStats tested = test::render_runs(scene, render, effort.runs, 1);
        EXPECT_LT(compare_runs(tested, reference).p, test::alarm);
    }
}

}  // namespace
}  // namespace mote
