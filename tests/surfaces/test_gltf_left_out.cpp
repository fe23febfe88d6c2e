#include <gtest/gtest.h>

#include "surfaces/gltf/gltf_convert.h"

namespace mote {
namespace {

/// What a picture lacks is told, what is shown is not.
TEST(Gltf, TellsWhatIsLeftOut)
{
    tinygltf::Model model;
    model.extensionsUsed = {"KHR_texture_transform", "KHR_materials_emissive_strength"};
    model.meshes.resize(1);
    model.meshes[0].primitives.resize(1);
    EXPECT_TRUE(left_out(model).empty());
    model.extensionsUsed.emplace_back("KHR_materials_clearcoat");
    model.meshes[0].primitives[0].attributes["COLOR_0"] = 0;
    const std::vector<std::string> list = left_out(model);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0], "vertex colours (COLOR_0)");
    EXPECT_EQ(list[1], "KHR_materials_clearcoat");
}

}  // namespace
}  // namespace mote
