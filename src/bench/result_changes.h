#pragma once

#include <string>
#include <vector>

#include "bench/report.h"
#include "verify/statistics.h"

namespace mote {

/// How a figure of one row differs between two result files.
struct Change {
    double ratio = 1.0;                  ///< before -> after, geometric mean over the runs
    ConfidenceInterval range{1.0, 1.0};  ///< of the ratio, 95 %
    double p = 1.0;                      ///< chance of such a change by noise alone
    bool exceeds_noise = false;  ///< p after Holm over the table below `change_significance`
};

/// Chance of any false alarm among all figures of one comparison.
inline constexpr double change_significance = 0.01;

/// A row that both files have.
struct RowChange {
    std::string scene;
    std::string mode;
    std::string method;
    Change mse;  ///< times the samples, whose number may differ between the files
    Change cpu;  ///< over the samples
    Change efficiency;
};

/// Rows of the same scene file, size, frame, mode and method. Runs are compared in pairs: equal
/// seeds share their random numbers, so that the same estimator differs in nothing. The noise of
/// CPU times is what the runs show; a machine that was busier all through one of the files looks
/// like a slower program.
[[nodiscard]] std::vector<RowChange> find_changes(const BenchReport& before,
                                                  const BenchReport& after);

/// The changes as text, those above the noise marked.
[[nodiscard]] std::string changes_table(const std::vector<RowChange>& changes);

}  // namespace mote
