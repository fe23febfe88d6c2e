#include <gtest/gtest.h>

#include "scene/prepare.h"
#include "support/expect_error.h"
#include "support/png_bytes.h"
#include "support/scene_files.h"
#include "surfaces/mesh_bvh.h"
#include "surfaces/meshes.h"

namespace mote {
namespace {

Scene prepare(const SceneDescription& description, int frame, SceneCache& cache,
              PrepareStats& stats, bool velocity = false)
{
    PrepareNeeds needs;
    needs.velocity = velocity;
    return prepare_frame(description, frame, needs, cache, stats);
}

TEST(PrepareSurfaces, WithoutObjectsThereIsNoEmbree)
{
    const int before = embree_devices_made();
    SceneCache cache;
    PrepareStats stats;
    const SceneDescription description =
        test::load_text("[[volumes]]\nprocedural = { type = \"box\", voxel_size = 0.2 }");
    const Scene scene = prepare(description, 1, cache, stats);
    EXPECT_EQ(scene.surfaces, nullptr);
    EXPECT_TRUE(scene.first_light_of_object.empty());
    EXPECT_EQ(embree_devices_made(), before);
    EXPECT_EQ(stats.meshes_built + stats.meshes_reused + stats.instance_trees_built, 0);
    EXPECT_EQ(stats.mesh_bytes, 0u);
}

/// Two boxes, of which one moves and one glows, and one that is hidden after frame 2.
constexpr const char* scene_text = R"(
[[materials]]
name = "red"
color = [0.9, 0.1, 0.1]
[[objects]]
name = "mover"
file = "box.obj"
material = "red"
transform = [{ frame = 1 }, { frame = 2, translate = [4, 0, 0] }, { frame = 3, translate = [0, 0, 0] }]
[[objects]]
name = "lamp"
file = "box.obj"
material = { emission = 2, emission_color = [1, 0.5, 0] }
transform = { translate = [0, 5, 0], scale = 0.5 }
[[objects]]
file = { path = "late.####.ply", outside = "hide" }
[[lights]]
type = "point"
)";

struct Folder {
    TemporaryFolder folder;
    SceneDescription description;

    explicit Folder(const std::string& text)
    {
        const Mesh box = test::box_mesh(Vec3(-1.0f), Vec3(1.0f));
        folder.write("box.obj", test::obj_text(box));
        folder.write("late.0002.ply", test::ply_bytes(box, true));
        description = load_scene(folder.write("scene.toml", text));
    }
};

/// What looks the same has one number, in the order in which objects bring it.
TEST(PrepareSurfaces, EqualMaterialsAreOne)
{
    const Folder f(
        "[[objects]]\nfile = \"box.obj\"\nmaterial = { color = 0.5 }\n"
        "[[objects]]\nfile = \"box.obj\"\nmaterial = { emission = 1 }\n"
        "[[objects]]\nfile = \"box.obj\"\nmaterial = { color = 0.5 }\n");
    SceneCache cache;
    PrepareStats stats;
    const Scene scene = prepare(f.description, 1, cache, stats);
    ASSERT_EQ(scene.surfaces->objects.size(), 3u);
    EXPECT_EQ(scene.surfaces->materials.size(), 2u);
    EXPECT_EQ(scene.surfaces->material_index(0), 0);
    EXPECT_EQ(scene.surfaces->material_index(1), 1);
    EXPECT_EQ(scene.surfaces->material_index(2), 0);
    EXPECT_EQ(scene.first_light_of_object, (std::vector<int>{-1, 0, -1}));
}

TEST(PrepareSurfaces, ObjectsMaterialsAndLights)
{
    const Folder f(scene_text);
    SceneCache cache;
    PrepareStats stats;
    const Scene scene = prepare(f.description, 2, cache, stats, true);
    ASSERT_TRUE(scene.surfaces);
    ASSERT_EQ(scene.surfaces->objects.size(), 3u);
    EXPECT_EQ(scene.surfaces->objects[0].name, "mover");
    EXPECT_EQ(scene.surfaces->objects[2].name, "object 2");
    EXPECT_EQ(scene.surfaces->material(0).base_color, Spectrum(0.9f, 0.1f, 0.1f));
    EXPECT_EQ(scene.surfaces->material(1).emission, Spectrum(2.0f, 1.0f, 0.0f));
    EXPECT_EQ(scene.surfaces->material(2).base_color, Spectrum(0.8f));
    EXPECT_EQ(scene.first_light_of_object, (std::vector<int>{-1, 1, -1}));
    ASSERT_EQ(scene.lights.size(), 13u);
    double area = 0.0;
    for (size_t i = 1; i < 13; ++i) {
        const auto& triangle = std::get<TriangleLight>(scene.lights[i]);
        EXPECT_EQ(triangle.radiance, Spectrum(2.0f, 1.0f, 0.0f));
        area +=
            0.5 * static_cast<double>(glm::length(glm::cross(triangle.edge_u, triangle.edge_v)));
    }
    EXPECT_NEAR(area, 6.0, 1e-5);
    const auto hit = intersect(*scene.surfaces, {Vec3(4.0f, 0.0f, 9.0f), Vec3(0.0f, 0.0f, -1.0f)},
                               {0.0f, infinity});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->object, 0);
    ASSERT_TRUE(scene.next);
    ASSERT_EQ(scene.next->world_from_surface.size(), 3u);
    EXPECT_EQ(scene.next->world_from_surface[0].keys[0].translate, Vec3d(0.0));
    EXPECT_EQ(stats.meshes_built, 2);
}

