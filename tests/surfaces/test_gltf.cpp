#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/png_bytes.h"
#include "support/temporary_folder.h"
#include "surfaces/gltf/gltf_scene.h"
#include "surfaces/gltf_text.h"
#include "surfaces/meshes.h"

// glTF files: what is read of them, and what is said of bad ones.
namespace mote {
namespace {

using Json = nlohmann::json;

GltfScene load(const std::string& name, const std::string& bytes)
{
    const TemporaryFolder folder;
    return load_gltf(folder.write(name, bytes));
}

const Mesh box = test::box_mesh(Vec3(-1.0f), Vec3(1.0f, 2.0f, 3.0f));
const Mesh quad = test::quad_mesh(Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f), Vec3(0.0f, 2.0f, 0.0f));

void expect_same(const Mesh& a, const Mesh& b)
{
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    for (size_t i = 0; i < a.triangles.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(a.positions[a.triangles[i][c]], b.positions[b.triangles[i][c]]);
        }
    }
    EXPECT_EQ(a.uvs, b.uvs);
    EXPECT_EQ(a.normals, b.normals);
}

TEST(Gltf, MeshesNodesAndCamerasOfBothForms)
{
    test::GltfText text;
    text.add_mesh(box);
    text.add_mesh(quad);
    text.json["cameras"] = {{{"type", "perspective"},
                             {"name", "main"},
                             {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    text.json["nodes"] = {
        {{"name", "root"}, {"translation", {1, 2, 3}}, {"children", {2, 1}}},
        {{"name", "turned"},
         {"mesh", 0},
         {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
         {"scale", {2, 2, 2}}},
        {{"mesh", 0}, {"camera", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}},
        {{"name", "hidden"}, {"mesh", 1}}};
    text.json["scenes"] = {{{"nodes", {3}}}, {{"nodes", {0}}}};
    text.json["scene"] = 1;
    for (const bool is_binary : {false, true}) {
        const GltfScene scene = is_binary ? load("a.glb", text.glb()) : load("a.gltf", text.gltf());
        ASSERT_EQ(scene.parts.size(), 1u) << "the quad is not in the default scene";
        expect_same(scene.parts[0].mesh, box);
        ASSERT_EQ(scene.nodes.size(), 3u);
        EXPECT_EQ(scene.nodes[1].parts, std::vector<int>{0});  // in the order of children
        EXPECT_EQ(scene.nodes[2].name, "turned");
        EXPECT_EQ(scene.nodes[2].parts, std::vector<int>{0});
        EXPECT_EQ(world_from_node(scene, 1, 0.0)[3], glm::dvec4(6.0, 8.0, 10.0, 1.0));
        const glm::dvec4 p = world_from_node(scene, 2, 0.0) * glm::dvec4(1.0, 0.0, 0.0, 1.0);
        EXPECT_LT(glm::length(p - glm::dvec4(1.0, 2.0, 1.0, 1.0)), 1e-6);
        ASSERT_EQ(scene.cameras.size(), 1u);
        EXPECT_NEAR(scene.cameras[0].fov_y, glm::degrees(0.5), 1e-9);
        EXPECT_EQ(scene.nodes[1].camera, 0);
        EXPECT_FALSE(is_animated(scene, 2));
    }
}

TEST(Gltf, Materials)
{
    test::GltfText text;
    text.add_mesh(quad, 0);
    text.json["nodes"] = {{{"mesh", 0}}};
    text.json["images"] = {
        {{"uri", "skin%20a.png"}},
        {{"uri", "data:image/png;base64," + test::base64(test::text_of(test::rgba_png))}}};
    text.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    text.json["textures"] = {{{"source", 0}}, {{"source", 1}, {"sampler", 0}}};
    Json pbr = {{"baseColorFactor", {0.5, 0.25, 1, 0.75}},
                {"metallicFactor", 0.5},
                {"roughnessFactor", 0.25},
                {"baseColorTexture", {{"index", 1}}},
                {"metallicRoughnessTexture", {{"index", 0}}}};
    text.json["materials"] = {
        {{"pbrMetallicRoughness", pbr},
         {"alphaMode", "MASK"},
         {"alphaCutoff", 0.3},
         {"doubleSided", true},
         {"normalTexture", {{"index", 0}, {"scale", 2}}},
         {"emissiveTexture", {{"index", 1}}},
         {"emissiveFactor", {1, 0.5, 0}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}},
        {{"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_ior", {{"ior", 1.33}}}}},
         {"pbrMetallicRoughness", {{"roughnessFactor", 0}}}},
        {{"alphaMode", "BLEND"}}};
    text.json["extras"] = {{"uri", "https://example.org/"}};
    const TemporaryFolder folder;
    const GltfScene scene = load_gltf(folder.write("a.gltf", text.gltf()));
    ASSERT_EQ(scene.materials.size(), 4u);
    const GltfMaterial& m = scene.materials[0];
    EXPECT_EQ(m.look.kind, MaterialKind::MetallicRoughness);
    EXPECT_EQ(m.look.base_color, Spectrum(0.5f, 0.25f, 1.0f));
    EXPECT_EQ(m.look.metallic, 0.5f);
    EXPECT_EQ(m.look.roughness, 0.25f);
    EXPECT_EQ(m.look.emission, Spectrum(8.0f, 4.0f, 0.0f));
    EXPECT_TRUE(m.look.two_sided);
    EXPECT_EQ(m.opacity, 0.75f);
    EXPECT_EQ(m.alpha_cutoff, 0.3f);
    EXPECT_EQ(m.normal_strength, 2.0f);
    EXPECT_EQ(m.color.image, 1);
    EXPECT_EQ(m.color.sampler, (TextureSampler{TextureWrap::Clamp, TextureWrap::Mirror, true}));
    EXPECT_EQ(m.metallic_roughness.image, 0);
    EXPECT_EQ(m.metallic_roughness.sampler, TextureSampler{});
    EXPECT_EQ(m.normal.image, 0);
    EXPECT_EQ(m.emission.image, 1);
    EXPECT_EQ(scene.materials[1].look.kind, MaterialKind::Dielectric);
    EXPECT_EQ(scene.materials[1].look.ior, 1.33f);
    EXPECT_EQ(scene.materials[1].look.roughness, 0.0f);
    EXPECT_EQ(scene.materials[1].alpha_cutoff, 0.0f);
    EXPECT_EQ(scene.materials[2].alpha_cutoff, 0.5f);
    EXPECT_EQ(scene.materials[3].look.metallic, 1.0f) << "glTF's default";
    ASSERT_EQ(scene.images.size(), 2u);
    EXPECT_EQ(scene.images[0].path, folder.file("skin a.png"));
    EXPECT_TRUE(scene.images[0].bytes.empty());
    EXPECT_EQ(scene.images[1].bytes, test::rgba_png);
    // What the file depends on, as far as it is there; notes of other programs do not count.
    EXPECT_EQ(gltf_files(folder.file("a.gltf")).size(), 1u);
    folder.write("skin a.png", test::text_of(test::rgba_png));
    EXPECT_EQ(gltf_files(folder.file("a.gltf")).size(), 2u);
}

TEST(Gltf, IndicesModesAndNumberTypes)
{
    // Four corners as a strip, a fan and without indices; as shorts normalised; strided; sparse.
    test::GltfText text;
    const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const int p = text.add_floats(corners, "VEC3", 3);
    const int u8 = text.add(std::vector<uint8_t>{0, 1, 3, 2}, 5121, "SCALAR", 1);
    const int u32 = text.add(std::vector<uint32_t>{0, 1, 2, 2, 1, 3}, 5125, "SCALAR", 1);
    const int shorts = text.add(
        std::vector<int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0, 32767, 32767, 0, 0}, 5122,
        "VEC3", 4);
    text.json["bufferViews"].back()["byteStride"] = 8;
    text.json["accessors"].back()["normalized"] = true;
    const int sparse = text.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 9, 9}, "VEC3", 3);
    const int places = text.add(std::vector<uint16_t>{3}, 5123, "SCALAR", 1);
    const int values = text.add_floats({1, 1, 0}, "VEC3", 3);
    text.json["accessors"][static_cast<size_t>(sparse)]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", places}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}}}};
    const auto primitive = [](int position, int indices, int mode) {
        Json out = {{"attributes", {{"POSITION", position}}}, {"mode", mode}};
        if (indices >= 0) out["indices"] = indices;
        return out;
    };
    text.json["meshes"] = {
        {{"primitives",
          {primitive(p, -1, 5), primitive(p, u8, 6), primitive(p, u32, 4),
           primitive(shorts, u32, 4), primitive(sparse, u32, 4), primitive(p, -1, 1)}}}};
    text.json["nodes"] = {{{"mesh", 0}}};
    const GltfScene scene = load("a.glb", text.glb());
    ASSERT_EQ(scene.parts.size(), 5u) << "lines are left out";
    for (const GltfPart& part : scene.parts) {
        ASSERT_EQ(part.mesh.triangles.size(), 2u);
        for (size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(area_normal(part.mesh, i), Vec3(0.0f, 0.0f, 1.0f));
        }
        EXPECT_EQ(part.mesh.bounds.hi, Vec3(1.0f, 1.0f, 0.0f));
    }
}

