#include "restir/surface_bias.h"
#include "restir/surface_forms.h"

// Which of the samples that meet in a surface's reservoir are shaded (surface.shading): the same
// mean either way (test_surface_forms.cpp), but all of them have less noise where lamps have
// colours.

namespace mote {
namespace {

constexpr int runs = 60;

/// Variance of red minus blue in the last frame, summed over pixels.
double color_noise(const std::vector<Scene>& frames, const test::FrameCaches& caches,
                   SurfaceVisibility visibility, SurfaceShading shading)
{
    RenderDescription render;
    render.width = frames.front().camera.width;
    render.height = frames.front().camera.height;
    render.samples = 1;
    render.estimator = EstimatorKind::Restir;
    render.restir =
        test::SurfaceForm{ReuseMis::Pairwise, visibility, ReuseMode::Both, shading}.params();
    std::vector<RunningStats> pixels(static_cast<size_t>(render.width * render.height));
    FrameStats stats;
    for (int run = 0; run < runs; ++run) {
        render.seed = 1 + static_cast<uint32_t>(run);
        FrameHistory history;
        LayeredImage image;
        for (size_t i = 0; i < frames.size(); ++i) {
            history.impl().caches = caches[i];
            image = render_frame(frames[i], render, test::direct_light_output(), history, nullptr,
                                 stats);
        }
        const float* red = image.find("direct.R")->data.data();
        const float* blue = image.find("direct.B")->data.data();
        for (size_t i = 0; i < pixels.size(); ++i) {
            pixels[i].add(static_cast<double>(red[i] - blue[i]));
        }
    }
    double sum = 0.0;
    for (const RunningStats& pixel : pixels) sum += pixel.variance();
    return sum;
}

class SurfaceShadingNoise : public testing::TestWithParam<SurfaceVisibility> {};

/// Measured: four fifths of the variance, as history often holds the same lamp as the choice. With
/// these seeds it is so.
TEST_P(SurfaceShadingNoise, OfColorIsLessWhereAllAreShaded)
{
    const std::vector<Scene> frames = test::still_posts(3);
    const test::FrameCaches caches = test::make_frame_caches(frames);
    const double chosen = color_noise(frames, caches, GetParam(), SurfaceShading::Chosen);
    const double all = color_noise(frames, caches, GetParam(), SurfaceShading::All);
    EXPECT_GT(all, 0.0);
    EXPECT_LT(all, 0.9 * chosen);
}

INSTANTIATE_TEST_SUITE_P(Visibility, SurfaceShadingNoise,
                         testing::Values(SurfaceVisibility::Exact, SurfaceVisibility::None),
                         [](const auto& each) {
                             return each.param == SurfaceVisibility::Exact ? "Exact" : "None";
                         });

}  // namespace
}  // namespace mote
