#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "scene/scene_io.h"

namespace mote {
namespace {

std::vector<std::string> shipped_scenes()
{
    std::vector<std::string> paths;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(MOTE_SOURCE_DIR) + "/scenes")) {
        if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
    }
    return paths;
}

TEST(ShippedScenes, AllAreValidAndExplained)
{
    const std::vector<std::string> paths = shipped_scenes();
    EXPECT_GE(paths.size(), 11u);
    for (const std::string& path : paths) {
        EXPECT_NO_THROW((void)load_scene(path)) << path;
        std::string first_line;
        std::getline(std::ifstream(path) >> std::ws, first_line);
        EXPECT_EQ(first_line.substr(0, 2), "# ") << path << " must say what it shows";
    }
}

TEST(ShippedScenes, HaveDifferentHashes)
{
    std::set<uint64_t> hashes;
    const std::vector<std::string> paths = shipped_scenes();
    for (const std::string& path : paths) hashes.insert(load_scene(path).hash);
    EXPECT_EQ(hashes.size(), paths.size());
}

TEST(ShippedScenes, DemoIsLongEnoughAndMoves)
{
    const SceneDescription demo = load_scene(std::string(MOTE_SOURCE_DIR) + "/scenes/demo.toml");
    EXPECT_GE(demo.last_frame - demo.first_frame + 1, 24);
    EXPECT_EQ(demo.render.width, 640);
    EXPECT_EQ(demo.render.height, 360);
    EXPECT_GE(demo.camera.keys.size(), 2u);
    EXPECT_EQ(demo.particles.size(), 2u);
}

}  // namespace
}  // namespace mote
