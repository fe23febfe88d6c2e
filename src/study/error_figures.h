#pragma once

#include <vector>

#include "study/study.h"

namespace mote {

/// How far the tested estimator's images are from the truth, mean over R, G and B.
struct ErrorFigures {
    ErrorSplit absolute;           ///< [radiance^2]; see split_error
    ErrorSplit relative;           ///< each pixel's over reference^2 + epsilon: parts of relMSE
    double epsilon = 0.0;          ///< 0.01 times the squared mean of the reference [radiance^2]
    int single_runs = 0;           ///< that the following are means over
    double rel_mse = 0.0;          ///< of single runs, the reference's noise taken off
    double trimmed_rel_mse = 0.0;  ///< without each run's worst 0.1 % of pixels
    double worst_share = 0.0;      ///< share of the MSE in those
    /// Autocovariance of the error's luminance at distances of 0, 1, ... pixels along rows and
    /// columns, over that at 0. Of independent pixels without bias: 0 beyond the first.
    std::vector<double> autocovariance;
};

/// Figures of a study of at least two runs, in which the reference is not black (asserted).
[[nodiscard]] ErrorFigures measure_errors(const Study& study);

}  // namespace mote
