#include "verify/tiles.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/core.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

constexpr double ratio_confidence = 0.95;

/// Sum over the finite pixels seen.
struct FiniteSum {
    double sum = 0.0;
    int64_t count = 0;

    void add(float value)
    {
        if (!std::isfinite(value)) return;
        sum += static_cast<double>(value);
        ++count;
    }
    void add_mean_to(RunningStats& stats) const
    {
        if (count > 0) stats.add(sum / static_cast<double>(count));
    }
};

void set_layout(TileStats& stats, const LayeredImage& run)
{
    MOTE_ASSERT(stats.tile_size >= 1);
    stats.width = run.width;
    stats.height = run.height;
    stats.columns = (run.width + stats.tile_size - 1) / stats.tile_size;
    stats.rows = (run.height + stats.tile_size - 1) / stats.tile_size;
    const auto tile_count = static_cast<size_t>(stats.columns) * static_cast<size_t>(stats.rows);
    for (const Channel& channel : run.channels) {
        stats.channels.push_back({channel.name, {}, std::vector<RunningStats>(tile_count), 0});
    }
}

void add_channel(const TileStats& layout, const Channel& run, TileStats::ChannelStats& stats)
{
    std::vector<FiniteSum> tiles(stats.tiles.size());
    FiniteSum whole_image;
    for (int y = 0; y < layout.height; ++y) {
        for (int x = 0; x < layout.width; ++x) {
            const int tile = y / layout.tile_size * layout.columns + x / layout.tile_size;
            tiles[static_cast<size_t>(tile)].add(run.data.at(x, y));
            whole_image.add(run.data.at(x, y));
        }
    }
    for (size_t i = 0; i < tiles.size(); ++i) tiles[i].add_mean_to(stats.tiles[i]);
    whole_image.add_mean_to(stats.whole_image);
    stats.non_finite += static_cast<int64_t>(run.data.size()) - whole_image.count;
}

TestResult test_runs(const RunningStats& tested, const RunningStats& reference)
{
    const double scale = std::max(std::abs(tested.mean), std::abs(reference.mean));
    return welch_test(estimate_mean(tested), estimate_mean(reference), rounding_share * scale);
}

ChannelComparison compare_channel(const TileStats::ChannelStats& tested,
                                  const TileStats::ChannelStats& reference)
{
    ChannelComparison result;
    result.name = tested.name;
    result.tested = estimate_mean(tested.whole_image);
    result.reference = estimate_mean(reference.whole_image);
    result.whole_image = test_runs(tested.whole_image, reference.whole_image);
    result.mean_ratio = ratio_interval(result.tested, result.reference, ratio_confidence);
    result.non_finite_tested = tested.non_finite;
    result.non_finite_reference = reference.non_finite;
    std::vector<double> varying;
    for (size_t i = 0; i < tested.tiles.size(); ++i) {
        result.tiles.push_back(test_runs(tested.tiles[i], reference.tiles[i]));
        const TestResult& tile = result.tiles.back();
        // Rounding alone, or nothing at all, decides the p-value of the other tiles.
        const double scale = std::abs(reference.tiles[i].mean);
        const double error = tile.difference.standard_error();
        if (std::isfinite(error) && error > rounding_share * scale) varying.push_back(tile.p);
    }
    result.uniformity = test_uniformity(varying);
    return result;
}

const TileStats::ChannelStats& channel_of(const TileStats& stats, const std::string& name)
{
    const TileStats::ChannelStats* channel = stats.find(name);
    if (channel == nullptr) {
        throw Error(ExitCode::Input,
                    fmt::format("the runs have no channel \"{}\"", printable(name)));
    }
    return *channel;
}

ErrorSplit split(const TileStats& tested, const TileStats& reference, const std::string& channel,
                 const std::function<double(double)>& weight_of_reference)
{
    const auto& tested_tiles = channel_of(tested, channel).tiles;
    const auto& reference_tiles = channel_of(reference, channel).tiles;
    MOTE_ASSERT(tested.run_count >= 2 && reference.run_count >= 1);
    MOTE_ASSERT(tested_tiles.size() == reference_tiles.size());
    ErrorSplit result;
    for (size_t i = 0; i < tested_tiles.size(); ++i) {
        const double difference = tested_tiles[i].mean - reference_tiles[i].mean;
        const double weight =
            weight_of_reference(reference_tiles[i].mean) / static_cast<double>(tested_tiles.size());
        const double noise =
            tested_tiles[i].variance_of_mean() + reference_tiles[i].variance_of_mean();
        result.bias_squared += weight * (difference * difference - noise);
        result.noise += weight * noise;
        result.variance += weight * tested_tiles[i].variance();
    }
    return result;
}

}  // namespace

const TileStats::ChannelStats* TileStats::find(const std::string& name) const
{
    const auto it = std::find_if(channels.begin(), channels.end(),
                                 [&](const ChannelStats& c) { return c.name == name; });
    return it == channels.end() ? nullptr : &*it;
}

void add_run(TileStats& stats, const LayeredImage& run)
{
    if (stats.run_count == 0) set_layout(stats, run);
    MOTE_ASSERT(stats.width == run.width && stats.height == run.height);
    MOTE_ASSERT(stats.channels.size() == run.channels.size());
    for (size_t i = 0; i < stats.channels.size(); ++i) {
        MOTE_ASSERT(stats.channels[i].name == run.channels[i].name);
        add_channel(stats, run.channels[i], stats.channels[i]);
    }
    ++stats.run_count;
}

RunComparison compare_runs(const TileStats& tested, const TileStats& reference)
{
    MOTE_ASSERT(tested.width == reference.width && tested.height == reference.height);
    MOTE_ASSERT(tested.tile_size == reference.tile_size);
    MOTE_ASSERT(tested.channels.size() == reference.channels.size());
    RunComparison result;
    result.columns = tested.columns;
    result.rows = tested.rows;
    double smallest_tile = 1.0;
    double smallest_image = 1.0;
    for (const TileStats::ChannelStats& channel : tested.channels) {
        ChannelComparison comparison =
            compare_channel(channel, channel_of(reference, channel.name));
        smallest_image = std::min(smallest_image, comparison.whole_image.p);
        for (const TestResult& tile : comparison.tiles) {
            smallest_tile = std::min(smallest_tile, tile.p);
        }
        result.non_finite += comparison.non_finite_tested + comparison.non_finite_reference;
        result.channels.push_back(std::move(comparison));
    }
    const auto channel_count = static_cast<int64_t>(result.channels.size());
    if (channel_count == 0) return result;
    const int64_t tile_count = int64_t{result.columns} * result.rows;
    result.p_tiles = sidak_p(smallest_tile, channel_count * tile_count);
    result.p_whole_image = sidak_p(smallest_image, channel_count);
    result.p = std::min(2.0 * std::min(result.p_tiles, result.p_whole_image), 1.0);
    return result;
}

ErrorSplit split_error(const TileStats& tested, const TileStats& reference,
                       const std::string& channel)
{
    return split(tested, reference, channel, [](double) { return 1.0; });
}

ErrorSplit split_relative_error(const TileStats& tested, const TileStats& reference,
                                const std::string& channel, double epsilon)
{
    MOTE_ASSERT(epsilon > 0.0);
    return split(tested, reference, channel,
                 [epsilon](double mean) { return 1.0 / (mean * mean + epsilon); });
}

}  // namespace mote
