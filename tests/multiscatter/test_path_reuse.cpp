// Light of many events by reservoirs of paths, against the path tracer.

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "multiscatter/reused_path.h"
#include "render/path_pass.h"
#include "restir/hard_reuse_scenes.h"
#include "restir/reuse_runs.h"
#include "restir/room_scenes.h"
#include "restir/runs.h"

namespace mote {
namespace {

/// What is judged: frames, of which the last is compared.
struct PathCase {
    const char* name;
    std::vector<Scene> (*frames)(int count);
    int max_bounces = 4;
};

/// For the names of tests.
void PrintTo(const PathCase& scene, std::ostream* out)
{
    *out << scene.name;
}

struct PathEffort {
    int frames = 3;
    int runs = 32;
    int reference_runs = 32;
    int reference_samples = 24;
};

OutputDescription many_events_output()
{
    OutputDescription output;
    output.aovs = {"volume_indirect"};
    output.color_type = PixelType::Float;
    return output;
}

LayeredImage many_events_only(LayeredImage image)
{
    std::vector<Channel> kept;
    for (Channel& channel : image.channels) {
        if (channel.name.rfind("volume_indirect", 0) == 0) kept.push_back(std::move(channel));
    }
    image.channels = std::move(kept);
    return image;
}

RenderDescription description_of(const Scene& scene, int max_bounces, EstimatorKind estimator)
{
    RenderDescription render;
    render.width = scene.camera.width;
    render.height = scene.camera.height;
    render.estimator = estimator;
    render.path.max_bounces = max_bounces;
    render.samples = 1;
    render.restir.reuse = ReuseMode::Off;
    render.restir.indirect_paths = 4;
    return render;
}

LayeredImage play(std::span<const Scene> frames, const test::FrameCaches& caches,
                  const RenderDescription& render)
{
    FrameHistory history;
    LayeredImage image;
    FrameStats stats;
    for (size_t i = uses_history(render) ? 0 : frames.size() - 1; i < frames.size(); ++i) {
        history.impl().caches = caches[i];
        image = many_events_only(
            render_frame(frames[i], render, many_events_output(), history, nullptr, stats));
        EXPECT_EQ(stats.dropped_non_finite, 0);
    }
    return image;
}

TileStats reference_of(const Scene& scene, int max_bounces, const PathEffort& effort)
{
    RenderDescription render = description_of(scene, max_bounces, EstimatorKind::Path);
    render.samples = effort.reference_samples;
    TileStats stats(test::tile_edge);
    for (int run = 0; run < effort.reference_runs; ++run) {
        render.seed = 100'000 + static_cast<uint32_t>(run);
        FrameHistory history;
        FrameStats frame_stats;
        add_run(stats, many_events_only(render_frame(scene, render, many_events_output(), history,
                                                     nullptr, frame_stats)));
    }
    return stats;
}

/// Ways to reuse; each shift takes part.
std::vector<std::pair<const char*, RestirParams>> ways()
{
    const auto way = [](IndirectReuse reuse, ShiftKind shift) {
        RestirParams p;
        p.reuse = ReuseMode::Off;
        p.indirect_paths = 4;
        p.indirect_reuse = reuse;
        p.shift = shift;
        return p;
    };
    return {{"time, world", way(IndirectReuse::Temporal, ShiftKind::World)},
            {"space, fraction", way(IndirectReuse::Spatial, ShiftKind::Fraction)},
            {"both, numbers", way(IndirectReuse::Both, ShiftKind::RandomNumbers)}};
}

/// Two tests of each way: Welch's of independent runs against the path tracer, and Student's of
/// what reuse adds to the same walks.
void expect_unbiased(const PathCase& scene, const PathEffort& effort)
{
    const std::vector<Scene> frames = scene.frames(effort.frames);
    const test::FrameCaches caches = test::make_frame_caches(frames);
    const TileStats reference = reference_of(frames.back(), scene.max_bounces, effort);
    RenderDescription render =
        description_of(frames.back(), scene.max_bounces, EstimatorKind::Restir);
    for (const auto& [name, params] : ways()) {
        render.restir = params;
        EXPECT_TRUE(reuses_paths(frames.back(), render)) << scene.name;
        TileStats tested(test::tile_edge);
        TileStats added(test::tile_edge);
        for (int run = 0; run < effort.runs; ++run) {
            render.seed = 1 + static_cast<uint32_t>(run);
            render.restir = params;
            const LayeredImage image = play(frames, caches, render);
            add_run(tested, image);
            render.restir.indirect_reuse = IndirectReuse::Spatial;
            render.restir.spatial.neighbours = 0;  // walks alone
            add_run(added, test::difference_of(image, play(frames, caches, render)));
        }
        const RunComparison comparison = compare_runs(tested, reference);
        const test::AddedBias none = test::test_added(added, reference);
        const std::string text = test::summary(std::string(scene.name) + ", " + name, comparison) +
                                 "\n  added " + std::to_string(100.0 * none.whole_image.relative) +
                                 " % +- " +
                                 std::to_string(100.0 * none.whole_image.standard_error) +
                                 " %, p = " + std::to_string(none.p);
        EXPECT_GT(comparison.p, test::alarm) << text;
        EXPECT_GT(none.p, test::alarm) << text;
        EXPECT_EQ(comparison.non_finite, 0) << text;
        if (std::getenv("MOTE_REPORT")) std::printf("%s\n", text.c_str());
    }
}

std::vector<Scene> narrow_frames(int count)
{
    std::vector<Scene> frames = test::sun_and_sky_frames(count);
    for (Scene& scene : frames) {
        scene.media.volumes[0].phase = {0.88f, -0.3f, 0.2f};
        scene.media.volumes[0].albedo = Spectrum(0.99f);
    }
    return frames;
}

/// Walls around smoke, a walk of whose paths go on from there.
std::vector<Scene> room_frames(int count)
{
    std::vector<Scene> frames(static_cast<size_t>(count), test::room());
    for (size_t i = 0; i < frames.size(); ++i) {
        frames[i].frame = 1 + static_cast<int>(i);
        frames[i].camera.width = 8;
        frames[i].camera.height = 6;
    }
    return frames;
}

const PathCase scenes[] = {
    {"still", test::still_frames},
    {"still_unbounded", test::still_frames, 1000},
    {"two_events", test::sun_and_sky_frames, 2},
    {"camera", test::moving_camera_frames},
    {"evolving", test::evolving_smoke_frames, 16},
    {"everything", test::everything_moves_frames},
    {"lights", test::changing_lights_frames},
    {"overlapping", test::overlapping_frames},
    {"flame", test::flame_frames},
    {"sun_and_sky", test::sun_and_sky_frames, 1000},
    {"narrow", narrow_frames, 16},
    {"room", room_frames, 3},
};

class PathReuseStat : public testing::TestWithParam<PathCase> {};

/// Twelve scenes, three ways, two tests: false once in 1,400 sets of seeds.
TEST_P(PathReuseStat, HasTheMeanOfThePathTracer)
{
    expect_unbiased(GetParam(), {});
}

class PathReuseLong : public testing::TestWithParam<PathCase> {};

TEST_P(PathReuseLong, HasTheMeanOfThePathTracer)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    expect_unbiased(GetParam(), {5, 400, 32, 1000});
}

std::string case_name(const testing::TestParamInfo<PathCase>& info)
{
    return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, PathReuseStat, testing::ValuesIn(scenes), case_name);
INSTANTIATE_TEST_SUITE_P(Scenes, PathReuseLong, testing::ValuesIn(scenes), case_name);

/// The negative control: the same effort finds out an event too few.
TEST(PathReuseControlStat, OneEventTooFewIsFoundOut)
{
    const PathEffort effort;
    const std::vector<Scene> frames = test::still_frames(effort.frames);
    const test::FrameCaches caches = test::make_frame_caches(frames);
    const TileStats reference = reference_of(frames.back(), 3, effort);
    RenderDescription render = description_of(frames.back(), 2, EstimatorKind::Restir);
    render.restir.indirect_reuse = IndirectReuse::Both;
    TileStats tested(test::tile_edge);
    for (int run = 0; run < effort.runs; ++run) {
        render.seed = 1 + static_cast<uint32_t>(run);
        add_run(tested, play(frames, caches, render));
    }
    EXPECT_LT(compare_runs(tested, reference).p, test::alarm);
}

TEST(PathReuse, ImagesAreTheSameForAnyThreadCount)
{
    const std::vector<Scene> frames = test::everything_moves_frames(3);
    RenderDescription render = description_of(frames.back(), 8, EstimatorKind::Restir);
    render.samples = 2;
    for (const IndirectReuse reuse :
         {IndirectReuse::Temporal, IndirectReuse::Spatial, IndirectReuse::Both}) {
        render.restir.indirect_reuse = reuse;
        std::vector<float> one;
        for (const int threads : {1, 2, 3}) {
            run_with_threads(threads, [&] {
                FrameHistory history;
                FrameStats stats;
                LayeredImage image;
                for (const Scene& scene : frames) {
                    image = render_frame(scene, render, {}, history, nullptr, stats);
                }
                const Buffer2D<float>& data = image.channels[0].data;
                const std::vector<float> red(data.data(), data.data() + data.size());
                if (threads == 1) one = red;
                EXPECT_EQ(red, one) << threads;
            });
        }
    }
}

/// Frames of one pass each in which nothing changes are means of all so far under `auto`: paths are
/// left alone then.
TEST(PathReuse, LeavesAccumulatedStillsAlone)
{
    const std::vector<Scene> frames = test::still_frames(2);
    RenderDescription render = description_of(frames.back(), 3, EstimatorKind::Restir);
    render.restir.reuse = ReuseMode::Auto;
    render.restir.indirect_reuse = IndirectReuse::Both;
    FrameHistory history;
    FrameStats stats;
    (void)render_frame(frames[0], render, {}, history, nullptr, stats);
    EXPECT_GT(stats.neighbours_used, 0);
    EXPECT_FALSE(history.impl().paths.empty());
    (void)render_frame(frames[1], render, {}, history, nullptr, stats);
    EXPECT_EQ(stats.neighbours_used, 0);
    EXPECT_TRUE(history.impl().paths.empty());
}

/// What history found is kept where nothing has changed, whatever the rule; else the rules differ.
TEST(PathReuse, TracesSuffixesAgainOnlyWhereSomethingHasChanged)
{
    for (const bool still : {true, false}) {
        const std::vector<Scene> frames =
            still ? test::still_frames(3) : test::evolving_smoke_frames(3);
        const test::FrameCaches caches = test::make_frame_caches(frames);
        RenderDescription render = description_of(frames.back(), 4, EstimatorKind::Restir);
        render.restir.indirect_reuse = IndirectReuse::Temporal;
        const LayeredImage traced = play(frames, caches, render);
        render.restir.indirect_suffix = IndirectSuffix::BiasedValidated;
        const LayeredImage kept = play(frames, caches, render);
        const Buffer2D<float>& a = traced.channels[0].data;
        const Buffer2D<float>& b = kept.channels[0].data;
        EXPECT_EQ(std::equal(a.begin(), a.end(), b.begin()), still);
    }
}

/// Lamps that are an eighth as bright in the last frame as before. What paths found of their light
/// is traced again (right), or kept and lags, which is how images of that rule are documented: it
/// must show, but less than a history that is believed whole would have it.
TEST(PathReuseStat, KeptSuffixesLagBehindLamps)
{
    PathEffort effort;
    std::vector<Scene> frames = test::still_frames(effort.frames);
    for (size_t i = 0; i + 1 < frames.size(); ++i) {
        for (Light& light : frames[i].lights) std::get<SphereLight>(light).radiance *= 8.0f;
    }
    const test::FrameCaches caches = test::make_frame_caches(frames);
    const TileStats reference = reference_of(frames.back(), 4, effort);
    RenderDescription render = description_of(frames.back(), 4, EstimatorKind::Restir);
    const auto bias = [&](IndirectSuffix suffix) {
        TileStats added(test::tile_edge);
        for (int run = 0; run < effort.runs; ++run) {
            render.seed = 1 + static_cast<uint32_t>(run);
            render.restir.indirect_suffix = suffix;
            render.restir.indirect_reuse = IndirectReuse::Temporal;
            const LayeredImage image = play(frames, caches, render);
            render.restir.indirect_reuse = IndirectReuse::Spatial;
            render.restir.spatial.neighbours = 0;  // walks alone
            add_run(added, test::difference_of(image, play(frames, caches, render)));
        }
        return test::test_added(added, reference);
    };
    EXPECT_GT(bias(IndirectSuffix::Traced).p, test::alarm);
    const test::AddedBias kept = bias(IndirectSuffix::BiasedValidated);
    EXPECT_LT(kept.p, test::alarm);
    EXPECT_GT(kept.whole_image.relative, 0.0);
    EXPECT_LT(kept.whole_image.relative, 2.0);  // whole histories: 4.7
    if (std::getenv("MOTE_REPORT")) std::printf("lags: %g\n", kept.whole_image.relative);
}

TEST(PathReuse, NeedsAShutterDuringWhichOnlyTheCameraMoves)
{
    std::vector<Scene> frames = test::still_frames(1);
    RenderDescription render = description_of(frames[0], 3, EstimatorKind::Restir);
    EXPECT_FALSE(reuses_paths(frames[0], render));
    render.restir.indirect_reuse = IndirectReuse::Temporal;
    EXPECT_TRUE(reuses_paths(frames[0], render));
    EXPECT_TRUE(uses_history(render));
    render.path.max_bounces = 1;
    EXPECT_FALSE(reuses_paths(frames[0], render));
    EXPECT_FALSE(uses_history(render));
    render.path.max_bounces = 3;
    frames[0].media.volumes[0].world_from_object.keys.push_back({});
    EXPECT_FALSE(reuses_paths(frames[0], render));
}

TEST(PathReuse, KnowsWhatIsBiased)
{
    RestirParams params;
    params.indirect_reuse = IndirectReuse::Both;
    EXPECT_TRUE(is_unbiased(params));
    params.indirect_suffix = IndirectSuffix::BiasedValidated;
    EXPECT_FALSE(is_unbiased(params));
    params.indirect_reuse = IndirectReuse::Spatial;
    EXPECT_TRUE(is_unbiased(params));
    params.mis = ReuseMis::Constant;
    EXPECT_FALSE(is_unbiased(params));
}

}  // namespace
}  // namespace mote
