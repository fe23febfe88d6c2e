#include "study/look.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math.h"
#include "study/tile_judge.h"

namespace mote {

namespace {

constexpr double look_growth = 1.5;
/// Of the tile budget: differences that no single tile is accused of.
constexpr double negligible_share = 0.01;
constexpr const char* color_names[] = {"R", "G", "B"};

/// Significance of each of `count` tests so that together they have this one (Sidak 1967).
double sidak_significance(double significance, int64_t count)
{
    return -std::expm1(std::log1p(-significance) / static_cast<double>(count));
}

/// Whether there is anything to compare: neither set ever differed from 0.
bool is_void(const ChannelComparison& channel)
{
    return channel.tested.mean == 0.0 && channel.reference.mean == 0.0 &&
           channel.whole_image.difference.variance == 0.0;
}

ChannelBias bias_of(const ChannelComparison& channel, double scale, const Question& question,
                    double significance)
{
    const MeanEstimate& difference = channel.whole_image.difference;
    ChannelBias bias;
    bias.name = channel.name;
    bias.scale = scale;
    bias.p = channel.whole_image.p;
    if (!(scale > 0.0)) return bias;
    bias.bias = difference.mean / scale;
    bias.standard_error = difference.standard_error() / scale;
    bias.detectable = smallest_detectable_bias(difference, significance, question.power) / scale;
    bias.equivalence_p = equivalence_p(difference, question.budget * scale);
    bias.excess_p = test_zero(difference, question.budget * scale).p;
    return bias;
}

/// Smallest detectable bias of the tile whose error is the median, among those that vary.
double typical_tile_detectable(const ChannelComparison& channel, double significance, double power)
{
    std::vector<MeanEstimate> tiles;
    for (const TestResult& tile : channel.tiles) {
        if (tile.difference.variance > 0.0) tiles.push_back(tile.difference);
    }
    if (tiles.empty()) return 0.0;
    const auto middle = tiles.begin() + static_cast<std::ptrdiff_t>(tiles.size() / 2);
    std::nth_element(
        tiles.begin(), middle, tiles.end(),
        [](const MeanEstimate& a, const MeanEstimate& b) { return a.variance < b.variance; });
    return smallest_detectable_bias(*middle, significance, power);
}

void decide_unbiased(const Question& question, Look& look)
{
    if (look.comparison.p <= look.alpha) {
        look.verdict = Verdict::BiasFound;
        const bool tiles = look.comparison.p_tiles < look.comparison.p_whole_image;
        look.reason = fmt::format("{} differ from the reference's: p = {:.2g}, at most {:.2g}",
                                  tiles ? "tiles" : "means of the whole image", look.comparison.p,
                                  look.alpha);
    } else if (look.detectable <= question.budget && look.tile_detectable <= question.tile_budget) {
        look.verdict = Verdict::NoBias;
        look.reason =
            fmt::format("a bias of {:.2g} % would have been found", 100.0 * look.detectable);
    } else {
        look.reason =
            fmt::format("no bias found, but only one of {:.2g} % (tiles: {:.2g} %) would have been",
                        100.0 * look.detectable, 100.0 * look.tile_detectable);
    }
}

void decide_equivalence(const Question& question, Look& look)
{
    double worst = 0.0;
    double excess = 1.0;
    for (const ChannelBias& channel : look.channels) {
        worst = std::max(worst, channel.equivalence_p);
        excess = std::min(excess, channel.excess_p);
    }
    const double budget = 100.0 * question.budget;
    if (sidak_p(excess, static_cast<int64_t>(look.channels.size())) <= look.alpha) {
        look.verdict = Verdict::BiasFound;
        look.reason = fmt::format("the bias is over {:.3g} %", budget);
    } else if (worst <= look.alpha) {
        look.verdict = Verdict::NoBias;
        look.reason = fmt::format("the bias is under {:.3g} %", budget);
    } else {
        look.reason = fmt::format("the bias may be over or under {:.3g} %", budget);
    }
}

}  // namespace

const char* verdict_name(Verdict verdict)
{
    switch (verdict) {
        case Verdict::NoBias:
            return "no bias found";
        case Verdict::BiasFound:
            return "bias found";
        case Verdict::NotEnoughRuns:
            return "not enough runs";
    }
    return "";
}

double alpha_of_look(double alpha, int k)
{
    MOTE_ASSERT(k >= 1);
    return alpha / (double(k) * double(k + 1));
}

int runs_of_look(int first_look, int k)
{
    return static_cast<int>(std::lround(first_look * std::pow(look_growth, k - 1)));
}

Look judge(const TileStats& tested, const TileStats& reference, const Question& question,
           int look_index)
{
    MOTE_ASSERT(tested.run_count == reference.run_count);
    Look look;
    look.index = look_index;
    look.runs = tested.run_count > 0 ? static_cast<int>(tested.run_count) : 0;
    look.alpha = alpha_of_look(question.alpha, look_index);
    look.comparison = compare_runs(tested, reference);
    judge_tiles(tested, reference, negligible_share * question.tile_budget, look.comparison);
    // Half of a look's alpha is for tiles, half for the whole image, as in RunComparison.
    const auto channel_count = static_cast<int64_t>(look.comparison.channels.size());
    const int64_t tile_count = int64_t{look.comparison.columns} * look.comparison.rows;
    const double significance = sidak_significance(0.5 * look.alpha, channel_count);
    const double tile_significance =
        sidak_significance(0.5 * look.alpha, channel_count * tile_count);
    for (const ChannelComparison& channel : look.comparison.channels) {
        if (is_void(channel)) continue;
        const double scale = channel_scale(reference, channel.name);
        look.channels.push_back(bias_of(channel, scale, question, significance));
        look.detectable = std::max(look.detectable, look.channels.back().detectable);
        const bool is_color = std::find(std::begin(color_names), std::end(color_names),
                                        channel.name) != std::end(color_names);
        if (!is_color || !(scale > 0.0)) continue;
        look.tile_detectable =
            std::max(look.tile_detectable,
                     typical_tile_detectable(channel, tile_significance, question.power) / scale);
    }
    if (look.comparison.non_finite > 0) {
        look.verdict = Verdict::BiasFound;
        look.reason = fmt::format("{} pixels are NaN or infinite", look.comparison.non_finite);
    } else if (look.runs < fewest_runs) {
        look.reason = fmt::format("{} runs are too few to judge", look.runs);
    } else if (look.channels.empty()) {
        look.reason = "the picture is black";
    } else if (question.equivalence) {
        decide_equivalence(question, look);
    } else {
        decide_unbiased(question, look);
    }
    return look;
}

}  // namespace mote
