#pragma once

#include <cmath>
#include <vector>

namespace mote::test {

/// Chi-squared statistic of counts against expected counts, as a standard normal (Wilson and
/// Hilferty 1931). Bins expecting fewer than 5 are merged into one. |z| > 5 has probability 6e-7.
inline double chi_squared_z(const std::vector<double>& observed,
                            const std::vector<double>& expected)
{
    double statistic = 0.0;
    double merged_observed = 0.0;
    double merged_expected = 0.0;
    int bins = 0;
    const auto add = [&](double o, double e) {
        statistic += (o - e) * (o - e) / e;
        ++bins;
    };
    for (size_t i = 0; i < observed.size(); ++i) {
        if (expected[i] >= 5.0) {
            add(observed[i], expected[i]);
        } else {
            merged_observed += observed[i];
            merged_expected += expected[i];
        }
    }
    if (merged_expected >= 5.0) add(merged_observed, merged_expected);
    // Samples where next to none may fall must not go unnoticed.
    if (merged_expected < 5.0 && merged_observed > merged_expected + 20.0) return 1e3;
    const double freedom = bins - 1;
    if (freedom < 1.0) return 0.0;
    const double spread = 2.0 / (9.0 * freedom);
    return (std::cbrt(statistic / freedom) - (1.0 - spread)) / std::sqrt(spread);
}

}  // namespace mote::test
