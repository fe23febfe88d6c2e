#pragma once

#include <span>
#include <string>

#include "verify/compare_images.h"

namespace mote {

/// What `mote compare` found, for its two outputs.
struct CompareReport {
    const NamedImage& tested;
    const NamedImage& reference;
    std::span<const LayerMetrics> layers;
    std::span<const std::string> thresholds;  ///< as given
    std::span<const std::string> violations;
};

/// The table for people.
[[nodiscard]] std::string compare_table(const CompareReport& report);

/// The same figures as a JSON object. Infinite and undefined figures are null.
[[nodiscard]] std::string compare_json(const CompareReport& report);

}  // namespace mote
