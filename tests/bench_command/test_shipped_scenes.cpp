#include <filesystem>

#include <gtest/gtest.h>

#include "render/frame.h"
#include "scene/prepare.h"
#include "scene/scene_io.h"

namespace mote {
namespace {

std::vector<std::string> shipped_scenes()
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(MOTE_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

class ShippedScene : public testing::TestWithParam<std::string> {
  protected:
    /// Tiny, and coarse where media are made on the spot.
    [[nodiscard]] SceneDescription load() const
    {
        SceneDescription scene = load_scene(MOTE_SOURCE_DIR "/scenes/" + GetParam() + ".toml",
                                            {"render.width=16", "render.height=9"});
        for (VolumeDescription& volume : scene.volumes) {
            if (volume.procedural) volume.procedural->voxel_size *= 2.0f;
        }
        for (ParticlesDescription& particles : scene.particles) particles.voxel_size *= 2.0f;
        return scene;
    }
};

}  // namespace

TEST_P(ShippedScene, CountsNothingThatMustNotHappen)
{
    SceneDescription scene = load();
    scene.render.samples = 2;
    SceneCache cache;
    PrepareStats ignored;
    const Scene frame = prepare_frame(scene, scene.first_frame + 12, {false, true}, cache, ignored);
    for (const EstimatorKind estimator : {EstimatorKind::Path, EstimatorKind::Restir}) {
        scene.render.estimator = estimator;
        // A scene's own limit of events is its choice; beyond it every path ends by itself.
        for (const int bounces : {scene.render.path.max_bounces, 10'000}) {
            RenderDescription render = scene.render;
            render.path.max_bounces = bounces;
            FrameHistory history;
            FrameStats stats;
            (void)render_frame(frame, render, {}, history, nullptr, stats);
            EXPECT_EQ(stats.dropped_non_finite, 0);
            EXPECT_EQ(stats.tracking.majorant_violations, 0);
            if (bounces != 10'000) continue;
            EXPECT_EQ(stats.truncation.paths, 0);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(shipped_scenes()),
                         [](const auto& scene) { return scene.param; });

}  // namespace mote
