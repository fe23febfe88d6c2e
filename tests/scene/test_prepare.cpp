#include <gtest/gtest.h>

#include "particles/source.h"
#include "scene/prepare.h"
#include "support/scene_files.h"
#include "volumes/blackbody.h"

namespace mote {
namespace {

using test::load_text;

const std::string plume = R"(
[camera]
shutter_close = 0.5
[[particles]]
name = "plume"
emitter = "plume"
count = 3000
start_time = -4
temperature = 1500
voxel_size = 0.05
radius = 0.1
[[volumes]]
name = "smoke"
particles = "plume"
[[volumes]]
name = "puff"
procedural = { type = "puff", voxel_size = 0.1 }
transform = [{ frame = 1 }, { frame = 11, translate = [10, 0, 0] }]
[[lights]]
type = "distant"
)";

Scene prepare(const SceneDescription& description, int frame, SceneCache& cache,
              PrepareStats& stats, const PrepareNeeds& needs = {})
{
    return prepare_frame(description, frame, needs, cache, stats);
}

Scene prepare(const SceneDescription& description, int frame, const PrepareNeeds& needs = {})
{
    SceneCache cache;
    PrepareStats stats;
    return prepare(description, frame, cache, stats, needs);
}

std::string error_of(const std::string& text, const PrepareNeeds& needs = {})
{
    try {
        (void)prepare(load_text(text), 1, needs);
    } catch (const Error& error) {
        return error.code() == ExitCode::Input ? error.what() : "wrong exit code";
    }
    return "no error";
}

TEST(Prepare, FramesDoNotDependOnEarlierOnes)
{
    const SceneDescription description = load_text(plume);
    const Scene alone = prepare(description, 7);
    SceneCache cache;
    PrepareStats stats;
    for (int frame = 1; frame < 7; ++frame) (void)prepare(description, frame, cache, stats);
    const Scene after = prepare(description, 7, cache, stats);
    ASSERT_EQ(alone.media.volumes.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(alone.media.volumes[i].density->values, after.media.volumes[i].density->values);
        EXPECT_EQ(alone.media.volumes[i].density->table, after.media.volumes[i].density->table);
    }
    EXPECT_GT(alone.media.volumes[0].density->active_bricks(), 0u);
}

TEST(Prepare, BuildsOnlyWhatChanged)
{
    const SceneDescription description = load_text(plume);
    SceneCache cache;
    PrepareStats stats;
    const Scene first = prepare(description, 1, cache, stats);
    EXPECT_EQ(stats.grids_built, 2);
    EXPECT_EQ(stats.grids_reused, 0);
    EXPECT_EQ(stats.particles, 3000);
    EXPECT_GT(stats.brick_bytes, 0u);

    stats = {};  // the plume moves, the puff does not
    const Scene second = prepare(description, 2, cache, stats);
    EXPECT_EQ(stats.grids_built, 1);
    EXPECT_EQ(stats.grids_reused, 1);
    EXPECT_EQ(first.media.volumes[1].density, second.media.volumes[1].density);

    stats = {};  // the same frame again: nothing is emitted or rasterised
    (void)prepare(description, 2, cache, stats);
    EXPECT_EQ(stats.grids_built, 0);
    EXPECT_EQ(stats.grids_reused, 2);
    EXPECT_EQ(stats.particles, 0);

    stats = {};  // before its start, a source is empty at every frame alike
    const SceneDescription late = load_text(plume, {"particles.plume.start_time=10"});
    (void)prepare(late, 1, cache, stats);
    stats = {};
    const Scene empty = prepare(late, 2, cache, stats);
    EXPECT_EQ(stats.grids_built, 0);
    EXPECT_EQ(empty.media.volumes.size(), 2u);
}

TEST(Prepare, BuildsOnlyTheChannelsThatAreUsed)
{
    SceneCache cache;
    PrepareStats stats;
    const Scene plain = prepare(load_text(plume), 1, cache, stats);
    EXPECT_EQ(plain.media.volumes[0].temperature, nullptr);
    EXPECT_EQ(plain.media.volumes[0].color, nullptr);
    EXPECT_EQ(plain.media.volumes[0].velocity, nullptr);
    EXPECT_FALSE(plain.next.has_value());

    const SceneDescription rich = load_text(
        plume, {"volumes.smoke.emission={ blackbody_scale = 1 }", "volumes.smoke.use_color=true"});
    const Scene shown = prepare(rich, 1, PrepareNeeds{true});
    ASSERT_NE(shown.media.volumes[0].temperature, nullptr);
    ASSERT_NE(shown.media.volumes[0].color, nullptr);
    ASSERT_NE(shown.media.volumes[0].velocity, nullptr);
    EXPECT_GT(shown.media.volumes[0].temperature->max_value, 1000.0f);
    ASSERT_TRUE(shown.next.has_value());
    EXPECT_EQ(shown.next->world_from_object.size(), 2u);
}

TEST(Prepare, VolumesOfOneSystemShareItsGrids)
{
    const SceneDescription description = load_text(
        plume + "[[volumes]]\nname = \"twin\"\nparticles = \"plume\"\nuse_color = true\n");
    SceneCache cache;
    PrepareStats stats;
    const Scene scene = prepare(description, 1, cache, stats);
    EXPECT_EQ(stats.particles, 3000);
    EXPECT_EQ(scene.media.volumes[0].density, scene.media.volumes[2].density);
    EXPECT_EQ(scene.media.volumes[0].color, nullptr);
    EXPECT_NE(scene.media.volumes[2].color, nullptr);
}

TEST(Prepare, ObjectsMoveOverTheShutter)
{
    const Scene scene = prepare(load_text(plume), 3);
    const MovingTransform& moving = scene.media.volumes[1].world_from_object;
    ASSERT_TRUE(moving.is_moving());
    EXPECT_NEAR(moving.at(0.0f).translate.x, 2.0, 1e-9);
    EXPECT_NEAR(moving.at(1.0f).translate.x, 2.5, 1e-9);
    EXPECT_EQ(scene.frame, 3);
    EXPECT_EQ(scene.shutter_close, 0.5);
    const Scene with_next = prepare(load_text(plume), 3, PrepareNeeds{true});
    EXPECT_NEAR(with_next.next->world_from_object[1].at(0.0f).translate.x, 3.0, 1e-9);
}

TEST(Prepare, KeepsMassInTheGrids)
{
    const Scene scene = prepare(load_text(plume, {"particles.plume.mass=2.5"}), 1);
    // Sum of density times voxel volume; rasterisation conserves it to 1e-5.
    EXPECT_NEAR(scene.media.volumes[0].density->sum * 0.05 * 0.05 * 0.05, 2.5, 5e-5);
}

TEST(Prepare, PlacesLights)
{
    const Scene scene = prepare(load_text(R"(
[[lights]]
type = "sphere"
position = [1, 0, 0]
radius = 0.5
color = [1, 0.5, 0]
strength = 4
transform = [{ frame = 1, scale = 2 }, { frame = 3, rotate = [0, 0, 180] }]
[[lights]]
type = "point"
count = 500
position = [10, 0, 0]
spread = [2, 4, 0]
[[lights]]
type = "distant"
direction = [0, 0, -7]
transform = { rotate = [0, 90, 0], translate = [5, 5, 5] }
[[lights]]
type = "quad"
strength = 0
[[lights]]
type = "environment"
strength = 2
transform = { rotate = [0, 90, 0] }
)"),
                                2);
    ASSERT_EQ(scene.lights.size(), 502u);  // the black quad is left out
    const auto& sphere = std::get<SphereLight>(scene.lights[0]);
    EXPECT_NEAR(glm::length(sphere.position - Vec3(0.0f, 2.0f, 0.0f)), 0.0f, 1e-5f);
    EXPECT_NEAR(sphere.radius, 1.0f, 1e-6f);
    EXPECT_EQ(sphere.radiance, Spectrum(4.0f, 2.0f, 0.0f));
    Bounds3 swarm;
    for (size_t i = 1; i <= 500; ++i) swarm.extend(std::get<PointLight>(scene.lights[i]).position);
    EXPECT_GE(swarm.lo.x, 9.0f);
    EXPECT_LE(swarm.hi.x, 11.0f);
    EXPECT_GT(swarm.extent().y, 3.9f);
    EXPECT_EQ(swarm.extent().z, 0.0f);
    const auto& sun = std::get<DistantLight>(scene.lights[501]);
    EXPECT_NEAR(glm::length(sun.direction - Vec3(-1.0f, 0.0f, 0.0f)), 0.0f, 1e-6f);
    ASSERT_TRUE(scene.environment.has_value());
    EXPECT_EQ(scene.environment->radiance, Spectrum(2.0f));
    const Vec3 seen = scene.environment->map_from_world * Vec3(1.0f, 0.0f, 0.0f);
    EXPECT_NEAR(glm::length(seen - Vec3(0.0f, 0.0f, 1.0f)), 0.0f, 1e-6f);
}

/// A lamp that is switched off keeps its place; brightness runs linearly between keys.
TEST(Prepare, LightsFollowTheirKeys)
{
    const SceneDescription scene = load_text(R"(
[[lights]]
type = "sphere"
strength = 7
color = [1, 0.5, 0]
keys = [{ frame = 1, strength = 8 }, { frame = 3, strength = 4 }, { frame = 4, strength = 0 }]
[[lights]]
type = "distant"
keys = [{ frame = 1, color = 0 }, { frame = 2, color = [1, 0, 0.5] }]
[[lights]]
type = "environment"
strength = 2
keys = [{ frame = 5, strength = 3 }]
)");
    const Scene second = prepare(scene, 2);
    ASSERT_EQ(second.lights.size(), 2u);
    EXPECT_EQ(std::get<SphereLight>(second.lights[0]).radiance, Spectrum(6.0f, 3.0f, 0.0f));
    EXPECT_EQ(std::get<DistantLight>(second.lights[1]).irradiance, Spectrum(1.0f, 0.0f, 0.5f));
    EXPECT_EQ(second.environment->radiance, Spectrum(3.0f));
    const Scene first = prepare(scene, 1);
    ASSERT_EQ(first.lights.size(), 1u) << "the sun is not up yet";
    const Scene last = prepare(scene, 9);
    ASSERT_EQ(last.lights.size(), 2u);
    EXPECT_EQ(std::get<SphereLight>(last.lights[0]).radiance, Spectrum(0.0f));
}

/// Three particles of a file; the second is cold.
struct ParticleLamps {
    TemporaryFolder folder;
    std::string csv = folder.write("points.csv",
                                   "x,y,z,pscale,temperature,Cd_r,Cd_g,Cd_b\n"
                                   "0,0,0,0.5,1500,1,0.5,0\n"
                                   "1,0,0,0.5,0,1,1,1\n"
                                   "0,2,0,0.25,3000,0.5,1,1\n");
    /// The scene's text, with keys of the light.
    [[nodiscard]] std::string text(const std::string& light) const
    {
        return "[[particles]]\nname = \"sparks\"\nfile = \"" + csv +
               "\"\nattributes = { color = \"Cd\" }\n[[lights]]\ntype = \"sphere\"\n"
               "particles = \"sparks\"\nstrength = 4\n" +
               light;
    }
};

TEST(Prepare, ParticlesAsLamps)
{
    const ParticleLamps lamps;
    const Scene plain = prepare(load_text(lamps.text("radius_scale = 0.2")), 1);
    ASSERT_EQ(plain.lights.size(), 3u);
    const auto& first = std::get<SphereLight>(plain.lights[0]);
    EXPECT_EQ(first.radiance, Spectrum(4.0f));
    EXPECT_NEAR(first.radius, 0.1f, 1e-6f);
    EXPECT_EQ(std::get<SphereLight>(plain.lights[1]).position, Vec3(1.0f, 0.0f, 0.0f));

    const Scene all = prepare(load_text(lamps.text("use_color = true\nuse_temperature = true\n"
                                                   "color = [1, 1, 0.5]\n"
                                                   "transform = { translate = [0, 0, 3], "
                                                   "scale = 2 }")),
                              1);
    ASSERT_EQ(all.lights.size(), 2u);  // the cold one gives no light
    const auto& warm = std::get<SphereLight>(all.lights[0]);
    const auto& hot = std::get<SphereLight>(all.lights[1]);
    EXPECT_EQ(hot.position, Vec3(0.0f, 4.0f, 3.0f));
    EXPECT_NEAR(hot.radius, 0.5f, 1e-6f);
    EXPECT_NEAR(warm.radius, 1.0f, 1e-6f);
    const Spectrum at_1500 = Spectrum(4.0f, 2.0f, 0.0f) * blackbody_rgb(1500.0f);
    const Spectrum at_3000 = 16.0f * Spectrum(2.0f, 4.0f, 2.0f) * blackbody_rgb(3000.0f);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(warm.radiance[c], at_1500[c], 1e-4f) << c;
        EXPECT_NEAR(hot.radiance[c], at_3000[c], 1e-3f) << c;
    }
}

