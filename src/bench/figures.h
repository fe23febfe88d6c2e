#pragma once

#include <span>
#include <string>
#include <vector>

#include "runs/run_error.h"

namespace mote {

/// One run of one method. Times are per pixel [microseconds] of what the run's image took.
struct RunFigures {
    RunError error;
    double cpu_us = 0.0;    ///< process CPU time, caches included
    double cache_us = 0.0;  ///< the share of cpu_us that went into caches
    double wall_us = 0.0;
};

/// One method over its runs. Errors and times are medians over the runs.
struct MethodFigures {
    double n_var = 0.0;       ///< variance of a run over the square of the reference's mean
    double bias = 0.0;        ///< of the mean over the image, relative
    double bias_error = 0.0;  ///< its standard error, the reference's share included
    double bias_p = 1.0;      ///< chance of such a bias if there is none, by Welch's t-test
    RunError error;
    double cpu_us = 0.0;
    double cache_us = 0.0;
    double wall_us = 0.0;
    double efficiency = 0.0;          ///< 1 / (mse cpu_us) [1/us]; NaN where the noise of the
    double trimmed_efficiency = 0.0;  ///< reference hides the error
    double efficiency_error = 0.0;    ///< relative standard error, from the scatter over the runs
    double ratio = 0.0;               ///< efficiency over the best row of the reference path
    double trimmed_ratio = 0.0;       ///< tracer; each ratio has its own best. NaN without one
};

/// A row of the table.
struct MethodResult {
    std::string name;
    bool is_reference = false;
    int samples = 1;         ///< per pixel and frame
    int frames = 1;          ///< rendered per run
    int64_t non_finite = 0;  ///< pixels and samples replaced by black, all runs; must be 0
    std::vector<RunFigures> runs;
    MethodFigures figures;
};

/// Figures of a method from its runs and the pixel statistics of their images; ratios stay empty.
[[nodiscard]] MethodFigures summarize(std::span<const RunFigures> runs, const PixelStats& tested,
                                      const PixelStats& reference);

/// Fills in the ratios: each row's efficiency over that of the best reference row.
void rate_rows(std::vector<MethodResult>& rows);

}  // namespace mote
