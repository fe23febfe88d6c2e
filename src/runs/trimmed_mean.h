#pragma once

#include <span>
#include <vector>

namespace mote {

/// For each pixel, whether it is among the `share` of the pixels with the largest values. The
/// number is rounded up to whole pixels; share 0 marks none.
[[nodiscard]] std::vector<bool> worst_pixels(std::span<const double> values, double share);

/// Mean of the values that are not left out; 0 if that leaves none.
[[nodiscard]] double trimmed_mean(std::span<const double> values,
                                  const std::vector<bool>& left_out);

/// Middle value, or mean of the two middle ones; NaN for none. NaN among the values gives NaN.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace mote