/// Lamps follow the particles from frame to frame and come after all others.
TEST(Prepare, ParticleLampsMoveWithTheirParticles)
{
    const std::string text =
        "[camera]\nshutter_close = 1\n[[particles]]\nname = \"p\"\nemitter = \"burst\"\ncount = "
        "50\nstart_time = -0.2\n[[lights]]\ntype = \"sphere\"\nparticles = \"p\"\n"
        "[[lights]]\ntype = \"point\"\n";
    const SceneDescription description = load_text(text);
    SceneCache cache;
    PrepareStats stats;
    const Scene scene = prepare(description, 5, cache, stats);
    const ParticleSet at_middle = particles_at(description.particles[0].source, 5.5, 24.0, "");
    ASSERT_EQ(scene.lights.size(), at_middle.size() + 1);
    EXPECT_EQ(stats.particles, static_cast<int64_t>(at_middle.size()));
    EXPECT_TRUE(std::holds_alternative<PointLight>(scene.lights[0]));
    for (size_t i = 0; i < at_middle.size(); ++i) {
        EXPECT_EQ(std::get<SphereLight>(scene.lights[i + 1]).position, at_middle.position[i]);
    }
}

TEST(Prepare, ParticleLampsSayWhatIsMissing)
{
    const TemporaryFolder folder;
    const std::string csv = folder.write("points.csv", "x,y,z\n0,0,0\n");
    const std::string lamps = "[[particles]]\nname = \"p\"\nfile = \"" + csv +
                              "\"\n[[lights]]\ntype = \"sphere\"\nparticles = \"p\"\n";
    EXPECT_EQ(error_of(lamps), "no error");
    EXPECT_NE(error_of(lamps + "use_color = true")
                  .find("particles \"p\": the source has no color, which \"use_color\" needs"),
              std::string::npos);
    EXPECT_NE(error_of(lamps + "use_temperature = true").find("has no temperature, which"),
              std::string::npos);
    EXPECT_NE(error_of("[[particles]]\nname = \"p\"\nemitter = \"snow\"\ncount = 1_100_000\n"
                       "[[lights]]\ntype = \"sphere\"\nparticles = \"p\"\n")
                  .find("particles \"p\": 1100000 of them are more than the 1000000 lamps"),
              std::string::npos);
}

