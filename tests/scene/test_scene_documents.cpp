#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "scene/scene_io.h"

namespace mote {
namespace {

const std::string scenes = std::string(MOTE_SOURCE_DIR) + "/scenes/";
const std::string begin_mark = "<!-- generated from the field list; do not edit -->\n";
const std::string end_mark = "<!-- end of the generated part -->\n";

std::string read_file(const std::string& path)
{
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Writes the generated files instead of checking them: MOTE_UPDATE_DOCUMENTS=1 test_scene.
bool updates()
{
    return std::getenv("MOTE_UPDATE_DOCUMENTS") != nullptr;
}

TEST(SceneDocuments, SchemaIsUpToDate)
{
    if (updates()) std::ofstream(scenes + "scene.schema.json") << scene_schema_json();
    EXPECT_EQ(read_file(scenes + "scene.schema.json"), scene_schema_json())
        << "run it with MOTE_UPDATE_DOCUMENTS=1";
}

TEST(SceneDocuments, TablesAreUpToDate)
{
    const std::string text = read_file(scenes + "README.md");
    const size_t begin = text.find(begin_mark);
    const size_t end = text.find(end_mark);
    ASSERT_NE(begin, std::string::npos);
    ASSERT_NE(end, std::string::npos);
    const std::string expected = text.substr(0, begin + begin_mark.size()) + "\n" +
                                 scene_reference_markdown() + "\n" + text.substr(end);
    if (updates()) {
        std::ofstream(scenes + "README.md") << expected;
    } else {
        EXPECT_EQ(text, expected) << "run it with MOTE_UPDATE_DOCUMENTS=1";
    }
}

TEST(SceneDocuments, SchemaKnowsEveryTable)
{
    const auto schema = nlohmann::json::parse(scene_schema_json());
    EXPECT_EQ(schema["type"], "object");
    EXPECT_EQ(schema["additionalProperties"], false);
    const auto& camera = schema["properties"]["camera"];
    EXPECT_EQ(camera["properties"]["fov"]["maximum"], 179);
    EXPECT_EQ(camera["properties"]["fov"]["default"], 45);
    const auto& particles = schema["properties"]["particles"]["items"];
    EXPECT_EQ(particles["required"], nlohmann::json::array({"name"}));
    EXPECT_EQ(particles["properties"]["voxel_size"]["exclusiveMinimum"], 0);
    EXPECT_EQ(particles["properties"]["voxel_size"]["default"], 0.02);
    const auto& lights = schema["properties"]["lights"]["items"]["properties"];
    EXPECT_EQ(lights["type"]["enum"].size(), 6u);
}

}  // namespace
}  // namespace mote
