#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "restir/reuse_modes.h"
#include "restir/reuse_runs.h"
#include "restir/reuse_scenes.h"

namespace mote {
namespace {

RenderDescription one_sample(const Scene& scene, const RestirParams& restir, uint32_t seed)
{
    RenderDescription render;
    render.width = scene.camera.width;
    render.height = scene.camera.height;
    render.samples = 1;
    render.seed = seed;
    render.estimator = EstimatorKind::Restir;
    render.restir = restir;
    return render;
}

LayeredImage render_next(const Scene& scene, const RestirParams& restir, uint32_t seed,
                         FrameHistory& history)
{
    FrameStats stats;
    LayeredImage image =
        test::direct_light_only(render_frame(scene, one_sample(scene, restir, seed),
                                             test::direct_light_output(), history, nullptr, stats));
    EXPECT_EQ(stats.dropped_non_finite, 0);
    return image;
}

double mean_of(const LayeredImage& image)
{
    double sum = 0.0;
    for (const Channel& channel : image.channels) {
        for (const float v : channel.data) sum += static_cast<double>(v);
    }
    return sum / static_cast<double>(3 * image.channels[0].data.size());
}

/// Every reservoir that the next frame may reuse.
void expect_sound(const FinishedPass& pass)
{
    int bad = 0;
    for (const Reservoir& r : pass.reservoirs) {
        const bool sound = std::isfinite(r.W) && r.W >= 0.0f && std::isfinite(r.p_hat) &&
                           r.p_hat >= 0.0f && r.y.u >= 0.0f && r.y.u < 1.0f && r.M >= 1.0f &&
                           r.M < 200.0f && r.age >= 0.0f;
        bad += sound ? 0 : 1;
    }
    EXPECT_EQ(bad, 0);
}

/// Goes through `cycle` forwards and backwards, again and again, in several independent runs.
/// Means of every hundred frames must be those of the path tracer over the same frames: Student's
/// test over runs, since frames within a run are correlated. `alpha` is the false-alarm rate of
/// one hundred.
void expect_steady(std::vector<Scene> cycle, const RestirParams& restir, int frame_count)
{
    constexpr int runs = 8;
    constexpr double alpha = 1e-5;
    const test::FrameCaches caches = test::make_frame_caches(cycle);
    const auto length = static_cast<int>(cycle.size());
    const auto place_of = [&](int frame) {
        if (length == 1) return size_t{0};
        const int at = frame % (2 * length - 2);
        return static_cast<size_t>(at < length ? at : 2 * length - 2 - at);
    };
    std::vector<MeanEstimate> truth;
    for (const Scene& scene : cycle) {
        RunningStats means;
        const TileStats reference = test::path_traced_runs(scene, 100, {16, 1'000'000});
        MeanEstimate mean;
        for (const TileStats::ChannelStats& c : reference.channels) {
            // Colours are correlated: the sum of their standard errors bounds that of the mean.
            mean = {mean.mean + c.whole_image.mean / 3.0,
                    std::pow(std::sqrt(mean.variance) + c.whole_image.standard_error() / 3.0, 2.0),
                    15.0};
        }
        truth.push_back(mean);
    }
    const int hundreds = frame_count / 100;
    std::vector<RunningStats> means(static_cast<size_t>(hundreds));
    for (int run = 0; run < runs; ++run) {
        FrameHistory history;
        double sum = 0.0;
        for (int frame = 0; frame < frame_count; ++frame) {
            Scene& scene = cycle[place_of(frame)];
            scene.frame = frame + 1;
            history.impl().caches = caches[place_of(frame)];
            const LayeredImage image =
                render_next(scene, restir, static_cast<uint32_t>(run), history);
            expect_sound(history.impl().before);
            sum += mean_of(image);
            if (frame % 100 != 99) continue;
            means[static_cast<size_t>(frame / 100)].add(sum / 100.0);
            sum = 0.0;
        }
    }
    for (int hundred = 0; hundred < hundreds; ++hundred) {
        MeanEstimate expected;
        double error = 0.0;
        for (int i = 0; i < 100; ++i) {
            const MeanEstimate& at = truth[place_of(100 * hundred + i)];
            expected.mean += at.mean / 100.0;
            error += at.standard_error() / 100.0;
        }
        expected.variance = error * error;
        expected.freedom = 15.0;
        const TestResult result =
            welch_test(estimate_mean(means[static_cast<size_t>(hundred)]), expected);
        EXPECT_GT(result.p, alpha) << "frames " << 100 * hundred << ": "
                                   << result.difference.mean / expected.mean << " off";
        if (std::getenv("MOTE_REPORT")) {
            std::printf("frames %4d: %+.2f +- %.2f %%\n", 100 * hundred,
                        100.0 * result.difference.mean / expected.mean,
                        100.0 * result.difference.standard_error() / expected.mean);
        }
    }
}

std::vector<Scene> one_still_frame()
{
    return test::still_frames(1);
}

TEST(ReuseSequenceStat, TwoHundredStillFramesKeepTheMean)
{
    expect_steady(one_still_frame(),
                  test::reuse_params(ReuseMode::Both, ShiftKind::RandomNumbers, true), 200);
}

TEST(ReuseSequenceStat, TwoHundredFramesToAndFroKeepTheMean)
{
    expect_steady(test::everything_moves_frames(5),
                  test::reuse_params(ReuseMode::Both, ShiftKind::World, true), 200);
}

TEST(ReuseSequenceLong, AThousandFramesKeepTheMean)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    for (const ShiftKind shift :
         {ShiftKind::RandomNumbers, ShiftKind::World, ShiftKind::Fraction}) {
        for (const bool feedback : {false, true}) {
            const RestirParams restir = test::reuse_params(ReuseMode::Both, shift, feedback);
            expect_steady(one_still_frame(), restir, 1000);
            expect_steady(test::everything_moves_frames(5), restir, 1000);
        }
    }
}

/// As many frames as are given, larger than a tile.
std::vector<Scene> large_frames(int count, const std::string& camera)
{
    using namespace test::scene_text;
    return test::frames_of(image(40, 24) + camera + evolving_puff() + two_lamps + sun_and_sky,
                           count);
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

TEST(ReuseSequence, IsBitIdenticalForAnyThreadCount)
{
    const std::vector<Scene> frames = large_frames(3, test::scene_text::moving_camera);
    for (const ShiftKind shift : {ShiftKind::RandomNumbers, ShiftKind::World}) {
        RestirParams restir = test::reuse_params(ReuseMode::Both, shift, true);
        restir.candidates = 2;
        std::vector<LayeredImage> first;
        for (const int threads : {1, 2, 3, 8}) {
            std::vector<LayeredImage> images;
            run_with_threads(threads, [&] {
                FrameHistory history;
                for (const Scene& scene : frames) {
                    images.push_back(render_next(scene, restir, 7, history));
                }
            });
            if (threads == 1) first = images;
            for (size_t i = 0; i < images.size(); ++i) {
                EXPECT_TRUE(same_bits(first[i], images[i])) << threads << " frame " << i;
            }
        }
    }
}

/// A frame after a cut is the frame rendered alone.
TEST(ReuseSequence, CutsAreClean)
{
    const RestirParams restir = test::reuse_params(ReuseMode::Both, ShiftKind::World, true);
    const std::vector<Scene> frames = large_frames(2, test::scene_text::still_camera);
    Scene behind = frames[1];
    Trs& pose = behind.camera.world_from_camera.keys[0];
    pose.translate = -pose.translate;
    pose.rotate = glm::angleAxis(3.141592653589793, Vec3d(0.0, 1.0, 0.0));
    Scene smaller = frames[1];
    smaller.camera.width = 24;
    smaller.camera.height = 24;
    Scene empty = frames[1];
    empty.media.volumes.clear();
    for (const Scene& cut : {behind, smaller, empty}) {
        FrameHistory history;
        FrameHistory none;
        (void)render_next(frames[0], restir, 7, history);
        const LayeredImage after = render_next(cut, restir, 7, history);
        EXPECT_TRUE(same_bits(after, render_next(cut, restir, 7, none)));
        // And back again.
        const LayeredImage back = render_next(frames[1], restir, 8, history);
        EXPECT_GT(mean_of(back), 0.0);
    }
    // Without a cut, history does make a difference.
    FrameHistory history;
    FrameHistory none;
    (void)render_next(frames[0], restir, 7, history);
    EXPECT_FALSE(same_bits(render_next(frames[1], restir, 7, history),
                           render_next(frames[1], restir, 7, none)));
}

}  // namespace
}  // namespace mote
