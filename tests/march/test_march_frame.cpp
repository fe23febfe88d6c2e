#include <gtest/gtest.h>

#include "core/parallel.h"
#include "render/frame.h"
#include "support/expect_error.h"
#include "support/media.h"

namespace mote {
namespace {

Scene clumpy_scene()
{
    Scene scene;
    scene.camera.width = 24;
    scene.camera.height = 20;
    Trs pose;
    pose.translate = {0.0, 0.0, 4.0};
    scene.camera.world_from_camera.keys = {pose};
    Volume volume = test::clumpy_cube();
    volume.density_scale = 4.0f;
    finalize(volume);
    scene.media.volumes = {volume};
    scene.lights = {DistantLight{Vec3(0.0f, 1.0f, 0.0f), Spectrum(2.0f)}};
    scene.environment = EnvironmentLight{Spectrum(0.3f), nullptr, Mat3(1.0f)};
    return scene;
}

RenderDescription marching(uint32_t seed = 0)
{
    RenderDescription render;
    render.estimator = EstimatorKind::March;
    render.samples = 2;
    render.seed = seed;
    return render;
}

OutputDescription layers()
{
    OutputDescription output;
    output.aovs = {"transmittance", "volume_direct"};
    output.color_type = PixelType::Float;
    return output;
}

bool same_bits(const LayeredImage& a, const LayeredImage& b)
{
    return std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(), b.channels.end(),
                      [](const Channel& x, const Channel& y) {
                          return std::equal(x.data.begin(), x.data.end(), y.data.begin());
                      });
}

}  // namespace

TEST(MarchFrame, IsTheSameForAnySeedAndThreads)
{
    const Scene scene = clumpy_scene();
    std::vector<LayeredImage> images;
    for (const int threads : {1, 3}) {
        FrameHistory history;
        FrameStats stats;
        run_with_threads(threads, [&] {
            images.push_back(render_frame(scene, marching(static_cast<uint32_t>(threads)), layers(),
                                          history, nullptr, stats));
        });
        EXPECT_EQ(stats.dropped_non_finite, 0);
        EXPECT_GT(stats.tracking.lookups, 0);
    }
    EXPECT_TRUE(same_bits(images[0], images[1]));
}

TEST(MarchFrame, ShadowsStayWhileNothingChanges)
{
    Scene scene = clumpy_scene();
    FrameHistory history;
    const auto built = [&] {
        FrameStats stats;
        (void)render_frame(scene, marching(), layers(), history, nullptr, stats);
        return stats.caches_built;
    };
    EXPECT_EQ(built(), 1);
    EXPECT_EQ(built(), 0);
    std::get<DistantLight>(scene.lights.front()).irradiance *= 2.0f;
    EXPECT_EQ(built(), 1);
    scene.media.volumes.front().density_scale *= 2.0f;
    EXPECT_EQ(built(), 1);
}

TEST(MarchFrame, WithoutEventsNothingIsScattered)
{
    const Scene scene = clumpy_scene();
    RenderDescription render = marching();
    render.path.max_bounces = 0;
    FrameHistory history;
    FrameStats stats;
    const LayeredImage image = render_frame(scene, render, layers(), history, nullptr, stats);
    for (const float v : image.find("volume_direct.G")->data) EXPECT_EQ(v, 0.0f);
}

TEST(MarchFrame, SurfacesAreRefused)
{
    Scene scene = clumpy_scene();
    scene.surfaces = std::make_shared<const Surfaces>();
    FrameHistory history;
    FrameStats stats;
    expect_error([&] { (void)render_frame(scene, marching(), layers(), history, nullptr, stats); },
                 ExitCode::Input, {"ray marcher", "[[objects]]"});
}

}  // namespace mote
