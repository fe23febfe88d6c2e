#pragma once

#include <span>
#include <string>
#include <vector>

namespace mote {

/// A plot as an <svg> element, to stand in a page. Values that are not finite are left out.
struct Plot {
    std::string title;
    std::vector<std::string> x_labels;  ///< first and last
    double y_min = 0.0;
    double y_max = 1.0;
};

/// One bar per value, from 0, and a dashed line at `level`.
[[nodiscard]] std::string bar_plot(const Plot& plot, std::span<const double> values, double level);

/// One polyline per row over equally spaced x, a dashed line at `level`; rows have names.
[[nodiscard]] std::string line_plot(const Plot& plot, const std::vector<std::string>& names,
                                    const std::vector<std::vector<double>>& rows, double level);

/// Text with the characters that have a meaning in HTML replaced.
[[nodiscard]] std::string html_text(const std::string& text);

}  // namespace mote
