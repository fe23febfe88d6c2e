#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/parallel.h"
#include "render/aov.h"
#include "render/frame.h"
#include "render/frame_scenes.h"
#include "render/metadata.h"
#include "scene/aov_names.h"

namespace mote {
namespace {

using test::front_camera;
using test::mean_of;
using test::options;
using test::Options;
using test::render;
using test::slab_scene;

/// Clumps lit by a lamp, a dim sky and their own emission.
Scene cloudy_scene()
{
    Scene scene;
    scene.camera = front_camera(40, 24);
    Volume volume = test::clumpy_cube();
    volume.density_scale = 6.0f;
    volume.albedo = {0.9f, 0.8f, 0.7f};
    volume.phase.g = 0.5f;
    volume.emission = volume.density;
    volume.emission_params.emission_scale = 0.2f;
    finalize(volume);
    scene.media.volumes = {volume};
    scene.lights = {PointLight{{2.0f, 3.0f, 2.0f}, Spectrum(20.0f)}};
    scene.environment = EnvironmentLight{{0.1f, 0.2f, 0.3f}, nullptr, glm::mat3(1.0f)};
    return scene;
}

std::vector<std::string> all_aovs()
{
    std::vector<std::string> names;
    for (const AovInfo& info : aov_table()) names.push_back(info.name);
    return names;
}

bool same_bits(const LayeredImage& a, const LayeredImage& b)
{
    if (a.channels.size() != b.channels.size()) return false;
    for (size_t c = 0; c < a.channels.size(); ++c) {
        const Buffer2D<float>& x = a.channels[c].data;
        const Buffer2D<float>& y = b.channels[c].data;
        if (x.size() != y.size()) return false;
        if (std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) != 0) return false;
    }
    return true;
}

TEST(Frame, BitIdenticalForAnyThreadCount)
{
    const Scene scene = cloudy_scene();
    const Options o = options(3, 20, all_aovs());
    LayeredImage first;
    for (const int threads : {1, 2, 3, 8}) {
        LayeredImage image;
        run_with_threads(threads, [&] { image = render(scene, o); });
        if (threads == 1) first = image;
        EXPECT_TRUE(same_bits(first, image)) << threads;
    }
}

TEST(Frame, SeedAndFrameChangeTheNoise)
{
    Scene scene = cloudy_scene();
    Options o = options(1, 1, {});
    const LayeredImage first = render(scene, o);
    EXPECT_TRUE(same_bits(first, render(scene, o)));
    o.render.seed = 6;
    EXPECT_FALSE(same_bits(first, render(scene, o)));
    o.render.seed = 5;
    scene.frame = 2;
    EXPECT_FALSE(same_bits(first, render(scene, o)));
    scene.frame = -2;
    EXPECT_FALSE(same_bits(first, render(scene, o)));
}

TEST(Frame, LayersDoNotChangeTheImage)
{
    const Scene scene = cloudy_scene();
    const LayeredImage plain = render(scene, options(2, 4, {}));
    ASSERT_EQ(plain.channels.size(), 4u);
    LayeredImage full = render(scene, options(2, 4, all_aovs()));
    EXPECT_GT(full.channels.size(), 25u);
    full.channels.resize(4);
    EXPECT_TRUE(same_bits(plain, full));
}

TEST(Frame, PartsSumToTheImage)
{
    const LayeredImage image = render(cloudy_scene(), options(8, 20, all_aovs()));
    for (const char* c : {"R", "G", "B"}) {
        const std::string suffix = std::string(".") + c;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                float sum = 0.0f;
                for (const char* part :
                     {"volume_direct", "volume_indirect", "volume_emission", "background"}) {
                    sum += image.find(part + suffix)->data.at(x, y);
                }
                // Four floats, each rounded once: a few units in the last place.
                EXPECT_NEAR(image.find(c)->data.at(x, y), sum, 1e-6f * (1.0f + sum));
            }
        }
        for (const char* part : {"volume_direct", "volume_indirect", "volume_emission"}) {
            EXPECT_GT(mean_of(image, part + suffix), 0.0);
        }
    }
}

