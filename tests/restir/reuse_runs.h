#pragma once

#include <algorithm>
#include <cstdlib>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "render/frame.h"
#include "render/restir_frame.h"
#include "verify/tiles.h"

namespace mote::test {

/// The long forms run only when asked for, see tests/CMakeLists.txt.
[[nodiscard]] inline bool runs_long_tests()
{
    const char* value = std::getenv("MOTE_LONG_TESTS");
    return value && std::string(value) == "1";
}

/// Light of one scattering event alone, in media and on surfaces: what reservoirs are about. Tiles
/// of 4 x 3 pixels, 3 x 3 in images of 9 rows.
inline constexpr int tile_edge = 4;
inline OutputDescription direct_light_output()
{
    OutputDescription output;
    output.aovs = {"volume_direct", "direct"};
    output.color_type = PixelType::Float;
    return output;
}

inline LayeredImage direct_light_only(LayeredImage image)
{
    std::vector<Channel> kept;
    for (Channel& channel : image.channels) {
        const bool is_black = std::all_of(channel.data.begin(), channel.data.end(),
                                          [](float value) { return value == 0.0f; });
        const bool of_media = channel.name.rfind("volume_direct", 0) == 0;
        const bool of_surfaces = channel.name.rfind("direct", 0) == 0;
        if (of_media || (of_surfaces && !is_black)) kept.push_back(std::move(channel));
    }
    image.channels = std::move(kept);
    return image;
}

/// Light caches of each frame, made once for all runs: they are the same in all of them.
using FrameCaches = std::vector<std::shared_ptr<const LightCaches>>;
[[nodiscard]] inline FrameCaches make_frame_caches(std::span<const Scene> frames)
{
    FrameCaches caches;
    for (const Scene& scene : frames) {
        const auto previous = caches.empty() ? nullptr : caches.back();
        caches.push_back(make_light_caches(scene, {1000}, previous));
    }
    return caches;
}

/// How many independent runs, and the numbers they start from.
struct RunCount {
    int runs = 32;
    uint32_t first_seed = 1;
    int samples = 1;  ///< per pixel and frame, of the tested renderer
};

/// a - b, pixel by pixel.
[[nodiscard]] inline LayeredImage difference_of(LayeredImage a, const LayeredImage& b)
{
    for (size_t c = 0; c < a.channels.size(); ++c) {
        for (size_t i = 0; i < a.channels[c].data.size(); ++i) {
            a.channels[c].data.data()[i] -= b.channels[c].data.data()[i];
        }
    }
    return a;
}

/// Independent runs of a way to reuse.
struct ReuseRuns {
    TileStats images{tile_edge};
    /// What reuse adds to the same camera rays and candidates without it. Those have the right mean
    /// and much of the noise in common, so a bias shows sooner here.
    TileStats added{tile_edge};
};

/// Plays the frames from an empty history, once per seed, and collects the last frame of each run.
/// `restir` says how.
[[nodiscard]] inline ReuseRuns play_runs(std::span<const Scene> frames, const FrameCaches& caches,
                                         const RestirParams& restir, const RunCount& count)
{
    ReuseRuns out;
    RenderDescription render;
    render.width = frames.front().camera.width;
    render.height = frames.front().camera.height;
    render.samples = count.samples;
    render.estimator = EstimatorKind::Restir;
    const OutputDescription output = direct_light_output();
    FrameStats stats;
    render.restir = restir;
    const bool has_history = uses_history(render);
    for (int run = 0; run < count.runs; ++run) {
        render.seed = count.first_seed + static_cast<uint32_t>(run);
        render.restir = restir;
        FrameHistory history;
        LayeredImage image;
        for (size_t i = has_history ? 0 : frames.size() - 1; i < frames.size(); ++i) {
            history.impl().caches = caches[i];
            image =
                direct_light_only(render_frame(frames[i], render, output, history, nullptr, stats));
            EXPECT_EQ(stats.dropped_non_finite, 0);
        }
        add_run(out.images, image);
        LayeredImage plain = image;
        if (restir.reuse != ReuseMode::Off) {
            render.restir.reuse = ReuseMode::Off;
            FrameHistory none;
            none.impl().caches = caches.back();
            plain = direct_light_only(
                render_frame(frames.back(), render, output, none, nullptr, stats));
        }
        add_run(out.added, difference_of(std::move(image), plain));
    }
    return out;
}

/// Runs of the reference path tracer, `samples` per pixel each.
[[nodiscard]] inline TileStats path_traced_runs(const Scene& scene, int samples,
                                                const RunCount& count)
{
    TileStats stats(tile_edge);
    RenderDescription render;
    render.width = scene.camera.width;
    render.height = scene.camera.height;
    render.samples = samples;
    render.estimator = EstimatorKind::Path;
    render.path.transmittance = TransmittanceKind::Exact;
    render.path.equiangular = true;  // lamps stand in smoke
    const OutputDescription output = direct_light_output();
    for (int run = 0; run < count.runs; ++run) {
        render.seed = count.first_seed + static_cast<uint32_t>(run);
        FrameHistory history;
        FrameStats frame_stats;
        add_run(stats, direct_light_only(
                           render_frame(scene, render, output, history, nullptr, frame_stats)));
    }
    return stats;
}

/// Relative bias of the whole image, in the colour where it is least likely to be chance.
struct Bias {
    double relative = 0.0;
    double standard_error = 0.0;
    double z = 0.0;
};
[[nodiscard]] inline Bias bias_of(const RunComparison& comparison)
{
    Bias worst;
    for (const ChannelComparison& c : comparison.channels) {
        const double reference = c.reference.mean;
        const Bias bias{c.whole_image.difference.mean / reference,
                        c.whole_image.difference.standard_error() / reference, c.whole_image.t};
        if (std::abs(bias.z) >= std::abs(worst.z)) worst = bias;
    }
    return worst;
}

/// Tests "nothing is added" on whole image and tiles: the p-value of the worst of both, corrected
/// for their number. Tiles where nothing varies must be 0.
struct AddedBias {
    Bias whole_image;
    double p = 1.0;
};
[[nodiscard]] inline AddedBias test_added(const TileStats& added, const TileStats& reference)
{
    AddedBias out;
    double p_whole = 1.0;
    double p_tile = 1.0;
    int64_t tiles = 0;
    for (const TileStats::ChannelStats& c : added.channels) {
        const double mean = reference.find(c.name)->whole_image.mean;
        const double rounding = rounding_share * mean;
        const MeanEstimate whole = estimate_mean(c.whole_image);
        const TestResult result = test_zero(whole, rounding);
        if (result.p <= p_whole) {
            out.whole_image = {whole.mean / mean, whole.standard_error() / mean, result.t};
        }
        p_whole = std::min(p_whole, result.p);
        for (const RunningStats& tile : c.tiles) {
            p_tile = std::min(p_tile, test_zero(estimate_mean(tile), rounding).p);
            ++tiles;
        }
    }
    const auto channels = static_cast<int64_t>(added.channels.size());
    out.p = std::min(1.0, 2.0 * std::min(sidak_p(p_whole, channels), sidak_p(p_tile, tiles)));
    return out;
}

}  // namespace mote::test
