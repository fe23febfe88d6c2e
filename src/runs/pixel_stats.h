#pragma once

#include <cstdint>

#include "core/buffer2d.h"
#include "core/math.h"
#include "core/stats.h"

namespace mote {

/// Mean and spread of every pixel over independent runs. 24 bytes a pixel, where TileStats with
/// tiles of one pixel needs 96: a benchmark holds one of these per method.
struct PixelStats {
    Buffer2D<Spectrum> mean;
    Buffer2D<Spectrum> m2;     ///< sum of squared deviations (Welford 1962)
    RunningStats image_means;  ///< a run's mean over pixels and channels is one observation
    int run_count = 0;
};

/// Adds one independent run. The first one sets the size, which the others share (asserted).
void add_run(PixelStats& stats, const Buffer2D<Spectrum>& image);

/// Variance of a pixel's mean over the runs so far, per channel; 0 for fewer than two runs.
[[nodiscard]] Spectrum variance_of_mean(const PixelStats& stats, size_t pixel);

/// Variance of one run, averaged over pixels and channels; 0 for fewer than two runs.
[[nodiscard]] double mean_variance(const PixelStats& stats);

/// The same without the `share` of the pixels that vary most, rounded up to whole ones.
[[nodiscard]] double trimmed_mean_variance(const PixelStats& stats, double share);

/// Mean over pixels and channels.
[[nodiscard]] double image_mean(const Buffer2D<Spectrum>& image);

/// Sets pixels that are not finite to black, as the renderer does with such samples; their number.
int64_t replace_non_finite(Buffer2D<Spectrum>& image);

}  // namespace mote