TEST(Gltf, TextureTransformsAndSets)
{
    test::GltfText text;
    Mesh mesh = quad;
    const int mesh_index = text.add_mesh(mesh, 0);
    const int second = text.add_floats({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2", 2);
    text.json["meshes"][static_cast<size_t>(mesh_index)]["primitives"][0]["attributes"]
             ["TEXCOORD_1"] = second;
    text.json["images"] = {{{"uri", "a.png"}}};
    text.json["textures"] = {{{"source", 0}}};
    const Json transform = {
        {"offset", {0.5, 0.25}}, {"scale", {2, 4}}, {"rotation", std::numbers::pi / 2.0}};
    text.json["materials"] = {{{"pbrMetallicRoughness",
                                {{"baseColorTexture",
                                  {{"index", 0},
                                   {"texCoord", 1},
                                   {"extensions", {{"KHR_texture_transform", transform}}}}}}}}};
    text.json["nodes"] = {{{"mesh", 0}}};
    const GltfScene scene = load("a.gltf", text.gltf());
    ASSERT_EQ(scene.parts.size(), 1u);
    // The file's (1, 0): scaled (2, 0), a quarter turn (0, -2), shifted (0.5, -1.75), v upwards.
    EXPECT_LT(glm::length(scene.parts[0].mesh.uvs[1] - Vec2(0.5f, 2.75f)), 1e-5f);
    // (0, 1): scaled (0, 4), turned (4, 0), shifted (4.5, 0.25).
    EXPECT_LT(glm::length(scene.parts[0].mesh.uvs[3] - Vec2(4.5f, 0.75f)), 1e-5f);
}

TEST(Gltf, AnimationsOfEveryInterpolation)
{
    test::GltfText text;
    text.add_mesh(box);
    text.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"mesh", 0}}, {{"mesh", 0}}};
    const int times = text.add_floats({1, 2, 4}, "SCALAR", 1);
    const int moves = text.add_floats({0, 0, 0, 2, 0, 0, 2, 4, 0}, "VEC3", 3);
    const auto half = static_cast<float>(std::sqrt(0.5));
    const int turns =
        text.add_floats({0, 0, 0, 1, 0, 0, half, half, 0, 0, -half, -half}, "VEC4", 4);
    // Cubic: in-tangent, value, out-tangent; x runs 0, 1, 0 with level tangents but one.
    const int cubic = text.add_floats({0, 0, 0, 1, 1, 1, 0, 0, 0,  //
                                       0, 0, 0, 2, 1, 1, 1, 0, 0,  //
                                       0, 0, 0, 1, 1, 1, 0, 0, 0},
                                      "VEC3", 3);
    text.json["animations"] = {
        {{"samplers",
          {{{"input", times}, {"output", moves}},
           {{"input", times}, {"output", turns}},
           {{"input", times}, {"output", cubic}, {"interpolation", "CUBICSPLINE"}},
           {{"input", times}, {"output", moves}, {"interpolation", "STEP"}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
           {{"sampler", 1}, {"target", {{"node", 1}, {"path", "rotation"}}}},
           {{"sampler", 2}, {"target", {{"node", 1}, {"path", "scale"}}}},
           {{"sampler", 3}, {"target", {{"node", 2}, {"path", "translation"}}}}}}}};
    const GltfScene scene = load("a.glb", text.glb());
    ASSERT_EQ(scene.nodes.size(), 3u);
    const auto at = [&](int node, double t) { return Vec3d(world_from_node(scene, node, t)[3]); };
    EXPECT_EQ(at(0, 0.0), Vec3d(0.0)) << "before the first key";
    EXPECT_EQ(at(0, 1.5), Vec3d(1.0, 0.0, 0.0));
    EXPECT_EQ(at(0, 3.0), Vec3d(2.0, 2.0, 0.0));
    EXPECT_EQ(at(0, 9.0), Vec3d(2.0, 4.0, 0.0)) << "after the last key";
    EXPECT_EQ(at(2, 1.999), Vec3d(0.0));
    EXPECT_EQ(at(2, 2.0), Vec3d(2.0, 0.0, 0.0));
    EXPECT_EQ(at(1, 3.0), at(0, 3.0)) << "children go along";
    const auto x_axis = [&](double t) { return Vec3d(world_from_node(scene, 1, t)[0]); };
    // 45 degrees half way to a quarter turn; scale 1.5 half way by the cubic without tangents.
    EXPECT_NEAR(glm::length(x_axis(1.5)), 1.5, 1e-6);
    EXPECT_NEAR(x_axis(1.5).y / x_axis(1.5).x, 1.0, 1e-6);
    // The third key is the second's rotation with the other sign: nothing turns.
    EXPECT_NEAR(x_axis(3.0).x, 0.0, 1e-6);
    // Cubic with an out-tangent of 1 over 2 s: h = (1.5 + 0.125 * 2) at the middle.
    EXPECT_NEAR(glm::length(x_axis(3.0)), 1.5 + 0.125 * 2.0, 1e-6);
    EXPECT_TRUE(is_animated(scene, 1));
}

