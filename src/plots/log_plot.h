#pragma once

#include <span>
#include <string>
#include <vector>

namespace mote {

/// Points joined by a line; those not finite and above 0 are left out.
struct LogSeries {
    std::string name;
    std::vector<double> x, y;
    bool dashed = false;
};

struct LogPlot {
    std::string title;
    std::string x_label, y_label;
    double y_level = 0.0;  ///< a dashed line across; 0: none
};

/// A plot with logarithmic axes as an <svg> element, decades ruled, names to the right.
[[nodiscard]] std::string log_plot(const LogPlot& plot, std::span<const LogSeries> series);

/// Horizontal bars from 0, one per name, their values beside them, and a dashed line at `level`.
[[nodiscard]] std::string named_bars(const std::string& title, std::span<const std::string> names,
                                     std::span<const double> values, double level);

}  // namespace mote
