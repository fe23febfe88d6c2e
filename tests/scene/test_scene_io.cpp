#include <gtest/gtest.h>

#include "support/scene_files.h"

namespace mote {
namespace {

using test::load_text;

const std::string small_scene = R"(
[[volumes]]
name = "smoke"
procedural = "puff"

[[lights]]
name = "sun"
type = "distant"
)";

TEST(SceneIo, DefaultsMakeAScene)
{
    const SceneDescription scene = load_text(small_scene);
    EXPECT_EQ(scene.fps, 24.0);
    EXPECT_EQ(scene.first_frame, 1);
    EXPECT_EQ(scene.render.width, 640);
    EXPECT_EQ(scene.render.path.max_bounces, PathTracerParams{}.max_bounces);
    EXPECT_EQ(scene.output.path, "out/####.exr");
    ASSERT_EQ(scene.volumes.size(), 1u);
    EXPECT_EQ(scene.volumes[0].procedural->kind, ProceduralKind::Puff);
    EXPECT_EQ(scene.volumes[0].density_grid, "density");
    EXPECT_EQ(scene.volumes[0].albedo, Spectrum(0.9f));
    EXPECT_EQ(scene.lights[0].kind, LightKind::Distant);
}

TEST(SceneIo, ReadsEveryKindOfValue)
{
    const SceneDescription scene = load_text(R"(
name = "all"
fps = 25
first_frame = -5
last_frame = 10
[camera]
position = [1, 2.5, 3]
shutter_close = 0.5
keys = [{ frame = 1, fov = 30 }, { frame = 10.5, position = [0, 0, 9], up = [0, 1, 1] }]
[render]
width = 320
samples = 64.0
seed = 4294967295
bounces = 1000
path = { transmittance = "residual_ratio", light_sampler = "tree", equiangular = true }
[output]
path = "o/%04d.exr"
aovs = ["Z", "motion"]
color_type = "float"
compression = "piz"
view = "srgb"
exposure = -1.5
[[volumes]]
file = { path = "fire.####.vdb", first = 1001, last = 1100, offset = 1000, outside = "loop" }
density_scale = 2.5
albedo = [0.1, 0.2, 0.3]
phase = { g = 0.8, g_b = -0.3, weight_b = 0.25 }
emission = { blackbody_scale = 2, temperature_scale = 3000 }
transform = { translate = [0, 1, 0], rotate = [0, 90, 0], scale = 2 }
[[volumes]]
particles = "spray"
phase = 0.4
[[particles]]
name = "spray"
file = "spray.####.ply"
attributes = { radius = "pscale", velocity = "v" }
velocity_unit = "per_frame"
radius = 0.05
scale = 0.01
[[particles]]
name = "ring"
emitter = "disk"
count = 5000
mass = 3
color = 0.5
[[lights]]
type = "sphere"
count = 1000
spread = [1, 2, 3]
[[materials]]
name = "gold"
type = "metallic_roughness"
color = [1, 0.8, 0.3]
metallic = 1
roughness = 0.2
[[objects]]
file = "box.obj"
material = "gold"
[[objects]]
file = { path = "lamp.####.ply", offset = 10 }
material = { color = 0.5, emission = 3, emission_color = [1, 0.5, 0], two_sided = false }
transform = { translate = [0, 2, 0] }
)");
    EXPECT_EQ(scene.first_frame, -5);
    EXPECT_EQ(scene.camera.position, Vec3d(1.0, 2.5, 3.0));
    ASSERT_EQ(scene.camera.keys.size(), 2u);
    EXPECT_FALSE(scene.camera.keys[0].position.has_value());
    EXPECT_EQ(scene.camera.keys[0].fov, 30.0);
    EXPECT_EQ(scene.camera.keys[1].frame, 10.5);
    EXPECT_EQ(scene.camera.keys[1].up, Vec3d(0.0, 1.0, 1.0));
    EXPECT_EQ(scene.render.samples, 64);
    EXPECT_EQ(scene.render.seed, 4294967295u);
    EXPECT_EQ(scene.render.path.max_bounces, 1000);
    EXPECT_EQ(scene.render.path.transmittance, TransmittanceKind::ResidualRatio);
    EXPECT_EQ(scene.render.path.light_sampler, LightSamplerKind::Tree);
    EXPECT_TRUE(scene.render.path.equiangular);
    EXPECT_EQ(scene.output.aovs, (std::vector<std::string>{"Z", "motion"}));
    EXPECT_EQ(scene.output.color_type, PixelType::Float);
    EXPECT_EQ(scene.output.compression, ExrCompression::Piz);
    EXPECT_EQ(scene.output.view.view, ViewTransform::Srgb);
    const VolumeDescription& fire = scene.volumes[0];
    EXPECT_EQ(fire.file->pattern, "fire.####.vdb");
    EXPECT_EQ(fire.file->outside, OutsideRange::Loop);
    EXPECT_EQ(fire.file->offset, 1000);
    EXPECT_EQ(fire.albedo, Spectrum(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(fire.phase.weight_b, 0.25f);
    EXPECT_EQ(fire.emission.temperature_scale, 3000.0f);
    ASSERT_EQ(fire.transform.size(), 1u);
    EXPECT_EQ(fire.transform[0].scale, Vec3d(2.0));
    EXPECT_EQ(scene.volumes[1].phase.g, 0.4f);
    const auto& cache = std::get<CacheParams>(scene.particles[0].source);
    EXPECT_EQ(cache.attributes.at("radius"), "pscale");
    EXPECT_EQ(cache.velocity_unit, VelocityUnit::PerFrame);
    EXPECT_EQ(cache.radius, 0.05f);
    EXPECT_EQ(cache.scale, 0.01f);
    const auto& ring = std::get<EmitterParams>(scene.particles[1].source);
    EXPECT_EQ(ring.kind, EmitterKind::Disk);
    EXPECT_EQ(ring.count, 5000);
    EXPECT_EQ(ring.mass, 3.0f);
    EXPECT_EQ(ring.color, Spectrum(0.5f));
    EXPECT_EQ(scene.lights[0].count, 1000);
    EXPECT_EQ(scene.materials[0].look.kind, MaterialKind::MetallicRoughness);
    EXPECT_EQ(scene.materials[0].look.roughness, 0.2f);
    EXPECT_EQ(scene.objects[0].file.pattern, "box.obj");
    EXPECT_EQ(scene.objects[0].material.name, "gold");
    EXPECT_EQ(scene.objects[1].file.offset, 10);
    EXPECT_EQ(scene.objects[1].material.look.base_color, Spectrum(0.5f));
    EXPECT_EQ(scene.objects[1].material.emission_color, Spectrum(1.0f, 0.5f, 0.0f));
    EXPECT_FALSE(scene.objects[1].material.look.two_sided);
    EXPECT_EQ(scene.objects[1].transform.size(), 1u);
}

TEST(SceneIo, TransformKeysCarryWhatTheyLeaveOut)
{
    const SceneDescription scene = load_text(R"(
[[volumes]]
procedural = "puff"
[[volumes.transform]]
frame = 1
translate = [1, 0, 0]
scale = 3
[[volumes.transform]]
frame = 10
rotate = [0, 180, 0]
)");
    const std::vector<TransformKey>& keys = scene.volumes[0].transform;
    ASSERT_EQ(keys.size(), 2u);
    EXPECT_EQ(keys[1].translate, Vec3d(1.0, 0.0, 0.0));
    EXPECT_EQ(keys[1].rotate, Vec3d(0.0, 180.0, 0.0));
    EXPECT_EQ(keys[1].scale, Vec3d(3.0));
}

TEST(SceneIo, JsonReadsAsToml)
{
    const TemporaryFolder folder;
    const std::string json = folder.write("scene.json", R"({
  "$schema": "scene.schema.json",
  "volumes": [{"name": "smoke", "procedural": "puff"}],
  "lights": [{"name": "sun", "type": "distant", "strength": 1e0}]
})");
    EXPECT_EQ(load_scene(json).hash, load_text(small_scene).hash);
}

TEST(SceneIo, OverridesReachEverything)
{
    const SceneDescription scene = load_text(
        small_scene, {"volumes.smoke.density_scale=4", "volumes.0.phase.g=0.5",
                      "lights.sun.color=[1, 0.5, 0]", "camera.position=[0, 0, 5]",
                      "camera.position.1=7", "render.samples=3", "output.path=out/a.####.exr",
                      "name=two words", "volumes.smoke.transform={ translate = [1, 2, 3] }",
                      "output.aovs=[\"Z\"]", "volumes.smoke.procedural=plume", "fps=30"});
    EXPECT_EQ(scene.volumes[0].density_scale, 4.0f);
    EXPECT_EQ(scene.volumes[0].phase.g, 0.5f);
    EXPECT_EQ(scene.lights[0].color, Spectrum(1.0f, 0.5f, 0.0f));
    EXPECT_EQ(scene.render.samples, 3);
    EXPECT_EQ(scene.output.path, "out/a.####.exr");
    EXPECT_EQ(scene.name, "two words");
    EXPECT_EQ(scene.volumes[0].transform[0].translate, Vec3d(1.0, 2.0, 3.0));
    EXPECT_EQ(scene.output.aovs, std::vector<std::string>{"Z"});
    EXPECT_EQ(scene.volumes[0].procedural->kind, ProceduralKind::Plume);
    EXPECT_EQ(scene.fps, 30.0);
}

TEST(SceneIo, LaterOverridesWin)
{
    EXPECT_EQ(load_text(small_scene, {"fps=30", "fps=25"}).fps, 25.0);
}

TEST(SceneHash, IgnoresOrderCommentsAndWrittenDefaults)
{
    const uint64_t hash = load_text(small_scene).hash;
    EXPECT_EQ(load_text(R"(# a comment
fps = 24.0
[[lights]]
type = "distant"
name = "sun"
[[volumes]]
procedural = { type = "puff", seed = 1 }
albedo = 0.9
name = "smoke"
)")
                  .hash,
              hash);
    EXPECT_EQ(load_text(small_scene, {"output.path=elsewhere.exr", "name=title", "last_frame=100",
                                      "output.exposure=3"})
                  .hash,
              hash);
}

TEST(SceneHash, ChangesWithEveryValueOfThePicture)
{
    std::vector<std::string> overrides{
        "fps=25",
        "camera.position=[0,0,4]",
        "camera.look_at=[0,0,1e-3]",
        "camera.up=[1,1,0]",
        "camera.fov=45.0001",
        "camera.lens_radius=0.1",
        "camera.focus_distance=1",
        "camera.shutter_open=-0.5",
        "camera.shutter_close=0.5",
        "camera.keys=[{ frame = 1, fov = 30 }]",
        "camera.keys=[{ frame = 2, fov = 30 }]",
        "camera.keys=[{ frame = 1, fov = 31 }]",
        "camera.keys=[{ frame = 1, lens_radius = 30 }]",
        "render.width=641",
        "render.height=361",
        "render.samples=17",
        "render.bounces=2",
        "render.seed=1",
        "render.path.roulette_start=5",
        "render.path.transmittance=exact",
        "render.path.light_sampler=power",
        "render.path.equiangular=true",
        "render.path.light_strategy=phase",
        "render.path.mis=balance",
        "output.aovs=[\"Z\"]",
        "output.color_type=float",
        "volumes.0.procedural=plume",
        "volumes.0.procedural={ voxel_size = 0.01 }",
        "volumes.0.procedural={ seed = 2 }",
        "volumes.0.procedural={ size = [1, 1, 2] }",
        "volumes.0.density_scale=1.0000001",
        "volumes.0.albedo=0.8",
        "volumes.0.albedo=[0.9, 0.9, 0.8]",
        "volumes.0.use_color=true",
        "volumes.0.phase=0.1",
        "volumes.0.phase={ g_b = 0.1 }",
        "volumes.0.phase={ weight_b = 0.1 }",
        "volumes.0.emission={ scale = 1 }",
        "volumes.0.emission={ blackbody_scale = 1 }",
        "volumes.0.emission={ temperature_offset = 1 }",
        "volumes.0.density_grid=d",
        "volumes.0.transform={ translate = [1, 0, 0] }",
        "volumes.0.transform={ scale = [1, 2, 1] }",
        "volumes.0.transform={ rotate = [0, 0, 1] }",
        "lights.0.strength=2",
        "lights.0.color=[1,1,0.5]",
        "lights.0.direction=[1,1,0]",
        "lights.0.type=point",
        "particles=[{ name = \"p\", emitter = \"snow\" }]",
        "particles=[{ name = \"p\", emitter = \"snow\", count = 5 }]",
        "particles=[{ name = \"p\", file = \"a.ply\" }]",
        "particles=[{ name = \"p\", file = \"b.ply\" }]",
        "particles=[{ name = \"p\", file = \"b.ply\", attributes = { radius = \"r\" } }]",
    };
    std::map<uint64_t, std::string> seen{{load_text(small_scene).hash, "nothing"}};
    for (const std::string& override_text : overrides) {
        const uint64_t hash = load_text(small_scene, {override_text}).hash;
        const auto [other, is_new] = seen.emplace(hash, override_text);
        EXPECT_TRUE(is_new) << override_text << " hashes as " << other->second;
    }
}

}  // namespace
}  // namespace mote
