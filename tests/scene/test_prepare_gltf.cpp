#include <gtest/gtest.h>

#include "scene/matrix_motion.h"
#include "scene/prepare.h"
#include "support/expect_error.h"
#include "support/jpeg_bytes.h"
#include "support/png_bytes.h"
#include "support/scene_files.h"
#include "surfaces/gltf_text.h"
#include "surfaces/mesh_bvh.h"
#include "surfaces/meshes.h"

// glTF files in scenes: objects in their places at a frame's time, materials, cameras.
namespace mote {
namespace {

const Mesh quad = test::quad_mesh(Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f), Vec3(0.0f, 1.0f, 0.0f));

/// A quad that is cut out and one that glows and moves from x = 0 at 1 s to x = 4 at 2 s, on a node
/// that is turned; a camera that looks at them from z = 3.
test::GltfText yard()
{
    test::GltfText text;
    text.add_mesh(quad, 0);
    text.add_mesh(quad, 1);
    const double half = std::sqrt(0.5);
    text.json["nodes"] = {{{"name", "leaf"}, {"mesh", 0}, {"translation", {0, 0, -1}}},
                          {{"name", "turned"}, {"rotation", {0, 0, half, half}}, {"children", {2}}},
                          {{"name", "lamp"}, {"mesh", 1}},
                          {{"name", "mover"}, {"mesh", 0}},
                          {{"name", "view"}, {"camera", 0}, {"translation", {0, 0, 3}}}};
    text.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}},
        {{"type", "orthographic"},
         {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 1}}}}};
    text.json["images"] = {
        {{"uri", "data:image/png;base64," + test::base64(test::text_of(test::rgba_png))}}};
    text.json["textures"] = {{{"source", 0}}};
    text.json["materials"] = {
        {{"name", "green"},
         {"alphaMode", "MASK"},
         {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}},
        {{"emissiveFactor", {1, 0.5, 0.25}}, {"emissiveTexture", {{"index", 0}}}}};
    const int times = text.add_floats({1, 2}, "SCALAR", 1);
    const int moves = text.add_floats({0, 0, 0, 4, 0, 0}, "VEC3", 3);
    const auto channel = [](int node) {
        return nlohmann::json{{"sampler", 0},
                              {"target", {{"node", node}, {"path", "translation"}}}};
    };
    text.json["animations"] = {{{"samplers", {{{"input", times}, {"output", moves}}}},
                                {"channels", {channel(2), channel(3)}}}};
    return text;
}

struct Folder {
    TemporaryFolder folder;
    SceneDescription description;
    SceneCache cache;
    PrepareStats stats;

    Folder(const test::GltfText& text, const std::string& scene)
    {
        folder.write("yard.glb", text.glb());
        description = load_scene(folder.write("scene.toml", scene));
    }
    Scene prepare(int frame)
    {
        stats = {};
        PrepareNeeds needs;
        needs.velocity = true;
        return prepare_frame(description, frame, needs, cache, stats);
    }
};

constexpr const char* yard_scene = R"(
fps = 10
[camera]
file = "yard.glb"
shutter_open = -0.5
shutter_close = 0.5
[[objects]]
name = "yard"
file = "yard.glb"
transform = { translate = [0, 0, -2], scale = 2 }
)";