/// Telephoto view through a cube of constant extinction: all rays are within 1e-4 of parallel.
TEST(FrameStat, SlabHasItsTransmittanceAlphaAndDepth)
{
    // 11 voxels 0.2 m apart: the reconstruction's integral along the axis is 2.2 m.
    const double tau = 0.7 * 2.2;
    const LayeredImage image = render(slab_scene(0.7f), options(25, 1, all_aovs()));
    for (const float v : image.find("opticalDepth.Y")->data) EXPECT_NEAR(v, tau, 3e-4 * tau);
    for (const float v : image.find("transmittance.G")->data) {
        EXPECT_NEAR(v, std::exp(-tau), 1e-3 * std::exp(-tau));
    }
    // 10,000 paths either collide or not; 5 standard errors: false once in 1.7 million seeds.
    const double error = std::sqrt(std::exp(-tau) * (1.0 - std::exp(-tau)) / 10'000.0);
    EXPECT_NEAR(mean_of(image, "A"), 1.0 - std::exp(-tau), 5.0 * error);
    EXPECT_NEAR(mean_of(image, "albedo.R"), 0.5 * (1.0 - std::exp(-tau)), 5.0 * error);
    // First collisions lie in [2.8, 5.2] m from the camera. Their mean depth within a slab of
    // thickness 2 s: m = 1/sigma - 2 s e^-tau / (1 - e^-tau) behind the front; the ramps of one
    // voxel at both faces are symmetric about +-1.1 m and move it by less than 0.01 m.
    const double mean_depth = 2.9 + 1.0 / 0.7 - 2.2 * std::exp(-tau) / (1.0 - std::exp(-tau));
    EXPECT_NEAR(mean_of(image, "volume_Z.Z"), mean_depth, 0.01 + 5.0 * 0.64 / std::sqrt(7800.0));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            EXPECT_GE(image.find("Z")->data.at(x, y), 2.8f - 1e-4f);
            EXPECT_LE(image.find("Z")->data.at(x, y), image.find("volume_Z.Z")->data.at(x, y));
        }
    }
}

TEST(Frame, EmptySceneShowsItsSky)
{
    Scene scene;
    scene.camera = front_camera(17, 9);
    scene.environment = EnvironmentLight{{0.25f, 0.5f, 1.0f}, nullptr, glm::mat3(1.0f)};
    FrameStats stats;
    const LayeredImage image = render(scene, options(2, 3, all_aovs()), &stats);
    EXPECT_EQ(stats.paths, 17 * 9 * 2);
    EXPECT_EQ(stats.dropped_non_finite, 0);
    EXPECT_EQ(stats.truncation.paths, 0);
    for (int y = 0; y < 9; ++y) {
        for (int x = 0; x < 17; ++x) {
            const auto value = [&](const char* name) { return image.find(name)->data.at(x, y); };
            EXPECT_EQ(value("G"), 0.5f);
            EXPECT_EQ(value("A"), 0.0f);
            EXPECT_EQ(value("background.B"), 1.0f);
            EXPECT_EQ(value("Z"), background_depth);
            EXPECT_EQ(value("volume_Z.Z"), background_depth);
            EXPECT_EQ(value("transmittance.R"), 1.0f);
            EXPECT_EQ(value("variance.R"), 0.0f);
            EXPECT_EQ(value("samples.Y"), 2.0f);
            EXPECT_EQ(value("motion.u"), 0.0f);
        }
    }
}

TEST(Frame, NonFiniteSamplesAreCountedAndBlack)
{
    Scene scene;
    scene.camera = front_camera(16, 16);
    const float bad = std::numeric_limits<float>::quiet_NaN();
    scene.environment = EnvironmentLight{{bad, 1.0f, 1.0f}, nullptr, glm::mat3(1.0f)};
    FrameStats stats;
    const LayeredImage image = render(scene, options(2, 1, {}), &stats);
    EXPECT_EQ(stats.dropped_non_finite, 16 * 16 * 2);
    EXPECT_EQ(mean_of(image, "G"), 0.0);
}

