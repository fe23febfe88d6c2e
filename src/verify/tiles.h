#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/stats.h"
#include "image/layers.h"
#include "verify/p_values.h"
#include "verify/statistics.h"

namespace mote {

/// Statistics over independent runs of one image, of the tiles of every channel. A run's mean over
/// a tile is one observation. Tiles of 8 to 16 pixels make heavy-tailed pixels near-normal; tiles
/// of 1 pixel give the mean and variance images.
struct TileStats {
    struct ChannelStats {
        std::string name;
        RunningStats whole_image;
        std::vector<RunningStats> tiles;  ///< [columns x rows], row-major
        int64_t non_finite = 0;           ///< pixels of all runs that no mean includes
    };

    explicit TileStats(int tile_edge) : tile_size(tile_edge) {}

    int tile_size;  ///< [px]; tiles at the right and lower border may be smaller
    int width = 0;
    int height = 0;
    int columns = 0;
    int rows = 0;
    int64_t run_count = 0;
    std::vector<ChannelStats> channels;

    [[nodiscard]] const ChannelStats* find(const std::string& name) const;
};

/// Adds one independent run. The first one sets size and channels, which the others must share
/// (asserted). NaN and infinite pixels are left out of the means and counted.
void add_run(TileStats& stats, const LayeredImage& run);

/// Two sets of runs of one channel.
struct ChannelComparison {
    std::string name;
    MeanEstimate tested, reference;  ///< whole image
    TestResult whole_image;
    ConfidenceInterval mean_ratio;  ///< tested over reference, 95 %
    std::vector<TestResult> tiles;  ///< [columns x rows], row-major
    UniformityTest uniformity;      ///< of the p-values of the tiles that vary over the runs
    int64_t non_finite_tested = 0;
    int64_t non_finite_reference = 0;
};

/// Two sets of runs. `p` holds the error rate of the whole: without bias, p <= alpha has at most
/// chance alpha. The uniformity test is not part of it, since tiles may be correlated.
struct RunComparison {
    int columns = 0;
    int rows = 0;
    std::vector<ChannelComparison> channels;
    double p_tiles = 1.0;        ///< smallest p of all tiles and channels, after Sidak
    double p_whole_image = 1.0;  ///< smallest p of the whole image of all channels, after Sidak
    double p = 1.0;              ///< the smaller of both, after Bonferroni
    int64_t non_finite = 0;      ///< in both sets; anything but 0 is a failure of its own
};

/// Differences below this share of the larger mean are rounding of float images, not bias.
inline constexpr double rounding_share = 1e-6;

/// Welch's t-test of every tile and of the whole image, per channel. Both sets have the same size,
/// tile size and channels (asserted).
[[nodiscard]] RunComparison compare_runs(const TileStats& tested, const TileStats& reference);

/// Squared error of one run, averaged over tiles, in its two parts. With tiles of one pixel these
/// are the image's MSE.
struct ErrorSplit {
    double bias_squared = 0.0;  ///< unbiased estimate: negative if the bias is below the noise
    double noise = 0.0;         ///< what was subtracted for it: s^2/K of both sets
    double variance = 0.0;      ///< over runs of the tested estimator
    [[nodiscard]] double mse() const { return bias_squared + variance; }
};

/// Splits the error of `tested` [>= 2 runs, asserted] against the mean of `reference`, of which a
/// single run counts as exact. Throws Error(Input) if a set lacks the channel.
[[nodiscard]] ErrorSplit split_error(const TileStats& tested, const TileStats& reference,
                                     const std::string& channel);

/// The same with each tile's error divided by reference^2 + epsilon: parts of relMSE.
[[nodiscard]] ErrorSplit split_relative_error(const TileStats& tested, const TileStats& reference,
                                              const std::string& channel, double epsilon);

}  // namespace mote