TEST(PrepareGltf, PartsStandWhereTheirNodesAreAtTheFramesTime)
{
    Folder f(yard(), yard_scene);
    const Scene scene = f.prepare(15);
    ASSERT_TRUE(scene.surfaces);
    ASSERT_EQ(scene.surfaces->objects.size(), 3u);
    EXPECT_EQ(scene.surfaces->objects[0].name, "yard/leaf");
    EXPECT_EQ(scene.surfaces->objects[1].name, "yard/lamp");
    const auto& instances = scene.surfaces->bvh->instances();
    // Twice the node's place, 2 m back.
    EXPECT_FALSE(instances[0].world_from_object.is_moving());
    EXPECT_EQ(instances[0].world_from_object.keys[0].translate, Vec3d(0.0, 0.0, -4.0));
    // At 1.5 s, half way of 4 m, along the turned node's x, which is y. It glows: it stands still.
    EXPECT_FALSE(instances[1].world_from_object.is_moving());
    EXPECT_LT(glm::length(instances[1].world_from_object.keys[0].translate - Vec3d(0.0, 4.0, -2.0)),
              1e-6);
    // The other one moves 0.4 m in the 0.1 s that the shutter is open, twice that here.
    const MovingTransform& moving = instances[2].world_from_object;
    ASSERT_TRUE(moving.is_moving());
    EXPECT_NEAR(moving.keys.front().translate.x, 3.6, 1e-6);
    EXPECT_NEAR(moving.at(0.25f).translate.x, 3.8, 1e-6);
    EXPECT_NEAR(moving.keys.back().translate.x, 4.4, 1e-6);
    ASSERT_TRUE(scene.next);
    ASSERT_EQ(scene.next->world_from_surface.size(), 3u);
    EXPECT_NEAR(scene.next->world_from_surface[2].keys.front().translate.x, 4.4, 1e-6);
    EXPECT_EQ(instances[0].mesh, instances[2].mesh) << "a mesh has one tree";
    EXPECT_EQ(f.stats.meshes_built, 2);

    EXPECT_TRUE(scene.surfaces->has_cuts);
    ASSERT_NE(scene.surfaces->textures_of(0), nullptr);
    EXPECT_EQ(scene.surfaces->textures_of(0)->alpha_cutoff, 0.5f);
    EXPECT_EQ(scene.surfaces->material(1).emission, Spectrum(1.0f, 0.5f, 0.25f));
    EXPECT_EQ(scene.first_light_of_object, (std::vector<int>{-1, 0, -1}));
    EXPECT_EQ(scene.lights.size(), 2u);

    const Scene later = f.prepare(16);
    EXPECT_EQ(f.stats.meshes_built, 0);
    EXPECT_EQ(f.stats.meshes_reused, 2);
    EXPECT_EQ(later.surfaces->textures_of(0)->color, scene.surfaces->textures_of(0)->color);
}

TEST(PrepareGltf, CameraOfTheFile)
{
    Folder f(yard(), yard_scene);
    const Scene scene = f.prepare(15);
    const Ray ray = generate_ray(scene.camera, Vec2(320.0f, 180.0f), Vec2(0.5f), 0.0f);
    EXPECT_EQ(ray.o, Vec3(0.0f, 0.0f, 3.0f)) << "objects' transforms do not move the camera";
    EXPECT_LT(glm::length(ray.d - Vec3(0.0f, 0.0f, -1.0f)), 1e-6f);
    EXPECT_NEAR(scene.camera.tan_half_fov_y, std::tan(0.5f), 1e-6f);

    Folder named(yard(), "[camera]\nfile = { path = \"yard.glb\", name = \"vieew\" }\n");
    expect_error([&] { (void)named.prepare(1); }, ExitCode::Input,
                 {"yard.glb", "no camera \"vieew\" (did you mean \"view\"?)"});
    test::GltfText flat = yard();
    flat.json["nodes"][4]["camera"] = 1;
    Folder orthographic(flat, yard_scene);
    expect_error([&] { (void)orthographic.prepare(1); }, ExitCode::Input,
                 {"yard.glb", "orthographic"});
    test::GltfText none = yard();
    none.json["nodes"][4].erase("camera");
    Folder without(none, yard_scene);
    expect_error([&] { (void)without.prepare(1); }, ExitCode::Input, {"yard.glb", "no camera"});
}

TEST(PrepareGltf, AMaterialOfTheSceneReplacesThoseOfTheFile)
{
    Folder f(yard(), std::string(yard_scene) + "material = { color = [1, 0, 0] }\n");
    const Scene scene = f.prepare(15);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(scene.surfaces->material(i).base_color, Spectrum(1.0f, 0.0f, 0.0f));
        EXPECT_EQ(scene.surfaces->textures_of(i), nullptr);
    }
    EXPECT_TRUE(scene.lights.empty());
}

TEST(PrepareGltf, ShearedMeshesAreBakedAndHiddenOnesLeftOut)
{
    test::GltfText text = yard();
    text.json["nodes"][1]["scale"] = {3, 1, 1};
    text.json["nodes"][2] = {{"mesh", 0}, {"rotation", {0, 0, std::sin(0.5), std::cos(0.5)}}};
    text.json["nodes"][0]["scale"] = {0, 0, 0};
    text.json["animations"][0]["channels"].erase(0);
    Folder f(text, yard_scene);
    const Scene scene = f.prepare(1);
    ASSERT_EQ(scene.surfaces->objects.size(), 2u);
    // Area is kept by rotations and tripled by the scale; the object's scale squares.
    const Mesh& sheared = scene.surfaces->mesh(0);
    float area = 0.0f;
    for (size_t i = 0; i < sheared.triangles.size(); ++i) {
        area += 0.5f * glm::length(area_normal(sheared, i));
    }
    EXPECT_NEAR(area, 4.0f * 3.0f, 1e-4f);
    EXPECT_EQ(scene.surfaces->bvh->instances()[0].world_from_object, MovingTransform{});
    (void)f.prepare(2);
    EXPECT_EQ(f.stats.meshes_built, 0) << "baked once";

    text.json["animations"][0]["channels"][0]["target"]["node"] = 2;
    Folder moving(text, yard_scene);
    expect_error([&] { (void)moving.prepare(15); }, ExitCode::Input, {"yard.glb", "sheared"});
}

