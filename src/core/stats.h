#pragma once

#include <cmath>
#include <cstdint>

namespace mote {

/// Running mean and variance (Welford 1962), in double.
struct RunningStats {
    double mean = 0.0;
    double m2 = 0.0;
    int64_t count = 0;

    void add(double x)
    {
        ++count;
        const double delta = x - mean;
        mean += delta / static_cast<double>(count);
        m2 += delta * (x - mean);
    }
    /// Sample variance; 0 for fewer than two values.
    [[nodiscard]] double variance() const
    {
        return count > 1 ? m2 / static_cast<double>(count - 1) : 0.0;
    }
    [[nodiscard]] double variance_of_mean() const
    {
        return count > 1 ? variance() / static_cast<double>(count) : 0.0;
    }
    [[nodiscard]] double standard_error() const { return std::sqrt(variance_of_mean()); }
};

}  // namespace mote
