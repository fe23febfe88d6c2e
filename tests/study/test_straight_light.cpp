#include "study/straight_light.h"

#include <cmath>

#include <gtest/gtest.h>

#include "runs/methods.h"
#include "runs/play_frames.h"
#include "study/verify_scene.h"
#include "support/scene_files.h"

namespace mote {
namespace {

/// Two pixels; R, G and B are the sum of the parts.
LayeredImage image_of(const std::vector<std::pair<std::string, float>>& parts)
{
    LayeredImage image;
    image.width = 2;
    image.height = 1;
    float sum = 0.0f;
    for (const auto& [name, value] : parts) sum += value;
    for (const char* color : {"R", "G", "B"}) {
        image.channels.push_back({color, PixelType::Float, Buffer2D<float>(2, 1, sum)});
        for (const auto& [name, value] : parts) {
            image.channels.push_back(
                {name + "." + color, PixelType::Float, Buffer2D<float>(2, 1, value)});
        }
    }
    return image;
}

TEST(StraightLight, IsWhatNoEventChanges)
{
    const LayeredImage with =
        image_of({{"volume_direct", 1.0f}, {"background", 2.0f}, {"emission", 3.0f}});
    const LayeredImage without =
        image_of({{"volume_direct", 1.0f}, {"background", 2.0f}, {"emission", 3.0f + 1e-6f}});
    const std::vector<std::string> all{"volume_direct", "background", "emission"};
    EXPECT_EQ(straight_parts(with, without, all), std::vector<std::string>{"background"});
    EXPECT_EQ(straight_parts(with, with, all),
              (std::vector<std::string>{"background", "emission"}));
    EXPECT_EQ(straight_parts(with, with, {"emission"}), std::vector<std::string>{"emission"});
}

TEST(StraightLight, IsReplacedInItsLayerAndInThePicture)
{
    LayeredImage image = image_of({{"volume_direct", 1.0f}, {"background", 2.0f}});
    replace_parts(image, image_of({{"background", 0.5f}}), {"background"});
    EXPECT_EQ(image.find("background.G")->data.at(1, 0), 0.5f);
    EXPECT_EQ(image.find("volume_direct.G")->data.at(1, 0), 1.0f);
    EXPECT_EQ(image.find("G")->data.at(1, 0), 1.5f);
    EXPECT_EQ(only_parts(image, {"background"}).find("B")->data.at(0, 0), 0.5f);
    EXPECT_EQ(without_parts(image, {"background"}).find("B")->data.at(0, 0), 1.0f);
}

TEST(StraightLight, TakesThePassesOfLeastVarianceTimesTime)
{
    // (rest + pass / n) (run + n t) is least at n = sqrt(pass run / (rest t)).
    EXPECT_EQ(best_straight_passes(9.0, 0.1, 1.0, 10.0), 30);
    EXPECT_EQ(best_straight_passes(1e-6, 1.0, 1.0, 1.0), 1);
    EXPECT_EQ(best_straight_passes(1.0, 1.0, 0.0, 1e9), 1024);
    EXPECT_EQ(best_straight_passes(1.0, 0.01, 0.0, 1.0), 150);  // runs stay short
}

/// Lamps smaller than a pixel, in view, beside others that the smoke is lit by.
const char* const tiny_lamps = R"(
[render]
width = 8
height = 6
bounces = 1
[[volumes]]
procedural = { type = "puff", voxel_size = 0.2 }
density_scale = 2
[[lights]]
type = "sphere"
count = 40
spread = [2, 1, 1]
radius = 0.03
strength = 600
[[objects]]
file = "floor.obj"
)";
const char* const floor_mesh = "v -3 -1 -3\nv -3 -1 3\nv 3 -1 3\nv 3 -1 -3\nf 1 2 3 4\n";

class TinyLamps : public testing::Test {
  protected:
    TinyLamps()
    {
        folder.write("floor.obj", floor_mesh);
        scene = load_scene(folder.write("lamps.toml", tiny_lamps), {"render.restir.reuse=\"off\""});
        params.study.question.budget = 0.1;
        params.study.question.tile_budget = 0.9;
        params.study.question.alpha = 1e-6;
        params.study.most_runs = 20;
        params.passes = 1;
        params.temporal = false;
    }

    TemporaryFolder folder;
    SceneDescription scene;
    VerifyParams params;
};

/// Rare hits of bright lamps make the noise. (How many passes depends on how long they take.)
TEST_F(TinyLamps, InViewLeaveTheirNoiseToPassesOfTheirOwn)
{
    const VerifyResult result = verify_scene(scene, params, {});
    EXPECT_EQ(result.straight.parts, std::vector<std::string>{"background"});
    EXPECT_GE(result.straight.tested_passes, 1);
    EXPECT_GE(result.straight.reference_passes, 1);
    EXPECT_EQ(result.study.last().runs, 20);
}

}  // namespace
}  // namespace mote
