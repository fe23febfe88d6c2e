#include "study/tile_judge.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runs/trimmed_mean.h"
#include "verify/compare_images.h"

namespace mote {

namespace {

constexpr double suspicious_share = 0.25;

/// The chance to see none of so many is 5e-5; with fewer seen, t stays small.
constexpr double missed_hits = 10.0;

/// Variance of the tested runs over that of the reference's, of the median tile; 0 if none varies.
double usual_ratio(const std::vector<RunningStats>& tested,
                   const std::vector<RunningStats>& reference)
{
    std::vector<double> ratios;
    for (size_t i = 0; i < tested.size(); ++i) {
        if (!(tested[i].m2 > 0.0) || !(reference[i].m2 > 0.0)) continue;
        ratios.push_back(tested[i].variance() / reference[i].variance());
    }
    return ratios.empty() ? 0.0 : median(std::move(ratios));
}

/// What one sample that hits changes in a tile's mean over a run: of few and rare hits the variance
/// is mean times size. That of a tile with larger hits than most.
double hit_size(const std::vector<RunningStats>& tiles)
{
    std::vector<double> sizes;
    for (const RunningStats& tile : tiles) {
        if (tile.m2 > 0.0 && tile.mean != 0.0) {
            sizes.push_back(tile.variance() / std::abs(tile.mean));
        }
    }
    if (sizes.empty()) return 0.0;
    const auto large = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 9 / 10);
    std::nth_element(sizes.begin(), large, sizes.end());
    return *large;
}

TestResult test_tile(RunningStats tested, const RunningStats& reference, double ratio,
                     double tolerance)
{
    const double usual_m2 =
        ratio * reference.variance() * static_cast<double>(std::max<int64_t>(tested.count - 1, 0));
    if (tested.m2 < suspicious_share * usual_m2) tested.m2 = usual_m2;
    const double rounding =
        rounding_share * std::max(std::abs(tested.mean), std::abs(reference.mean));
    return welch_test(estimate_mean(tested), estimate_mean(reference),
                      std::max(tolerance, rounding));
}

}  // namespace

void judge_tiles(const TileStats& tested, const TileStats& reference, double tolerance,
                 RunComparison& comparison)
{
    double smallest = 1.0;
    int64_t tests = 0;
    for (ChannelComparison& channel : comparison.channels) {
        const auto& tested_tiles = tested.find(channel.name)->tiles;
        const auto& reference_tiles = reference.find(channel.name)->tiles;
        const double ratio = usual_ratio(tested_tiles, reference_tiles);
        const double scale = channel_scale(reference, channel.name);
        const double missed = missed_hits *
                              std::max(hit_size(tested_tiles), hit_size(reference_tiles)) /
                              static_cast<double>(std::max<int64_t>(reference.run_count, 1));
        for (size_t i = 0; i < channel.tiles.size(); ++i) {
            channel.tiles[i] = test_tile(tested_tiles[i], reference_tiles[i], ratio,
                                         std::max(tolerance * scale, missed));
            smallest = std::min(smallest, channel.tiles[i].p);
            ++tests;
        }
    }
    comparison.p_tiles = tests > 0 ? sidak_p(smallest, tests) : 1.0;
    comparison.p = std::min(2.0 * std::min(comparison.p_tiles, comparison.p_whole_image), 1.0);
}

double channel_scale(const TileStats& reference, const std::string& channel)
{
    const auto mean_of = [&](const std::string& name) {
        const TileStats::ChannelStats* stats = reference.find(name);
        return stats == nullptr ? 0.0 : std::abs(stats->whole_image.mean);
    };
    const std::string layer = layer_of(channel);
    if (layer == "alpha" || layer == "transmittance") return mean_of(channel);
    return (mean_of("R") + mean_of("G") + mean_of("B")) / 3.0;
}

}  // namespace mote
