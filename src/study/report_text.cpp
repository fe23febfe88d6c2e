#include "study/verify_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text.h"

namespace mote {

namespace {

constexpr double shown_confidence = 0.95;
constexpr int histogram_bins = 20;
constexpr size_t shown_tiles = 3;

std::string percent(double share)
{
    return fmt::format("{:+.3f} %", 100.0 * share);
}

const ChannelComparison& comparison_of(const Look& look, const std::string& channel)
{
    return *std::find_if(look.comparison.channels.begin(), look.comparison.channels.end(),
                         [&](const ChannelComparison& c) { return c.name == channel; });
}

std::string channel_line(const Look& look, const ChannelBias& bias)
{
    const ChannelComparison& channel = comparison_of(look, bias.name);
    const ConfidenceInterval interval =
        confidence_interval(channel.whole_image.difference, shown_confidence);
    const double scale = bias.scale > 0.0 ? bias.scale : 1.0;
    return fmt::format("{:<18} {:>10.5g} {:>10} [{:>9}, {:>9}] {:>8.2g} % {:>8.2g} {:>8.2g}\n",
                       "  " + bias.name, channel.reference.mean, percent(bias.bias),
                       percent(interval.lower / scale), percent(interval.upper / scale),
                       100.0 * bias.detectable, bias.p, channel.uniformity.p);
}

std::string estimator_line(const char* role, const EstimatorInfo& info, int runs)
{
    return fmt::format("{:<10} {}, {} sample{} per pixel and frame, {} frame{} a run; {} runs\n",
                       role, info.name, info.samples, info.samples == 1 ? "" : "s", info.frames,
                       info.frames == 1 ? "" : "s", runs);
}

std::string straight_line(const StraightLight& straight)
{
    if (straight.parts.empty()) return "";
    return fmt::format(
        "{} of {} passes without events a run, {} of the reference's: rays that just meet lamps "
        "made most of the noise, which the figures of error leave out\n",
        fmt::join(straight.parts, ", "), straight.tested_passes, straight.reference_passes);
}

std::string error_lines(const ErrorFigures& e)
{
    std::string text = fmt::format(
        "\nMSE     {:.3e} = bias^2 {:+.2e} (noise of it {:.1e} taken off) + variance {:.3e}\n",
        e.absolute.mse(), e.absolute.bias_squared, e.absolute.noise, e.absolute.variance);
    text += fmt::format(
        "relMSE  {:.3e} = bias^2 {:+.2e} + variance {:.3e}; epsilon {:.2e}\n"
        "        last {} runs: {:.3e}, trimmed {:.3e}; worst 0.1 % of the pixels: {:.1f} % of "
        "MSE\n",
        e.relative.mse(), e.relative.bias_squared, e.relative.variance, e.epsilon, e.single_runs,
        e.rel_mse, e.trimmed_rel_mse, 100.0 * e.worst_share);
    text += "error between pixels 1, 2, ... apart, correlation:";
    for (size_t i = 1; i < e.autocovariance.size(); ++i) {
        text += fmt::format(" {:+.3f}", e.autocovariance[i]);
    }
    return text + "\n";
}

std::string temporal_lines(const TemporalFigures& t)
{
    std::string text = fmt::format(
        "at rest, from frame to frame: correlation of the error {:+.3f}, boiling {:.2f} % of the "
        "mean\n",
        t.autocorrelation, 100.0 * t.boiling);
    for (const StepResponse& step : t.steps) {
        text += fmt::format(
            "after a step of {}: MSE at most twice the steady one {}, in turn:", step.name,
            step.lag < 0 ? fmt::format("after more than {} frames", t.frames)
                         : fmt::format("from frame {} on", step.lag));
        for (const double mse : step.mse) text += fmt::format(" {:.2g}", mse);
        text += "\n";
    }
    return text;
}

}  // namespace

std::vector<int64_t> p_histogram(const ChannelComparison& channel)
{
    std::vector<double> p_values;
    for (const TestResult& tile : channel.tiles) {
        if (tile.difference.variance > 0.0) p_values.push_back(tile.p);
    }
    return histogram(p_values, histogram_bins);
}

TileTests tile_tests(const Study& study)
{
    const Look& look = study.last();
    std::vector<double> p_values;
    std::vector<TileFinding> tiles;
    for (const ChannelComparison& channel : look.comparison.channels) {
        for (size_t i = 0; i < channel.tiles.size(); ++i) {
            const TestResult& tile = channel.tiles[i];
            p_values.push_back(tile.p);
            tiles.push_back({channel.name, static_cast<int>(i) % look.comparison.columns,
                             static_cast<int>(i) / look.comparison.columns,
                             study.tested.find(channel.name)->tiles[i].mean,
                             study.reference.find(channel.name)->tiles[i].mean, tile.t, tile.p});
        }
    }
    TileTests tests;
    tests.count = static_cast<int64_t>(p_values.size());
    for (const double p : holm_adjusted(p_values)) tests.rejected += p <= look.alpha ? 1 : 0;
    const size_t shown = std::min(tiles.size(), shown_tiles);
    std::partial_sort(tiles.begin(), tiles.begin() + static_cast<std::ptrdiff_t>(shown),
                      tiles.end(),
                      [](const TileFinding& a, const TileFinding& b) { return a.p < b.p; });
    tiles.resize(shown);
    if (shown > 0) tests.smallest_p = tiles.front().p;
    tests.worst = std::move(tiles);
    return tests;
}

std::string verify_text(const VerifyReport& report)
{
    const VerifyResult& r = report.result;
    const Look& look = r.study.last();
    const Question& question = r.params.question;
    std::string text = fmt::format("{}: {}: {}\n", printable(r.path, 1000),
                                   verdict_name(look.verdict), look.reason);
    for (const std::string& note : report.notes) text += note + "\n";
    text += fmt::format("{} x {} pixels, frame {} of a scene {}, after {} frames of warm-up{}\n",
                        r.width, r.height, r.frame,
                        r.mode == BenchMode::Moving ? "in motion" : "at rest", r.warm_up,
                        r.tested.frames > 1 ? "" : " (which change nothing: not played)");
    text += estimator_line("tested", r.tested, look.runs);
    text += estimator_line("reference", r.reference, look.runs);
    text += straight_line(r.straight);
    text += fmt::format(
        "{} by {} look{} in {:.0f} s, alpha {:.2g} in all, {:.2g} for the last; power {:.0f} %, "
        "budget {:.3g} %\n\n",
        question.equivalence ? "equivalence (the settings are known to be biased)" : "no bias",
        r.study.looks.size(), r.study.looks.size() == 1 ? "" : "s", r.study.seconds, question.alpha,
        look.alpha, 100.0 * question.power, 100.0 * question.budget);
    text += fmt::format("{:<18} {:>10} {:>10} {:>24} {:>10} {:>8} {:>8}\n", "whole image",
                        "reference", "bias", "95 % interval", "findable", "p", "uniform");
    for (const ChannelBias& channel : look.channels) text += channel_line(look, channel);
    const TileTests tests = tile_tests(r.study);
    text += fmt::format(
        "\n{} x {} tiles of {} x {} pixels: smallest p {:.2g} of {} tests, {:.2g} after Sidak; {} "
        "rejected by Holm;\na bias of {:.2g} % in a typical tile would have been found\n",
        look.comparison.columns, look.comparison.rows, r.params.tile_size, r.params.tile_size,
        tests.smallest_p, tests.count, look.comparison.p_tiles, tests.rejected,
        100.0 * look.tile_detectable);
    for (const TileFinding& tile : tests.worst) {
        text += fmt::format("  tile ({}, {}) of {}: {:.4g}, reference {:.4g}, t {:.1f}, p {:.2g}\n",
                            tile.column, tile.row, tile.channel, tile.tested, tile.reference,
                            tile.t, tile.p);
    }
    text += fmt::format(
        "\nsamples dropped as NaN or infinite 0, densities above their majorants 0, paths ended by "
        "the scene's limit of events {}\n",
        r.truncated_paths);
    if (r.errors.single_runs > 0) text += error_lines(r.errors);
    if (r.temporal) text += temporal_lines(*r.temporal);
    return text;
}

}  // namespace mote