TEST(Frame, WorkIsCountedTheSameForAnyThreads)
{
    const Scene scene = slab_scene(0.7f);
    for (const EstimatorKind estimator : {EstimatorKind::Path, EstimatorKind::Restir}) {
        RenderDescription with = options(2, 3, {}).render;
        with.estimator = estimator;
        const auto work = [&](int threads) {
            FrameStats stats;
            FrameHistory history;
            run_with_threads(threads, [&] {
                (void)render_frame(scene, with, OutputDescription{}, history, nullptr, stats);
            });
            EXPECT_GT(stats.memory.grids, 0u);
            EXPECT_EQ(stats.memory.film, scene.camera.width * scene.camera.height * 4u * 4u);
            EXPECT_EQ(stats.tracking.majorant_violations, 0);
            const TrackingCounts& t = stats.tracking;
            return std::vector<int64_t>{t.free_flights, t.shadow_rays, t.lookups, t.closed_bricks,
                                        stats.cells};
        };
        const std::vector<int64_t> one = work(1);
        EXPECT_GT(one[0], 0);
        EXPECT_EQ(one, work(3));
    }
}

TEST(Frame, StopsBetweenTiles)
{
    const Options o = options(1, 1, {});
    FrameStats stats;
    FrameHistory history;
    const LayeredImage image = render_frame(
        cloudy_scene(), o.render, o.output, history, [] { return true; }, stats);
    EXPECT_TRUE(image.channels.empty());
    EXPECT_EQ(image.width, 0);
}