TEST(PrepareGltf, MatricesAreTakenApart)
{
    Trs trs;
    trs.translate = Vec3d(1.0, -2.0, 3.0);
    trs.rotate = glm::angleAxis(2.0, glm::normalize(Vec3d(1.0, 2.0, -0.5)));
    for (const double mirror : {1.0, -1.0}) {
        trs.scale = Vec3d(mirror * 0.5, 2.0, 3.0);
        const auto found = decompose(matrix(trs));
        ASSERT_TRUE(found);
        for (int c = 0; c < 4; ++c) {
            EXPECT_LT(glm::length(matrix(*found)[c] - matrix(trs)[c]), 1e-12);
        }
    }
    Trs turned;
    turned.rotate = glm::angleAxis(0.3, Vec3d(0.0, 0.0, 1.0));
    EXPECT_FALSE(decompose(matrix(trs) * matrix(turned)));
    trs.scale.y = 0.0;
    EXPECT_TRUE(is_flat(matrix(trs)));
    EXPECT_FALSE(decompose(matrix(trs)));
}

TEST(PrepareGltf, TheGardenThatIsShipped)
{
    const SceneDescription garden =
        load_scene(std::string(MOTE_SOURCE_DIR) + "/scenes/garden.toml");
    SceneCache cache;
    PrepareStats stats;
    const Scene scene = prepare_frame(garden, 12, {}, cache, stats);
    ASSERT_TRUE(scene.surfaces);
    EXPECT_EQ(scene.surfaces->objects.size(), 16u);  // floor, 3 lanterns with lids, 9 leaves
    EXPECT_EQ(stats.meshes_built, 4);
    EXPECT_TRUE(scene.surfaces->has_cuts);
    ASSERT_EQ(scene.lights.size(), 1u + 3u * 448u);
    EXPECT_TRUE(std::holds_alternative<SpotLight>(scene.lights[0]));
    EXPECT_TRUE(std::get<TriangleLight>(scene.lights[1]).texture);
    EXPECT_NEAR(scene.camera.tan_half_fov_y, std::tan(0.3f), 1e-6f);
    // They swing: the middle one is elsewhere half a second later.
    const Scene later = prepare_frame(garden, 24, {}, cache, stats);
    EXPECT_NE(std::get<TriangleLight>(scene.lights[500]).corner,
              std::get<TriangleLight>(later.lights[500]).corner);
}

TEST(PrepareGltf, MissingPicturesAreNamed)
{
    test::GltfText text = yard();
    text.json["images"] = {{{"uri", "skin.png"}}};
    Folder f(text, yard_scene);
    expect_error([&] { (void)f.prepare(1); }, ExitCode::Input,
                 {"yard.glb: material \"green\": ", "skin.png"});
    text.json["images"] = {{{"uri", "skin.webp"}}};
    Folder webp(text, yard_scene);
    webp.folder.write("skin.webp", "no picture");
    expect_error([&] { (void)webp.prepare(1); }, ExitCode::Input,
                 {"skin.webp", "only .exr, .hdr, .png and .jpg"});
    text.json["images"] = {{{"uri", "skin.jpg"}}};
    Folder jpeg(text, yard_scene);
    jpeg.folder.write("skin.jpg", test::text_of(test::rgb_jpeg));
    (void)jpeg.prepare(1);
}

TEST(PrepareGltf, CamerasOfOtherFilesAreRefused)
{
    Folder f(yard(), "[camera]\nfile = \"yard.obj\"\n");
    f.folder.write("yard.obj", "v 0 0 0\n");
    expect_error([&] { (void)f.prepare(1); }, ExitCode::Input,
                 {"yard.obj: the camera's file must be glTF (.gltf, .glb)"});
}

}  // namespace
}  // namespace mote
