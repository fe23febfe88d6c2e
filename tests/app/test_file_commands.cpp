#include <gtest/gtest.h>

#include "run_mote.h"
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

}  // namespace

TEST(FileCommands, CachedParticlesAreReadBackAndRasterised)
{
    const TemporaryFolder folder;
    folder.write("scene.toml", dust_scene);
    const Finished cache =
        run_mote(folder.path(), {"cache", "scene.toml", "--frames", "1-2", "--points", "p.####.vdb",
                                 "--grids", "d.####.vdb"});
    ASSERT_EQ(cache.exit_code, 0) << cache.err;
    EXPECT_EQ(files_below(folder.path()),
              (std::vector<std::string>{"d.0001.vdb", "d.0002.vdb", "p.0001.vdb", "p.0002.vdb",
                                        "scene.toml"}));
    const Finished points = run_mote(folder.path(), {"info", "p.####.vdb", "--frame", "2"});
    EXPECT_EQ(points.exit_code, 0) << points.err;
    EXPECT_TRUE(contains(points.out, "largest displacement")) << points.out;
    const Finished grid = run_mote(folder.path(), {"info", "d.0001.vdb"});
    EXPECT_TRUE(contains(grid.out, "grid \"density\": float, fog volume")) << grid.out;
    // The points as a plain file sequence give the same kind of grid.
    const Finished again =
        run_mote(folder.path(), {"cache", "p.####.vdb", "--grids", "e.####.vdb"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(run_mote(folder.path(), {"info", "e.0002.vdb"}).exit_code, 0);
}

TEST(FileCommands, CachingPastTheLastFileOfAHeldSequenceIsSaid)
{
    const TemporaryFolder folder;
    folder.write("dust.1.csv", "x,y,z\n0,0,0\n");
    folder.write("dust.2.csv", "x,y,z\n1,0,0\n");
    folder.write("scene.toml", R"(
[[particles]]
name = "dust"
file = { path = "dust.#.csv", offset = -10, outside = "hold" }
[[volumes]]
particles = "dust"
)");
    const auto cache = [&](const char* input, const char* frames, const char* set) {
        return run_mote(folder.path(), {"cache", input, "--frames", frames, "--points",
                                        "p.####.vdb", "--set", set});
    };
    const Finished files = run_mote(
        folder.path(), {"cache", "dust.#.csv", "--frames", "0-5", "--points", "p.####.vdb"});
    EXPECT_EQ(files.exit_code, 0) << files.err;
    EXPECT_TRUE(contains(files.err, "files for frames 1 to 2; frames 0,3-5 repeat")) << files.err;
    const Finished scene = cache("scene.toml", "11-15", "fps=24");
    EXPECT_EQ(scene.exit_code, 0) << scene.err;
    EXPECT_TRUE(contains(scene.err, "files for frames 11 to 12; frames 13-15 repeat")) << scene.err;
    EXPECT_FALSE(contains(cache("scene.toml", "11-12", "fps=24").err, "warning"));
    const Finished hidden = cache("scene.toml", "11-15", "particles.dust.file.outside=\"hide\"");
    EXPECT_EQ(hidden.exit_code, 0) << hidden.err;
    EXPECT_FALSE(contains(hidden.err, "warning")) << hidden.err;
}

TEST(FileCommands, MotionBlurWithoutVelocitiesIsSaid)
{
    const TemporaryFolder folder;
    folder.write("dust.csv", "x,y,z\n0,0,0\n");
    folder.write("moving.csv", "x,y,z,vx,vy,vz\n0,0,0,1,0,0\n");
    folder.write("scene.toml", R"(
[camera]
shutter_close = 0.5
[render]
width = 4
height = 4
samples = 1
[[particles]]
name = "dust"
file = "dust.csv"
[[volumes]]
particles = "dust"
)");
    const auto render = [&](const char* override_) {
        return run_mote(folder.path(), {"render", "scene.toml", "--set", override_});
    };
    const Finished still = render("particles.dust.file=dust.csv");
    EXPECT_EQ(still.exit_code, 0) << still.err;
    EXPECT_TRUE(contains(still.err, "particles \"dust\": no velocities")) << still.err;
    EXPECT_FALSE(contains(render("particles.dust.file=moving.csv").err, "no velocities"));
    EXPECT_FALSE(contains(render("camera.shutter_close=0").err, "no velocities"));
}

TEST(FileCommands, ASheetIsAPng)
{
    const TemporaryFolder folder;
    const Finished sheet = run_mote(folder.path(), {"sheet", "a.jpg", "b.png"});
    EXPECT_EQ(sheet.exit_code, 2);
    EXPECT_TRUE(contains(sheet.err, "must end in .png")) << sheet.err;
    EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(FileCommands, InfoTellsMeshesFromParticles)
{
    const std::string garden = std::string(MOTE_SOURCE_DIR) + "/scenes/meshes/garden.gltf";
    const TemporaryFolder folder;
    const Finished gltf = run_mote(folder.path(), {"info", garden});
    EXPECT_EQ(gltf.exit_code, 0) << gltf.err;
    for (const char* part :
         {"glTF file, 4 meshes", "448, 261 vertices, normals, texture coordinates",
          "material \"paper\": metallic_roughness, textures, glows",
          "material \"leaf\": metallic_roughness, textures, cut out", "camera \"view\"",
          "animation    0 .. 2 s"}) {
        EXPECT_TRUE(contains(gltf.out, part)) << part << " in " << gltf.out;
    }
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
    const Finished obj = run_mote(folder.path(), {"info", "a.obj"});
    EXPECT_TRUE(contains(obj.out, "a.obj: mesh\n  triangles    1, 3 vertices\n")) << obj.out;
    const std::string vertices =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\n";
    folder.write("mesh.ply", vertices +
                                 "element face 1\nproperty list uchar int vertex_index\n"
                                 "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    folder.write("dust.ply", vertices + "end_header\n0 0 0\n1 0 0\n0 1 0\n");
    EXPECT_TRUE(contains(run_mote(folder.path(), {"info", "mesh.ply"}).out, "mesh.ply: mesh"));
    EXPECT_TRUE(contains(run_mote(folder.path(), {"info", "dust.ply"}).out, "particle file"));
    folder.write("bad.glb", "glTF");
    const Finished bad = run_mote(folder.path(), {"info", "bad.glb"});
    EXPECT_EQ(bad.exit_code, 3);
    EXPECT_TRUE(contains(bad.err, "bad.glb: truncated")) << bad.err;
}

TEST(FileCommands, InfoRefusesOtherKindsOfFiles)
{
    const TemporaryFolder folder;
    folder.write("a.txt", "text");
    const Finished info = run_mote(folder.path(), {"info", "a.txt"});
    EXPECT_EQ(info.exit_code, 3);
    EXPECT_TRUE(contains(info.err, ".vdb")) << info.err;
}

}  // namespace mote
