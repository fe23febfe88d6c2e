#pragma once

#include <cmath>
#include <cstdio>

#include <malloc.h>

#include "restir/reuse_modes.h"
#include "restir/reuse_runs.h"

namespace mote::test {

[[nodiscard]] inline RenderDescription one_sample(const Scene& scene, const RestirParams& restir,
                                                  uint32_t seed)
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

/// The next frame of a run: light of one event alone.
inline LayeredImage render_next(const Scene& scene, const RestirParams& restir, uint32_t seed,
                                FrameHistory& history)
{
    FrameStats stats;
    LayeredImage image = direct_light_only(render_frame(
        scene, one_sample(scene, restir, seed), direct_light_output(), history, nullptr, stats));
    EXPECT_EQ(stats.dropped_non_finite, 0);
    return image;
}

/// Mean over all channels.
[[nodiscard]] inline double mean_of(const LayeredImage& image)
{
    double sum = 0.0;
    for (const Channel& channel : image.channels) {
        for (const float v : channel.data) sum += static_cast<double>(v);
    }
    return sum / static_cast<double>(3 * image.channels[0].data.size());
}

/// Every reservoir that the next frame may reuse.
inline void expect_sound(const FinishedPass& pass)
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

/// Bytes that the program holds allocated; 0 where sanitizers replace the allocator.
[[nodiscard]] inline size_t heap_bytes()
{
    const struct mallinfo2 info = ::mallinfo2();
    return info.uordblks + info.hblkhd;
}

/// Position in a cycle of `length` that is played forwards and backwards, again and again.
[[nodiscard]] inline size_t to_and_fro(int frame, int length)
{
    if (length == 1) return 0;
    const int at = frame % (2 * length - 2);
    return static_cast<size_t>(at < length ? at : 2 * length - 2 - at);
}

/// Goes through `cycle` forwards and backwards, again and again, in several independent runs.
/// Means of every `block` frames must be those of the path tracer over the same frames: Student's
/// test over runs, since frames within a run are correlated. `alpha` is the false-alarm rate of
/// one block. Memory must not grow after the first block, which ends beyond any warm-up.
inline void expect_steady(std::vector<Scene> cycle, const RestirParams& restir, int frame_count,
                          int block = 100)
{
    constexpr int runs = 8;
    constexpr double alpha = 1e-5;
    const FrameCaches caches = make_frame_caches(cycle);
    const auto length = static_cast<int>(cycle.size());
    std::vector<MeanEstimate> truth;
    for (const Scene& scene : cycle) {
        const TileStats reference = path_traced_runs(scene, 100, {16, 1'000'000});
        MeanEstimate mean;
        for (const TileStats::ChannelStats& c : reference.channels) {
            // Colours are correlated: the sum of their standard errors bounds that of the mean.
            mean = {mean.mean + c.whole_image.mean / 3.0,
                    std::pow(std::sqrt(mean.variance) + c.whole_image.standard_error() / 3.0, 2.0),
                    15.0};
        }
        truth.push_back(mean);
    }
    const int blocks = frame_count / block;
    std::vector<RunningStats> means(static_cast<size_t>(blocks));
    for (int run = 0; run < runs; ++run) {
        FrameHistory history;
        double sum = 0.0;
        size_t heap_at_first = 0;
        for (int frame = 0; frame < frame_count; ++frame) {
            Scene& scene = cycle[to_and_fro(frame, length)];
            scene.frame = frame + 1;
            history.impl().caches = caches[to_and_fro(frame, length)];
            const LayeredImage image =
                render_next(scene, restir, static_cast<uint32_t>(run), history);
            expect_sound(history.impl().before);
            sum += mean_of(image);
            if (frame % block != block - 1) continue;
            means[static_cast<size_t>(frame / block)].add(sum / block);
            sum = 0.0;
            if (frame < block) heap_at_first = heap_bytes();
            EXPECT_LT(heap_bytes(), heap_at_first + 64 * 1024) << "frame " << frame;
        }
    }
    for (int index = 0; index < blocks; ++index) {
        MeanEstimate expected;
        double error = 0.0;
        for (int i = 0; i < block; ++i) {
            const MeanEstimate& at = truth[to_and_fro(block * index + i, length)];
            expected.mean += at.mean / block;
            error += at.standard_error() / block;
        }
        expected.variance = error * error;
        expected.freedom = 15.0;
        const TestResult result =
            welch_test(estimate_mean(means[static_cast<size_t>(index)]), expected);
        EXPECT_GT(result.p, alpha) << "frames " << block * index << ": "
                                   << result.difference.mean / expected.mean << " off";
        if (std::getenv("MOTE_REPORT")) {
            std::printf("frames %4d: %+.2f +- %.2f %%\n", block * index,
                        100.0 * result.difference.mean / expected.mean,
                        100.0 * result.difference.standard_error() / expected.mean);
        }
    }
}

}  // namespace mote::test
