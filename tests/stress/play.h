#pragma once

#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/restir_frame.h"
#include "restir/runs.h"
#include "scene/aov_names.h"
#include "stress/ways.h"

namespace mote::test {

/// Every layer there is, in floats.
[[nodiscard]] inline OutputDescription every_layer()
{
    OutputDescription output;
    output.aovs.assign(aov_names.begin(), aov_names.end());
    output.color_type = PixelType::Float;
    return output;
}

/// What every image must keep to: all values finite; light, variances and depths not negative; what
/// is a share in [0, 1].
inline void expect_sound(const LayeredImage& image, bool is_signed, const std::string& what)
{
    ASSERT_FALSE(image.channels.empty()) << what;
    for (const Channel& channel : image.channels) {
        const std::string& name = channel.name;
        const auto starts = [&](const char* prefix) { return name.rfind(prefix, 0) == 0; };
        const bool is_share = name == "A" || starts("albedo") || starts("transmittance");
        const bool is_estimate = name == "R" || name == "G" || name == "B" ||
                                 starts("volume_direct") || starts("volume_indirect");
        const bool is_positive = is_share || (is_estimate && !is_signed) || starts("background") ||
                                 starts("volume_emission") || starts("variance") ||
                                 starts("opticalDepth") || starts("volume_Z") || name == "Z";
        int not_finite = 0;
        int negative = 0;
        int over_one = 0;
        for (const float v : channel.data) {
            not_finite += std::isfinite(v) ? 0 : 1;
            negative += is_positive && v < 0.0f ? 1 : 0;
            over_one += is_share && v > 1.0f + 1e-6f ? 1 : 0;
        }
        EXPECT_EQ(not_finite, 0) << name << ", " << what;
        EXPECT_EQ(negative, 0) << name << ", " << what;
        EXPECT_EQ(over_one, 0) << name << ", " << what;
    }
}

/// What a pass keeps for the next: no weight or target is negative or not finite.
inline void expect_sound(const FinishedPass& pass, const std::string& what)
{
    int bad = 0;
    for (const Reservoir& r : pass.reservoirs) {
        const bool sound = std::isfinite(r.W) && r.W >= 0.0f && std::isfinite(r.p_hat) &&
                           r.p_hat >= 0.0f && r.y.u >= 0.0f && r.y.u < 1.0f && r.M >= 0.0f &&
                           std::isfinite(r.M) && r.age >= 0.0f;
        bad += sound ? 0 : 1;
    }
    EXPECT_EQ(bad, 0) << what;
}

/// Renders the frames in turn with one history. Each must be sound, and no sample dropped.
inline std::vector<LayeredImage> play(std::span<const Scene> frames, Way way,
                                      const std::string& what, uint32_t seed = 1,
                                      const OutputDescription& output = every_layer())
{
    std::vector<LayeredImage> images;
    FrameHistory history;
    way.render.seed = seed;
    for (size_t i = 0; i < frames.size(); ++i) {
        way.render.width = frames[i].camera.width;
        way.render.height = frames[i].camera.height;
        FrameStats stats;
        images.push_back(render_frame(frames[i], way.render, output, history, nullptr, stats));
        const std::string place = way.name + ", " + what + ", frame " + std::to_string(i);
        EXPECT_EQ(stats.dropped_non_finite, 0) << place;
        expect_sound(images.back(), way.is_signed, place);
        expect_sound(history.impl().before, place);
    }
    return images;
}

/// A scene at rest, as a run of `count` frames.
[[nodiscard]] inline std::vector<Scene> repeated(const Scene& scene, int count)
{
    std::vector<Scene> frames(static_cast<size_t>(count), scene);
    for (int i = 0; i < count; ++i) frames[static_cast<size_t>(i)].frame = i + 1;
    return frames;
}

/// Renders one scene in every way, three frames where there is a history.
inline void expect_sound_in_every_way(const Scene& scene, const std::string& what,
                                      int max_bounces = 1)
{
    for (const Way& way : all_ways(max_bounces, 1)) {
        play(repeated(scene, uses_history(way.render) ? 3 : 1), way, what);
    }
}

/// The last frames of `runs` independent runs; light by its parts.
[[nodiscard]] inline TileStats last_frames(std::span<const Scene> frames, const Way& way, int runs,
                                           uint32_t first_seed, const std::string& what)
{
    OutputDescription output;
    output.aovs = part_names;
    output.color_type = PixelType::Float;
    return collect(runs, first_seed,
                   [&](uint32_t seed) { return play(frames, way, what, seed, output).back(); });
}

/// How much to render for a comparison. Few samples of the tested way: these tests look for the
/// gross faults that extremes bring; small biases are the business of tests/restir.
struct StressEffort {
    int runs = 16;
    int frames = 2;  ///< of ways with history
    int samples = 12;
    int reference_samples = 300;
};

/// No difference, at a false-alarm rate of `alarm`. MOTE_REPORT prints what was seen.
inline void expect_same(const RunComparison& comparison, const std::string& what)
{
    const std::string found = summary(what, comparison);
    EXPECT_GT(comparison.p, alarm) << found;
    EXPECT_EQ(comparison.non_finite, 0) << found;
    if (std::getenv("MOTE_REPORT")) std::printf("%s\n", found.c_str());
}

/// Welch's tests of tiles and whole image, in every ReSTIR way, against the path tracer's picture
/// of `truth`, which must look the same; false-alarm rate of one way 1e-5 (see `alarm`).
inline void expect_looks_like(const Scene& scene, const Scene& truth, const std::string& what,
                              const StressEffort& effort = {})
{
    const TileStats reference = last_frames(
        repeated(truth, 1), path_way(1, effort.reference_samples), effort.runs, 100'000, what);
    for (const Way& way : restir_ways(1, effort.samples)) {
        const int frames = uses_history(way.render) ? effort.frames : 1;
        const RunComparison comparison = compare_runs(
            last_frames(repeated(scene, frames), way, effort.runs, 1, what), reference);
        expect_same(comparison, way.name + ", " + what);
    }
}

/// The same of the scene itself.
inline void expect_agreement(const Scene& scene, const std::string& what,
                             const StressEffort& effort = {})
{
    expect_looks_like(scene, scene, what, effort);
}

/// Mean of a channel.
[[nodiscard]] inline double mean_of(const LayeredImage& image, const std::string& channel)
{
    double sum = 0.0;
    for (const float v : image.find(channel)->data) sum += static_cast<double>(v);
    return sum / static_cast<double>(image.find(channel)->data.size());
}

}  // namespace mote::test