/// A file of one quad, changed by `change`; the message that reading it gives.
template <class Change>
std::string message_of(Change&& change)
{
    test::GltfText text;
    text.add_mesh(quad, 0);
    text.json["nodes"] = {{{"mesh", 0}}};
    text.json["materials"] = {Json::object()};
    change(text);
    return error_message([&] { (void)load("bad.gltf", text.gltf()); });
}

TEST(Gltf, ErrorsNameTheFileAndTheReason)
{
    const struct {
        std::function<void(test::GltfText&)> change;
        const char* message;
    } cases[] = {
        {[](auto& t) {
             t.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
             t.json["scenes"] = {{{"nodes", {0}}}};
         },
         "node 0 is its own ancestor"},
        {[](auto& t) {
             t.json["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}};
         },
         "node 1 is its own ancestor or has two parents"},
        {[](auto& t) { t.json["nodes"][0]["mesh"] = 7; }, "mesh 7 does not exist, there are 1"},
        {[](auto& t) { t.json["nodes"][0]["children"] = {9}; }, "node 9 does not exist"},
        {[](auto& t) {
             t.json["scene"] = 3;
             t.json["scenes"] = {{{"nodes", {0}}}};
         },
         "scene 3 does not exist"},
        {[](auto& t) { t.json["meshes"][0]["primitives"][0]["material"] = 4; },
         "material 4 does not exist"},
        {[](auto& t) { t.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 44; },
         "accessor 44 does not exist"},
        {[](auto& t) { t.json["accessors"][0]["count"] = 5; },
         "accessor 0 (positions): 5 elements do not fit into the 48 bytes"},
        {[](auto& t) { t.json["accessors"][0]["count"] = uint64_t{1} << 62u; }, "do not fit into"},
        {[](auto& t) { t.json["accessors"][0]["byteOffset"] = 40; }, "do not fit into"},
        {[](auto& t) { t.json["accessors"][0]["type"] = "VEC2"; },
         "accessor 0 (positions) has 2 components, 3 are needed"},
        {[](auto& t) { t.json["accessors"][1]["componentType"] = 5126; }, "accessor 1 (indices)"},
        {[](auto& t) { t.json["bufferViews"][0]["byteLength"] = 4000; },
         "buffer view 0 lies outside of the"},
        {[](auto& t) { t.json["bufferViews"][0]["buffer"] = 2; }, "buffer 2 does not exist"},
        {[](auto& t) { t.json["bufferViews"][0]["byteStride"] = 4; }, "its elements overlap"},
        {[](auto& t) { std::memcpy(&t.buffer[48], "\x09\0", 2); },
         "uses vertex 9, but there are only 4"},
        {[](auto& t) {
             t.json["materials"][0]["normalTexture"] = {{"index", 2}};
         },
         "texture 2 does not exist"},
        {[](auto& t) {
             t.json["images"] = {{{"uri", "../secret.png"}}};
         },
         "uri \"../secret.png\" leads out of the file's folder"},
        {[](auto& t) {
             t.json["images"] = {{{"uri", "a/%2e%2e/%2E%2E/b.png"}}};
         },
         "leads out of the file's folder"},
        {[](auto& t) {
             t.json["images"] = {{{"uri", "/etc/hostname.png"}}};
         },
         "leads out of the file's folder"},
        {[](auto& t) {
             t.json["images"] = {{{"uri", "https://example.org/a.png"}}};
         },
         "leads out of the file's folder"},
        {[](auto& t) { t.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
         "needs the extension KHR_draco_mesh_compression"},
        {[](auto& t) { t.json["accessors"][2]["count"] = 3; },
         "accessor 2 (texture coordinates) has 3 elements, but vertex 3 is used"},
        {[](auto& t) {
             // A small file that means a large scene.
             const Json primitive = t.json["meshes"][0]["primitives"][0];
             for (int i = 0; i < 60'000; ++i)
                 t.json["meshes"][0]["primitives"].push_back(primitive);
         },
         "use the same data too often"},
        {[](auto& t) {
             for (int i = 0; i < 2'000; ++i) {
                 t.json["nodes"].push_back({{"children", {i + 2}}});
             }
             t.json["nodes"].push_back(Json::object());
         },
         "nested more than 1000 deep"},
        {[](auto& t) {
             Json deep = 1;
             for (int i = 0; i < 100; ++i) deep = Json::array({deep});
             t.json["extras"] = deep;
         },
         "nested more than 64 deep"},
        {[](auto& t) { t.json["asset"]["version"] = 3; }, "damaged or incomplete"},
        {[](auto& t) { t.json["asset"]["version"] = "1.0"; }, "glTF version 1.0, mote reads 2"},
        {[](auto& t) { t.json["extensionsRequired"] = {"KHR_materials_unlit"}; },
         "needs the extension KHR_materials_unlit, which mote does not show"},
        {[](auto& t) { t.json["extensionsRequired"] = {"KHR_lights_punctual"}; },
         "needs the extension KHR_lights_punctual"},
    };
    for (const auto& c : cases) {
        const std::string message = message_of(c.change);
        EXPECT_NE(message.find(c.message), std::string::npos) << message;
        EXPECT_NE(message.find("bad.gltf: "), std::string::npos) << message;
    }
    EXPECT_NE(error_message([] {
                  (void)load("b.gltf", "{\n \"asset\": }");
              }).find("b.gltf:2:11: not valid JSON"),
              std::string::npos);
    EXPECT_NE(error_message([] { (void)load("b.glb", "glTF\2\0\0\0"); }).find("truncated"),
              std::string::npos);
    EXPECT_NE(error_message([] {
                  (void)load_gltf("/nowhere/a.glb");
              }).find("/nowhere/a.glb: No such file"),
              std::string::npos);
}

TEST(Gltf, BuffersInFilesBesideIt)
{
    test::GltfText text;
    text.add_mesh(quad);
    text.json["nodes"] = {{{"mesh", 0}}};
    text.json["buffers"] = {{{"byteLength", text.buffer.size()}, {"uri", "data.bin"}}};
    const TemporaryFolder folder;
    const std::string path = folder.write("a.gltf", text.json.dump());
    expect_error([&] { (void)load_gltf(path); }, ExitCode::Input, {"a.gltf: ", "data.bin"});
    folder.write("data.bin", text.buffer);
    expect_same(load_gltf(path).parts[0].mesh, quad);
    folder.write("data.bin", text.buffer.substr(1));
    expect_error([&] { (void)load_gltf(path); }, ExitCode::Input, {"a.gltf: ", "size mismatch"});
}

}  // namespace
}  // namespace mote
