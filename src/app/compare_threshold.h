#pragma once

#include <span>
#include <string>
#include <vector>

#include "verify/compare_images.h"

namespace mote {

/// A figure that `mote compare --threshold` can limit.
struct ThresholdMetric {
    const char* name;
    const char* meaning;
    double (*value)(const ChannelMetrics& channel);
    bool is_lower_limit;  ///< the figure must be at least the limit, instead of at most
};

/// One limit, which every compared channel has to keep.
struct Threshold {
    const ThresholdMetric* metric;
    double limit;
};

[[nodiscard]] std::span<const ThresholdMetric> threshold_metrics();

/// "relmse=0.01". Throws Error(Usage) with the names known.
[[nodiscard]] Threshold parse_threshold(const std::string& text);

/// What is over a threshold, one sentence per channel and threshold, empty if nothing is. With any
/// threshold, pixels that are not finite in one image only are over it too, and so is a figure
/// that is NaN. Throws Error(Input) if a figure needs a variance layer that the reference lacks.
[[nodiscard]] std::vector<std::string> find_violations(std::span<const Threshold> thresholds,
                                                       std::span<const LayerMetrics> layers);

}  // namespace mote
