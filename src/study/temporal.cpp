#include "study/temporal.h"

#include <chrono>
#include <cmath>

#include "core/error.h"
#include "image/color_of.h"
#include "runs/play_frames.h"
#include "runs/run_error.h"
#include "scene/prepare_lights.h"

namespace mote {

namespace {

constexpr int measured_frames = 8;
constexpr int most_runs = 4;
constexpr int fewest_runs_played = 2;
constexpr float before_step = 0.25f;  ///< of lights or densities
constexpr double settled = 2.0;       ///< times the steady error

using Images = std::vector<Buffer2D<Spectrum>>;

/// Frames at rest, some of them of another scene: `before` until the step, then `after`.
struct Sequence {
    std::string name;
    FramePlan plan;
    PlanCaches caches;
    std::vector<RunningStats> mse;  ///< of each measured frame
};

Scene prepare_at(const SceneDescription& description, int frame, SceneCache& cache)
{
    PrepareStats ignored;
    return prepare_frame(description, frame, {}, cache, ignored);
}

Sequence make_sequence(std::string name, const Scene& before, const Scene& after,
                       const TemporalInputs& inputs)
{
    Sequence sequence;
    sequence.name = std::move(name);
    for (int i = 0; i < inputs.warm_up + measured_frames; ++i) {
        sequence.plan.frames.push_back(i < inputs.warm_up ? before : after);
        sequence.plan.frames.back().frame = inputs.frame + i;
    }
    sequence.mse.resize(measured_frames);
    return sequence;
}

/// The scene at rest, then those with a step.
std::vector<Sequence> make_sequences(const TemporalInputs& inputs)
{
    SceneCache cache;
    const Scene still = prepare_at(inputs.scene, inputs.frame, cache);
    std::vector<Sequence> sequences;
    sequences.push_back(make_sequence("rest", still, still, inputs));
    if (!inputs.scene.lights.empty()) {
        SceneDescription dim = inputs.scene;
        for (LightDescription& light : dim.lights) scale_brightness(light, before_step);
        sequences.push_back(
            make_sequence("light", prepare_at(dim, inputs.frame, cache), still, inputs));
    }
    SceneDescription thin = inputs.scene;
    for (VolumeDescription& volume : thin.volumes) volume.density_scale *= before_step;
    sequences.push_back(
        make_sequence("density", prepare_at(thin, inputs.frame, cache), still, inputs));
    return sequences;
}

/// The measured frames of one run.
Images play(Sequence& sequence, const TemporalInputs& inputs, uint32_t seed)
{
    RenderDescription render = inputs.render;
    render.seed = seed;
    Images images;
    play_frames(sequence.plan, true, render, float_output(), inputs.stop, &sequence.caches,
                [&](size_t index, const LayeredImage& image, const FrameStats&) {
                    if (static_cast<int>(index) < inputs.warm_up) return;
                    images.push_back(color_of(image));
                    replace_non_finite(images.back());
                });
    return images;
}

/// Sums over pixels, channels and pairs of frames that follow each other.
struct PairSums {
    double product = 0.0;  ///< of the errors
    double square = 0.0;   ///< of the errors, mean of both frames
    double change = 0.0;   ///< squared
    double count = 0.0;
};

void add_pairs(const Images& images, const PixelStats& reference, PairSums& sums)
{
    for (size_t t = 0; t + 1 < images.size(); ++t) {
        for (size_t i = 0; i < images[t].size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                const double truth = double{reference.mean.data()[i][c]};
                const double a = double{images[t].data()[i][c]} - truth;
                const double b = double{images[t + 1].data()[i][c]} - truth;
                sums.product += a * b;
                sums.square += 0.5 * (a * a + b * b);
                sums.change += (b - a) * (b - a);
                sums.count += 1.0;
            }
        }
    }
}

StepResponse response_of(const Sequence& sequence, double steady)
{
    StepResponse response;
    response.name = sequence.name;
    for (const RunningStats& mse : sequence.mse) {
        response.mse.push_back(steady > 0.0 ? mse.mean / steady : 0.0);
        if (response.lag < 0 && mse.mean <= settled * steady) {
            response.lag = static_cast<int>(response.mse.size()) - 1;
        }
    }
    return response;
}

}  // namespace

TemporalFigures measure_temporal(const TemporalInputs& inputs, const PixelStats& reference)
{
    MOTE_ASSERT(inputs.warm_up >= 1);
    const auto start = std::chrono::steady_clock::now();
    std::vector<Sequence> sequences = make_sequences(inputs);
    PairSums sums;
    TemporalFigures figures;
    figures.frames = measured_frames;
    for (; figures.runs < most_runs; ++figures.runs) {
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        if (figures.runs >= fewest_runs_played && elapsed.count() > inputs.seconds) break;
        for (Sequence& sequence : sequences) {
            const Images images =
                play(sequence, inputs, inputs.seed + static_cast<uint32_t>(figures.runs));
            for (size_t i = 0; i < images.size(); ++i) {
                sequence.mse[i].add(measure_error(images[i], reference).trimmed_mse);
            }
            if (&sequence == &sequences.front()) add_pairs(images, reference, sums);
        }
    }
    figures.autocorrelation = sums.square > 0.0 ? sums.product / sums.square : 0.0;
    figures.boiling = std::sqrt(0.5 * sums.change / sums.count) / reference.image_means.mean;
    RunningStats steady;
    for (const RunningStats& mse : sequences.front().mse) steady.add(mse.mean);
    figures.steady_mse = steady.mean;
    for (size_t i = 1; i < sequences.size(); ++i) {
        figures.steps.push_back(response_of(sequences[i], figures.steady_mse));
    }
    return figures;
}

}  // namespace mote
