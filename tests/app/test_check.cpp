#include <gtest/gtest.h>

#include "app/check_inputs.h"
#include "run_mote.h"
#include "scene/scene_io.h"
#include "support/temporary_folder.h"

namespace mote {

namespace {

constexpr const char* dust_scene = R"(
[[particles]]
name = "dust"
emitter = "snow"
count = 500
[[volumes]]
particles = "dust"
)";

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// Frames 1 to 3 of a particle sequence with colours, and a scene that uses them.
void write_colored_dust(const TemporaryFolder& folder)
{
    for (const char* name : {"dust.1.csv", "dust.2.csv", "dust.3.csv"}) {
        folder.write(name, "x,y,z,r,g,b\n0,0,0,1,1,1\n");
    }
    folder.write("scene.toml", R"(
first_frame = 1
last_frame = 3
[[particles]]
name = "dust"
file = "dust.#.csv"
[[volumes]]
particles = "dust"
use_color = true
)");
}

}  // namespace

TEST(Check, OpensPicturesAndGltfFiles)
{
    const TemporaryFolder folder;
    folder.write("quad.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    folder.write("bad.png", "no picture");
    folder.write("bad.gltf", "{ \"asset\": 1, }");
    folder.write("skins.gltf", R"({ "asset": { "version": "2.0" },
      "images": [{ "uri": "gone.png" }] })");
    folder.write("scene.toml", R"(
[camera]
file = "nowhere.glb"
[[materials]]
name = "a"
color_texture = "none.png"
[[objects]]
file = "quad.obj"
material = { color_texture = "bad.png" }
[[objects]]
file = "bad.gltf"
[[objects]]
file = "skins.gltf"
)");
    const Finished check = run_mote(folder.path(), {"check", "scene.toml"});
    EXPECT_EQ(check.exit_code, 3);
    for (const char* part : {"nowhere.glb: no such file, used by the camera",
                             "none.png: no such file, used by material \"a\"", "bad.png",
                             "bad.gltf:1:15: not valid JSON", "gone.png"}) {
        EXPECT_TRUE(contains(check.err, part)) << part << " in " << check.err;
    }
}

TEST(Check, NamesMissingFilesAndGrids)
{
    const TemporaryFolder folder;
    folder.write("dust.toml", dust_scene);
    ASSERT_EQ(
        run_mote(folder.path(), {"cache", "dust.toml", "--frames", "1", "--grids", "d.####.vdb"})
            .exit_code,
        0);
    folder.write("scene.toml", R"(
[[volumes]]
file = { path = "d.0001.vdb" }
density_grid = "densty"
[[volumes]]
file = { path = "none.####.vdb" }
)");
    const Finished check = run_mote(folder.path(), {"check", "scene.toml"});
    EXPECT_EQ(check.exit_code, 3);
    EXPECT_TRUE(contains(check.err, "no grid \"densty\" (did you mean \"density\"?)")) << check.err;
    EXPECT_TRUE(contains(check.err, "none.####.vdb")) << check.err;
    EXPECT_EQ(run_mote(folder.path(), {"check", "dust.toml"}).exit_code, 0);
}

TEST(Check, OpensImagesAndLooksForTheAttributesInUse)
{
    const TemporaryFolder folder;
    folder.write("dust.csv", "x,y,z\n0,0,0\n1,0,0\n");
    folder.write("sky.exr", "no image");
    folder.write("scene.toml", R"(
[[particles]]
name = "dust"
file = "dust.csv"
[[volumes]]
particles = "dust"
use_color = true
[[lights]]
type = "environment"
image = "sky.exr"
)");
    const Finished check = run_mote(folder.path(), {"check", "scene.toml"});
    EXPECT_EQ(check.exit_code, 3);
    EXPECT_TRUE(contains(check.err, "dust.csv: particles \"dust\" have no color")) << check.err;
    EXPECT_TRUE(contains(check.err, "it is no OpenEXR file, in spite of its name")) << check.err;
    EXPECT_EQ(run_mote(folder.path(), {"check", "scene.toml", "--set", "volumes.0.use_color=false",
                                       "--set", "lights.0.image=\"\""})
                  .exit_code,
              0);
    const Finished missing =
        run_mote(folder.path(), {"check", "scene.toml", "--set", "lights.0.image=none.exr"});
    EXPECT_TRUE(contains(missing.err, "no such file, used by light 0")) << missing.err;
}