TEST(Prepare, SaysWhatIsMissing)
{
    EXPECT_NE(error_of("[[objects]]\nfile = \"none.obj\"").find("none.obj"), std::string::npos);
    EXPECT_NE(error_of("[[volumes]]\nfile = \"none.vdb\"").find("none.vdb"), std::string::npos);
    EXPECT_NE(error_of("[[particles]]\nname = \"p\"\nfile = \"none.ply\"\n[[volumes]]\nparticles = "
                       "\"p\"")
                  .find("none.ply"),
              std::string::npos);
    EXPECT_NE(error_of("[[lights]]\ntype = \"environment\"\nimage = \"none.exr\"").find("none.exr"),
              std::string::npos);
    EXPECT_NE(error_of("[[volumes]]\nname = \"v\"\nprocedural = \"puff\"\nuse_color = true")
                  .find("volume \"v\": \"use_color\" needs particles or a file"),
              std::string::npos);
    EXPECT_NE(error_of("[[volumes]]\nname = \"v\"\nprocedural = \"puff\"\nemission = { "
                       "blackbody_scale = 1 }")
                  .find("emission.temperature_offset"),
              std::string::npos);
    const TemporaryFolder folder;
    const std::string csv = folder.write("points.csv", "x,y,z\n0,0,0\n");
    EXPECT_NE(error_of("[[particles]]\nname = \"p\"\nfile = \"" + csv +
                       "\"\n[[volumes]]\nparticles = \"p\"\nuse_color = true")
                  .find("particles \"p\": the source has no color, which \"use_color\" needs"),
              std::string::npos);
}

TEST(Prepare, EmissionOfParticlesFollowsTheirDensity)
{
    const Scene scene = prepare(load_text(plume, {"volumes.smoke.emission={ scale = 3 }"}), 1);
    EXPECT_EQ(scene.media.volumes[0].emission, scene.media.volumes[0].density);
    EXPECT_EQ(scene.media.volumes[0].emission_params.emission_scale, 3.0f);
}

}  // namespace
}  // namespace mote