TEST(PrepareSurfaces, OnlyWhatMovesIsBuiltAgain)
{
    const Folder f(scene_text);
    SceneCache cache;
    PrepareStats first;
    const Scene at_3 = prepare(f.description, 3, cache, first);  // "late" is hidden
    EXPECT_EQ(first.meshes_built, 1);                            // shared by two objects
    EXPECT_EQ(first.instance_trees_built, 1);
    PrepareStats second;
    const Scene at_4 = prepare(f.description, 4, cache, second);  // nothing moves any more
    EXPECT_EQ(second.meshes_built, 0);
    EXPECT_EQ(second.meshes_reused, 1);
    EXPECT_EQ(second.instance_trees_built, 0);
    EXPECT_EQ(at_3.surfaces->bvh, at_4.surfaces->bvh);
    PrepareStats third;
    const Scene at_1 = prepare(f.description, 1, cache, third);
    EXPECT_EQ(third.meshes_built, 0);
    PrepareStats fourth;
    const Scene at_2 = prepare(f.description, 2, cache, fourth);
    EXPECT_EQ(fourth.meshes_built, 1);
    EXPECT_EQ(fourth.meshes_reused, 1);
    EXPECT_EQ(fourth.instance_trees_built, 1);
}

TEST(PrepareSurfaces, PicturesOfMaterials)
{
    const Folder f(R"(
[[materials]]
name = "leaf"
color_texture = "leaf.png"
normal_texture = "leaf.png"
normal_strength = 0.5
alpha_cutoff = 0.25
[[objects]]
file = "quad.obj"
material = "leaf"
[[objects]]
file = "quad.obj"
material = { emission = 3, emission_texture = "leaf.png" }
)");
    f.folder.write("leaf.png", test::text_of(test::rgba_png));
    f.folder.write("quad.obj", test::obj_text(test::quad_mesh(Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f),
                                                              Vec3(0.0f, 1.0f, 0.0f))));
    SceneCache cache;
    PrepareStats stats;
    const Scene scene = prepare(f.description, 1, cache, stats);
    ASSERT_TRUE(scene.surfaces);
    EXPECT_TRUE(scene.surfaces->has_cuts);
    const MaterialTextures* leaf = scene.surfaces->textures_of(0);
    ASSERT_NE(leaf, nullptr);
    EXPECT_EQ(leaf->alpha_cutoff, 0.25f);
    EXPECT_EQ(leaf->normal_strength, 0.5f);
    // 20 of 255 by the sRGB curve as a colour, linear as data; the texel at the lower right.
    EXPECT_NEAR(leaf->color->at({0.75f, 0.25f}).y, 0.0070f, 1e-4f);
    EXPECT_FLOAT_EQ(leaf->normal->at({0.75f, 0.25f}).y, 20.0f / 255.0f);
    const MaterialTextures* lamp = scene.surfaces->textures_of(1);
    ASSERT_NE(lamp, nullptr);
    EXPECT_EQ(lamp->emission, leaf->color) << "a file is read once for each role";
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_TRUE(std::get<TriangleLight>(scene.lights[0]).texture);
    EXPECT_EQ(stats.texture_bytes, 32u);
    PrepareStats again;
    const Scene later = prepare(f.description, 2, cache, again);
    EXPECT_EQ(later.surfaces->textures_of(0)->color, leaf->color);
}

TEST(PrepareSurfaces, MissingPicturesAndCoordinatesAreNamed)
{
    const Folder f("[[objects]]\nfile = \"box.obj\"\nmaterial = { color_texture = \"a.png\" }\n");
    SceneCache cache;
    PrepareStats stats;
    expect_error([&] { (void)prepare(f.description, 1, cache, stats); }, ExitCode::Input,
                 {"a.png", "cannot be read"});
    f.folder.write("a.png", test::text_of(test::rgba_png));
    expect_error([&] { (void)prepare(f.description, 1, cache, stats); }, ExitCode::Input,
                 {"box.obj", "no texture coordinates"});
}

/// Beyond what floats and Embree can place; at any key, and one frame later.
TEST(PrepareSurfaces, VerticesOutOfReachAreNamed)
{
    const std::string box = "[[objects]]\nname = \"moon\"\nfile = \"box.obj\"\n";
    SceneCache cache;
    PrepareStats stats;
    const Folder far(box + "transform = { translate = [9999999.5, 0, 0] }\n");
    expect_error([&] { (void)prepare(far.description, 1, cache, stats); }, ExitCode::Input,
                 {"box.obj: vertex (1, ", "\"moon\"", "beyond 1e+07 m", "scale it down"});
    const Folder near(box + "transform = { translate = [9999998.5, 0, 0] }\n");
    EXPECT_TRUE(prepare(near.description, 1, cache, stats).surfaces);
    const Folder moving(box +
                        "transform = [{ frame = 1 }, { frame = 2, translate = [0, 1e7, 0] }]\n");
    EXPECT_TRUE(prepare(moving.description, 0, cache, stats, true).surfaces);
    expect_error([&] { (void)prepare(moving.description, 1, cache, stats, true); }, ExitCode::Input,
                 {"box.obj: vertex", "beyond"});
    const Folder shrunk("[[objects]]\nfile = \"star.obj\"\ntransform = { scale = 1e-3 }\n");
    shrunk.folder.write("star.obj", "v 0 0 0\nv 1e9 0 0\nv 0 1e9 0\nf 1 2 3\n");
    EXPECT_TRUE(prepare(shrunk.description, 1, cache, stats).surfaces) << "1e6 m in the world";
}

TEST(PrepareSurfaces, BrokenMeshesAreNamed)
{
    const Folder f("[[objects]]\nfile = \"bad.obj\"\n");
    f.folder.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
    SceneCache cache;
    PrepareStats stats;
    try {
        (void)prepare(f.description, 1, cache, stats);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("bad.obj:2:1: the face names vertex 2"),
                  std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace mote