TEST(Check, OpensEveryFileOfASequence)
{
    const TemporaryFolder folder;
    write_colored_dust(folder);
    EXPECT_EQ(run_mote(folder.path(), {"check", "scene.toml"}).exit_code, 0);
    folder.write("dust.3.csv", "x,y,z\n0,0,0\n");
    const Finished colorless = run_mote(folder.path(), {"check", "scene.toml"});
    EXPECT_EQ(colorless.exit_code, 3);
    EXPECT_TRUE(contains(colorless.err, "dust.3.csv: particles \"dust\" have no color"))
        << colorless.err;
    EXPECT_FALSE(contains(colorless.err, "dust.2.csv")) << colorless.err;
    EXPECT_EQ(run_mote(folder.path(), {"check", "scene.toml", "--frames", "1-2"}).exit_code, 0);

    folder.write("dust.toml", dust_scene);
    ASSERT_EQ(
        run_mote(folder.path(), {"cache", "dust.toml", "--frames", "1-3", "--grids", "d.#.vdb"})
            .exit_code,
        0);
    folder.write("d.2.vdb", "half a file");
    folder.write("volume.toml", "last_frame = 3\n[[volumes]]\nfile = \"d.#.vdb\"\n");
    const Finished damaged = run_mote(folder.path(), {"check", "volume.toml"});
    EXPECT_EQ(damaged.exit_code, 3);
    EXPECT_TRUE(contains(damaged.err, "d.2.vdb")) << damaged.err;
    EXPECT_FALSE(contains(damaged.err, "d.1.vdb")) << damaged.err;
}

TEST(Check, TakesNoLongerThanItMay)
{
    // Without any time the first file of each sequence is still opened; all must be there.
    const TemporaryFolder folder;
    write_colored_dust(folder);
    const SceneDescription scene = load_scene(folder.file("scene.toml"));
    const InputReport hasty = check_inputs(scene, {1, 2, 3}, -1.0);
    EXPECT_TRUE(hasty.problems.empty());
    EXPECT_EQ(hasty.sequence_files, 3u);
    EXPECT_EQ(hasty.opened_files, 1u);
    const InputReport full = check_inputs(scene, {1, 2, 3, 3, 4, 99}, 600.0);  // 4 and 99: held
    EXPECT_TRUE(full.problems.empty());
    EXPECT_EQ(full.sequence_files, 3u);
    EXPECT_EQ(full.opened_files, 3u);
    std::filesystem::remove(folder.file("dust.2.csv"));
    const InputReport gap = check_inputs(scene, {1, 2, 3}, -1.0);
    ASSERT_EQ(gap.problems.size(), 1u);
    EXPECT_TRUE(contains(gap.problems[0], "dust.2.csv: missing from the sequence of frames 1 to 3"))
        << gap.problems[0];
}

TEST(Check, AMotionLayerWithoutVelocitiesSaysHowToGoOn)
{
    const TemporaryFolder folder;
    folder.write("dust.toml", dust_scene);
    ASSERT_EQ(run_mote(folder.path(), {"cache", "dust.toml", "--frames", "1", "--grids", "d.vdb"})
                  .exit_code,
              0);
    folder.write("scene.toml", R"(
[render]
width = 4
height = 4
samples = 1
[output]
aovs = ["motion"]
[[volumes]]
name = "dust"
file = "d.vdb"
[[lights]]
type = "environment"
)");
    for (const char* command : {"check", "render"}) {
        const Finished refused = run_mote(folder.path(), {command, "scene.toml"});
        EXPECT_EQ(refused.exit_code, 3) << command;
        EXPECT_TRUE(contains(refused.err, "d.vdb: no grid \"velocity\"")) << refused.err;
        EXPECT_TRUE(contains(refused.err, "\"velocity_grid\"")) << refused.err;
        const Finished still = run_mote(
            folder.path(), {command, "scene.toml", "--set", "volumes.dust.velocity_grid=\"\""});
        EXPECT_EQ(still.exit_code, 0) << still.err;
    }
}

}  // namespace mote
