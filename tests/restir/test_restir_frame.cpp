#include <gtest/gtest.h>

#include <cstring>

#include "core/parallel.h"
#include "render/camera_pass.h"
#include "restir/in_view.h"
#include "restir/runs.h"
#include "scene/aov_names.h"

namespace mote {
namespace {

using test::TestScene;

OutputDescription all_layers()
{
    OutputDescription output;
    output.aovs.assign(aov_names.begin(), aov_names.end());
    output.color_type = PixelType::Float;
    return output;
}

RenderDescription render_of(const TestScene& test, int samples)
{
    RenderDescription render = test::description(test, EstimatorKind::Restir, samples);
    render.seed = 3;
    return render;
}

LayeredImage render(const TestScene& test, const RenderDescription& description, FrameStats& stats,
                    const OutputDescription& output = all_layers())
{
    FrameHistory history;
    return render_frame(test.scene, description, output, history, nullptr, stats);
}

bool same_bits(const LayeredImage& a, const LayeredImage& b)
{
    if (a.channels.size() != b.channels.size() || a.channels.empty()) return false;
    for (size_t c = 0; c < a.channels.size(); ++c) {
        const Buffer2D<float>& x = a.channels[c].data;
        const Buffer2D<float>& y = b.channels[c].data;
        if (x.size() != y.size()) return false;
        if (std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) != 0) return false;
    }
    return true;
}

TEST(RestirFrame, BitIdenticalForAnyThreadCount)
{
    for (TestScene test : {test::everything_at_once(), test::moving_through_a_lens()}) {
        test.scene.camera.width = 40;  // six tiles
        test.scene.camera.height = 20;
        for (const bool control_variate : {true, false}) {
            RenderDescription description = render_of(test, 2);
            description.restir.control_variate = control_variate;
            LayeredImage first;
            for (const int threads : {1, 2, 3, 8}) {
                LayeredImage image;
                FrameStats stats;
                run_with_threads(threads, [&] { image = render(test, description, stats); });
                if (threads == 1) first = image;
                EXPECT_TRUE(same_bits(first, image)) << test.name << ", " << threads << " threads";
            }
        }
    }
}

TEST(RestirFrame, SeedsAndFramesChangeTheNoise)
{
    TestScene test = test::overlapping();
    RenderDescription description = render_of(test, 1);
    FrameStats stats;
    const LayeredImage first = render(test, description, stats);
    EXPECT_TRUE(same_bits(first, render(test, description, stats)));
    description.seed = 4;
    EXPECT_FALSE(same_bits(first, render(test, description, stats)));
    description.seed = 3;
    test.scene.frame = 2;
    EXPECT_FALSE(same_bits(first, render(test, description, stats)));
}

TEST(RestirFrame, IsWhatThePassesGiveWithFreshCaches)
{
    const TestScene test = test::overlapping();
    const RenderDescription description = render_of(test, 2);
    OutputDescription output;
    output.aovs = test::part_names;
    output.color_type = PixelType::Float;
    FrameStats stats;
    const LayeredImage image = render(test, description, stats, output);
    const int64_t pixel_passes = int64_t{description.width} * description.height * 2;
    const TileStats passes = test::runs_with_caches(
        test, make_light_caches(test.scene, {pixel_passes}, nullptr), description, 1, 3);
    TileStats frame(4);
    add_run(frame, image);
    for (size_t c = 0; c < frame.channels.size(); ++c) {
        EXPECT_EQ(frame.channels[c].whole_image.mean, passes.channels[c].whole_image.mean);
    }
}

/// Mean of a channel, pixels of no depth left out.
double mean_of(const LayeredImage& image, const std::string& channel)
{
    RunningStats stats;
    for (const float v : image.find(channel)->data) {
        if (v < background_depth) stats.add(static_cast<double>(v));
    }
    return stats.mean;
}

TEST(RestirFrameStat, DataLayersAreThoseOfThePathTracer)
{
    // 3 % of each mean: 5 standard errors of the path tracer's or more; depths vary by the metre.
    for (const float density : {1.0f, 60.0f}) {
        const TestScene test = test::sun_and_sky(density);
        FrameStats stats;
        const LayeredImage tested = render(test, render_of(test, 200), stats);
        const LayeredImage truth =
            render(test, test::description(test, EstimatorKind::Path, 4000), stats);
        for (const char* name :
             {"A", "albedo.R", "volume_Z.Z", "transmittance.G", "opticalDepth.Y", "background.B"}) {
            const double mean = mean_of(truth, name);
            EXPECT_NEAR(mean_of(tested, name), mean, 0.03 * mean) << name << ", " << density;
        }
    }
}

TEST(RestirFrame, TheWorkLayerAddsUpToTheCounters)
{
    TestScene test = test::everything_at_once();
    RenderDescription description = render_of(test, 2);
    description.restir.reuse = ReuseMode::Spatial;
    FrameStats stats;
    const LayeredImage image = render(test, description, stats);
    const auto sum = [&](const char* channel) {
        double total = 0.0;
        for (const float v : image.find(channel)->data) total += static_cast<double>(v);
        return total;
    };
    EXPECT_EQ(2.0 * sum("work.candidates"), static_cast<double>(stats.candidates));
    EXPECT_GT(sum("work.cells"), 0.0);
    EXPECT_LT(2.0 * sum("work.cells"), static_cast<double>(stats.cells));  // light rays have theirs
    const Buffer2D<float>& acceptance = image.find("work.acceptance")->data;
    const Buffer2D<float>& depth = image.find("opticalDepth.Y")->data;
    double used = 0.0;
    for (size_t i = 0; i < acceptance.size(); ++i) {
        const float share = acceptance.data()[i];
        EXPECT_TRUE(share >= 0.0f && share <= 1.0f) << share;
        EXPECT_TRUE(share == 0.0f || depth.data()[i] > 0.0f);
        used += static_cast<double>(share) * description.restir.spatial.neighbours;
    }
    EXPECT_NEAR(2.0 * used, static_cast<double>(stats.neighbours_used), 1e-3 * 2.0 * used);
}

/// Counters of work on light.
void expect_idle(const FrameStats& stats, const std::string& what)
{
    EXPECT_EQ(stats.light_rays, 0) << what;
    EXPECT_EQ(stats.candidates, 0) << what;
    EXPECT_EQ(stats.dropped_non_finite, 0) << what;
}

TEST(RestirFrame, NothingToDoIsNothingDone)
{
    FrameStats stats;
    TestScene empty = test::sun_and_sky();
    empty.scene.media.volumes.clear();
    empty.scene.lights.push_back(PointLight{});
    LayeredImage image = render(empty, render_of(empty, 2), stats);
    expect_idle(stats, "no media");
    EXPECT_EQ(stats.cells, 0);
    EXPECT_EQ(stats.camera_rays, 0);
    EXPECT_EQ(mean_of(image, "A"), 0.0);
    EXPECT_NEAR(mean_of(image, "B"), 0.4, 1e-6);

    stats = {};
    empty.scene.media.volumes.emplace_back();  // a volume without a grid
    image = render(empty, render_of(empty, 2), stats);
    expect_idle(stats, "void");
    EXPECT_EQ(stats.cells, 0);

    stats = {};
    TestScene beside = test::everything_at_once();
    beside.scene.camera = test::small_camera({0.0f, 0.0f, 9.0f});
    beside.scene.camera.world_from_camera.keys[0].rotate = {0.0, 0.0, 1.0, 0.0};  // looks away
    (void)render(beside, render_of(beside, 2), stats);
    expect_idle(stats, "looks away");
    EXPECT_EQ(stats.cells, 0);

    stats = {};
    TestScene dark = test::sun_and_sky();
    dark.scene.lights.clear();
    dark.scene.environment.reset();
    image = render(dark, render_of(dark, 2), stats);
    expect_idle(stats, "no lights");
    EXPECT_GT(stats.camera_rays, 0);  // alpha still wants to be known
    EXPECT_EQ(mean_of(image, "R"), 0.0);
    EXPECT_GT(mean_of(image, "A"), 0.1);

    stats = {};
    dark.scene.lights = {DistantLight{Vec3(0.0f, 1.0f, 0.0f), Spectrum(0.0f)},
                         PointLight{Vec3(0.0f), Spectrum(0.0f)}};
    dark.scene.environment = EnvironmentLight{Spectrum(0.0f), nullptr, Mat3(1.0f)};
    (void)render(dark, render_of(dark, 2), stats);
    expect_idle(stats, "black lights");

    stats = {};
    const TestScene lit = test::everything_at_once();
    RenderDescription description = render_of(lit, 2);
    description.path.max_bounces = 0;
    (void)render(lit, description, stats);
    expect_idle(stats, "no scattering wanted");
}

TEST(RestirFrame, HistoryKeepsCachesAndChangesNothing)
{
    const TestScene test = test::overlapping();
    const RenderDescription description = render_of(test, 2);
    FrameHistory history;
    FrameStats stats;
    const LayeredImage first =
        render_frame(test.scene, description, all_layers(), history, nullptr, stats);
    const LayeredImage second =
        render_frame(test.scene, description, all_layers(), history, nullptr, stats);
    EXPECT_TRUE(same_bits(first, second));
}

TEST(RestirFrame, StopsBetweenPasses)
{
    const TestScene test = test::everything_at_once();
    FrameHistory history;
    FrameStats stats;
    const LayeredImage image = render_frame(
        test.scene, render_of(test, 1'000'000), all_layers(), history, [] { return true; }, stats);
    EXPECT_TRUE(image.channels.empty());
}

TEST(RestirFrame, ExtremesStayFinite)
{
    for (const float density : {1e-8f, 1e4f, 1e8f}) {
        for (const float power : {1e-20f, 1e15f}) {
            for (const float g : {0.999f, -0.999f}) {
                TestScene test = test::everything_at_once();
                for (Volume& volume : test.scene.media.volumes) {
                    volume.density_scale = density;
                    volume.phase.g = g;
                    finalize(volume);
                }
                test.scene.lights.push_back(PointLight{Vec3(0.05f), Spectrum(power)});
                test.scene.lights.push_back(SphereLight{Vec3(0.1f), 1e-6f, Spectrum(power)});
                test.scene.lights.push_back(SphereLight{Vec3(0.0f), 1e6f, Spectrum(power)});
                for (const bool control_variate : {true, false}) {
                    RenderDescription description = render_of(test, 2);
                    description.restir.control_variate = control_variate;
                    FrameStats stats;
                    const LayeredImage image = render(test, description, stats);
                    EXPECT_EQ(stats.dropped_non_finite, 0) << density << " " << power << " " << g;
                    for (const Channel& c : image.channels) {
                        for (const float v : c.data) ASSERT_TRUE(std::isfinite(v)) << c.name;
                    }
                }
            }
        }
    }
}

/// Single passes of a scene at rest add up: frame n is the mean of the n images that the same
/// frames have on their own. A change of any kind starts anew.
TEST(RestirFrame, AutoAddsUpSinglePassesOfASceneAtRest)
{
    TestScene test = test::everything_at_once();
    RenderDescription automatic = render_of(test, 1);
    automatic.restir.reuse = ReuseMode::Auto;
    const RenderDescription alone = render_of(test, 1);
    OutputDescription output;
    output.color_type = PixelType::Float;
    FrameHistory history;
    FrameHistory twin;  // sees the same scenes, so that its caches are the same
    const auto frame = [&](int number, const RenderDescription& description, FrameHistory& h) {
        FrameStats stats;
        test.scene.frame = number;
        return render_frame(test.scene, description, output, h, nullptr, stats);
    };
    const auto green = [](const LayeredImage& image) { return image.find("G")->data; };
    std::vector<double> sum;
    for (int n = 1; n <= 4; ++n) {
        const Buffer2D<float> own = green(frame(n, alone, twin));
        const Buffer2D<float> mean = green(frame(n, automatic, history));
        sum.resize(own.size());
        for (size_t i = 0; i < own.size(); ++i) {
            sum[i] += static_cast<double>(own.data()[i]);
            EXPECT_NEAR(mean.data()[i], sum[i] / n, 1e-5 * (1.0 + sum[i])) << n;
        }
    }
    const auto starts_anew = [&](const char* what) {
        const LayeredImage fresh = frame(9, alone, twin);
        EXPECT_TRUE(same_bits(fresh, frame(9, automatic, history))) << what;
    };
    test.scene.lights.push_back(PointLight{Vec3(0.0f, 3.0f, 0.0f), Spectrum(1.0f)});
    starts_anew("a light");
    test.scene.camera.tan_half_fov_y *= 1.1f;
    starts_anew("the camera");
    test.scene.media.volumes.front().albedo *= 0.9f;
    starts_anew("an albedo");
    test.scene.camera.width += 2;
    starts_anew("the size");
}

/// Tiles that show one background are not traced, and look as if they were.
TEST(RestirFrame, UniformTilesAreThoseThatSeeNoMedium)
{
    TestScene test = test::sun_and_sky();
    test.scene.camera.width = 160;
    test.scene.camera.height = 90;
    test.scene.camera.tan_half_fov_y *= 4.0f;
    const auto lights = build_light_sampler(test.scene, {});
    RenderDescription description = render_of(test, 1);
    const FrameDomain domain =
        make_frame_domain({std::shared_ptr<const Scene>(), &test.scene},
                          make_light_caches(test.scene, {1000}, nullptr), description.restir);
    const PassInputs inputs{domain, description, {}, lights};
    int uniform = 0;
    for (int y = 0; y + 10 <= 90; y += 10) {
        for (int x = 0; x + 10 <= 160; x += 10) {
            const auto sample = uniform_tile(inputs, {x, y, x + 10, y + 10});
            if (!sample) continue;
            ++uniform;
            EXPECT_EQ(sample->background, test.scene.environment->radiance);
            for (int i = 0; i < 100; ++i) {
                PixelDomain pixel;
                BinCounts counts;
                const PassKey key{x + i % 10, y + i / 10, 0};
                make_pixel_domain(domain, camera_ray(inputs, key), pixel, counts);
                EXPECT_TRUE(pixel.bins.empty());
            }
        }
    }
    EXPECT_GT(uniform, 80);   // of 144
    EXPECT_LT(uniform, 140);  // the middle is smoke
    test.scene.environment = test::image_sky();
    EXPECT_FALSE(uniform_tile(inputs, {0, 0, 10, 10}));
}

/// Media out of view cost no caches; whatever a camera ray can meet is in view.
TEST(RestirFrame, NothingIsBuiltForMediaOutOfView)
{
    TestScene test = test::everything_at_once();
    test.scene.camera.world_from_camera = {};
    test.scene.camera.lens_radius = 0.0f;
    test.scene.camera.world_from_camera.keys.front().translate = Vec3d(0.0, 0.0, -50.0);
    FrameStats stats;
    (void)render(test, render_of(test, 1), stats);  // looks along -z, away from all
    EXPECT_EQ(stats.caches_built, 0);
    EXPECT_EQ(stats.camera_rays, 0);

    int in_view = 0;
    int out_of_view = 0;
    for (uint32_t trial = 0; trial < 3000; ++trial) {
        Rng rng(7, 0, Stream::Test, trial, 0);
        Trs& place = test.scene.camera.world_from_camera.keys.front();
        place.translate = 6.0 * Vec3d(rng.uniform3()) - 3.0;
        place.rotate = glm::normalize(Quatd(rng.uniform() - 0.5, rng.uniform() - 0.5,
                                            rng.uniform() - 0.5, rng.uniform() - 0.5));
        test.scene.camera.tan_half_fov_y = 0.05f + rng.uniform();
        bool met = false;
        for (int i = 0; i < 8 && !met; ++i) {
            const Vec2 film =
                rng.uniform2() * Vec2(test.scene.camera.width, test.scene.camera.height);
            const Ray ray = generate_ray(test.scene.camera, film, Vec2(0.5f), rng.uniform());
            for (const Volume& volume : test.scene.media.volumes) {
                met = met || !volume_interval(volume, ray, {0.0f, infinity}).is_empty();
            }
        }
        const bool seen = media_in_view(test.scene);
        EXPECT_TRUE(seen || !met) << trial;
        ++(seen ? in_view : out_of_view);
    }
    EXPECT_GT(in_view, 300);
    EXPECT_GT(out_of_view, 300);
}

}  // namespace
}  // namespace mote
