// What max_bounces leaves out of an image is counted and weighed.

#include <gtest/gtest.h>

#include "render/frame_scenes.h"

namespace mote {
namespace {

using test::mean_of;
using test::options;
using test::Options;
using test::render;
using test::slab_scene;

TEST(Truncation, PathsCutByTheBounceLimitAreCounted)
{
    FrameStats stats;
    const Scene scene = slab_scene(0.7f);
    (void)render(scene, options(4, 1, {}), &stats);
    EXPECT_GT(stats.truncation.paths, 0);
    EXPECT_LE(stats.truncation.paths, stats.paths);
    (void)render(scene, options(4, 1000, {}), &stats);
    EXPECT_EQ(stats.truncation.paths, 0);
}

/// In a white furnace what is missing is known: all paths that scatter more than n times carry
/// weight 1 when they are cut, and the image of n - 1 events lacks just their light.
TEST(Truncation, WeightOfCutPathsIsTheLightThatFurnacesLack)
{
    Scene scene = slab_scene(1.5f);
    scene.media.volumes[0].albedo = Spectrum(1.0f);
    scene.environment = EnvironmentLight{Spectrum(1.0f), nullptr, glm::mat3(1.0f)};
    scene.lights.clear();
    for (const EstimatorKind estimator : {EstimatorKind::Path, EstimatorKind::Restir}) {
        for (const IndirectReuse reuse : {IndirectReuse::Off, IndirectReuse::Spatial}) {
            for (const int bounces : {2, 3, 5}) {
                Options o = options(40, bounces - 1, {});
                o.render.estimator = estimator;
                o.render.restir.indirect_reuse = reuse;
                const double brought = mean_of(render(scene, o), "G");
                o.render.path.max_bounces = bounces;
                FrameStats stats;
                (void)render(scene, o, &stats);
                const double weight = stats.truncation.weight / static_cast<double>(stats.paths);
                EXPECT_NEAR(weight, 1.0 - brought, 0.02)
                    << bounces << (estimator == EstimatorKind::Path ? " path" : " restir")
                    << (reuse == IndirectReuse::Off ? "" : " reused");
            }
        }
    }
}

}  // namespace
}  // namespace mote