TEST(Frame, StopsWithinAPixel)
{
    // One pixel of so many samples that a look at the flag per pixel would come hours later.
    static std::atomic<int> looks{0};
    const Options o = options(2'000'000'000, 1, {});
    Scene scene = cloudy_scene();
    scene.camera.width = 1;
    scene.camera.height = 1;
    FrameStats stats;
    FrameHistory history;
    const LayeredImage image = render_frame(
        scene, o.render, o.output, history, [] { return ++looks > 3; }, stats);
    EXPECT_TRUE(image.channels.empty());
    EXPECT_EQ(looks, 4);
}

TEST(Frame, SceneFilesKnowTheSameLayers)
{
    const std::vector<std::string> known(aov_names.begin(), aov_names.end());
    for (const std::string& name : all_aovs()) {
        EXPECT_NE(std::find(known.begin(), known.end(), name), known.end()) << name;
    }
    EXPECT_NO_THROW((void)parse_aovs(known));
}

TEST(Motion, FollowsObjectsTheirVelocityAndTheCamera)
{
    // At depth 4 m the film is 2 * 4 * 0.6 = 4.8 m high for 24 pixels: 5 pixels per metre.
    Scene scene = slab_scene(100.0f);
    scene.camera = front_camera(24, 24);
    scene.fps = 25.0;
    Volume& slab = scene.media.volumes[0];
    Trs pose;
    pose.translate = {0.0, 0.0, -1.1};  // its front face is at z = 0
    slab.world_from_object.keys = {pose};
    finalize(slab);
    const auto motion_at_centre = [&] {
        const LayeredImage image = render(scene, options(4, 1, {"motion"}));
        return Vec2(image.find("motion.u")->data.at(12, 12),
                    image.find("motion.v")->data.at(12, 12));
    };
    EXPECT_EQ(motion_at_centre(), Vec2(0.0f));

    // 0.4 m to the right, 0.2 m up in a frame: u = +2, v = +1 pixels (depth within 0.1 m: 3 %).
    scene.next = NextFrame{scene.camera, {slab.world_from_object}, {}};
    scene.next->world_from_object[0].keys[0].translate += Vec3d(0.4, 0.2, 0.0);
    EXPECT_NEAR(motion_at_centre().x, 2.0f, 0.06f);
    EXPECT_NEAR(motion_at_centre().y, 1.0f, 0.03f);

    // The camera moves along with it: nothing moves on the film.
    scene.next->camera.world_from_camera.keys[0].translate += Vec3d(0.4, 0.2, 0.0);
    EXPECT_NEAR(motion_at_centre().x, 0.0f, 1e-4f);

    // 10 m/s to the right for 1/25 s is 0.4 m.
    auto velocity = std::make_shared<ColorGrid>();
    const float components[3] = {10.0f, 5.0f, 0.0f};
    for (int c = 0; c < 3; ++c) {
        const std::vector<float> values(27, components[c]);
        velocity->channel[c] = *make_dense_bricks(Vec3i(3), values, Affine{Mat3(0.5f), Vec3(1.0f)});
    }
    slab.velocity = velocity;
    finalize(slab);
    scene.next.reset();
    EXPECT_NEAR(motion_at_centre().x, 2.0f, 0.06f);
    EXPECT_NEAR(motion_at_centre().y, 1.0f, 0.03f);
}

TEST(Motion, BackgroundMovesWithTheCamerasRotation)
{
    Scene scene;
    scene.camera = front_camera(24, 24);
    scene.next = NextFrame{scene.camera, {}, {}};
    Trs& pose = scene.next->camera.world_from_camera.keys[0];
    pose.translate.x += 3.0;                                   // no parallax at infinity
    pose.rotate = glm::angleAxis(0.02, Vec3d(0.0, 1.0, 0.0));  // to the left: the sky goes right
    const LayeredImage image = render(scene, options(1, 1, {"motion"}));
    // 12 pixels per 0.6 of tangent; near the axis tan 0.02.
    EXPECT_NEAR(image.find("motion.u")->data.at(12, 12), std::tan(0.02) * 12.0 / 0.6, 0.01);
    EXPECT_NEAR(image.find("motion.v")->data.at(12, 12), 0.0f, 0.01f);
}

TEST(Metadata, WorldToNdcAgreesWithTheCamera)
{
    Camera camera = front_camera(64, 36);
    Trs& pose = camera.world_from_camera.keys[0];
    pose.translate = {1.0, 2.0, 3.0};
    pose.rotate = glm::angleAxis(0.4, glm::normalize(Vec3d(1.0, 2.0, 3.0)));
    const std::vector<Attribute> attributes = camera_attributes(camera);
    ASSERT_EQ(attributes[0].name, "worldToCamera");
    ASSERT_EQ(attributes[1].name, "worldToNDC");
    const auto& to_camera = std::get<std::vector<float>>(attributes[0].value);
    const auto& to_ndc = std::get<std::vector<float>>(attributes[1].value);
    Rng rng(1, 0, Stream::Test, 0, 0);
    for (int i = 0; i < 20; ++i) {
        const Ray ray = generate_ray(camera, Vec2(64.0f, 36.0f) * rng.uniform2(), Vec2(0.5f), 0.0f);
        const Vec3 p = ray.at(2.0f + rng.uniform());
        const Vec2 film = *project(camera, p, 0.0f);
        // Row vectors: result[c] = sum over r of p[r] m[4 r + c].
        float ndc[4];
        float z = to_camera[14];
        for (size_t c = 0; c < 4; ++c) {
            ndc[c] = to_ndc[12 + c];
            for (size_t r = 0; r < 3; ++r) ndc[c] += p[static_cast<int>(r)] * to_ndc[4 * r + c];
        }
        for (size_t r = 0; r < 3; ++r) z += p[static_cast<int>(r)] * to_camera[4 * r + 2];
        EXPECT_NEAR(ndc[0] / ndc[3], film.x / 64.0f, 1e-4f);
        EXPECT_NEAR(ndc[1] / ndc[3], film.y / 36.0f, 1e-4f);
        EXPECT_GT(z, 0.0f);  // looks along +z
    }
}

}  // namespace
}  // namespace mote
