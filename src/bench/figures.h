#pragma once

#include <span>
#include <string>
#include <vector>

#include "runs/run_error.h"
#include "runs/work.h"

namespace mote {

/// One run of one method. Times are per pixel [microseconds] of what the run's image took.
struct RunFigures {
    RunError error;
    double cpu_us = 0.0;    ///< process CPU time, caches included
    double cache_us = 0.0;  ///< the share of cpu_us that went into caches
    double wall_us = 0.0;
};

/// Error of a method at a number of samples; medians over the runs, times as in RunFigures.
struct CurvePoint {
    int samples = 1;
    double cpu_us = 0.0;
    double cache_us = 0.0;
    double mse = 0.0;
    double rel_mse = 0.0;
};

/// The relMSE that time_to_target is about: an error of a tenth.
inline constexpr double target_rel_mse = 0.01;

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
    double pass_us = 0.0;  ///< CPU time of a sample without caches, per pixel
    /// Share of the mse, and of rel_mse, that more samples do not take away: from all runs by the
    /// error of their mean. Estimates: below 0 as often as above it where there is no bias.
    double bias_squared = 0.0;
    double rel_bias_squared = 0.0;
    /// CPU time per pixel to a rel_mse of target_rel_mse [us], if the variance falls with time from
    /// what was measured. Infinite: the bias of a row known to be biased is above it.
    double time_to_target = 0.0;
    double slope = 0.0;  ///< of log rel_mse over log time without caches, fitted; NaN: no curve
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
    bool is_biased = false;  ///< known to be
    int samples = 1;         ///< per pixel and frame
    int compared = 1;        ///< frames whose mean is compared
    int frames = 1;          ///< rendered per run
    int64_t non_finite = 0;  ///< pixels and samples replaced by black, all runs; must be 0
    std::vector<RunFigures> runs;
    std::vector<CurvePoint> curve;  ///< error against samples, fewest first; may be empty
    WorkCounts work;                ///< per pixel and sample, mean over the runs
    MemoryUse memory;               ///< of the last frame of the last run
    MethodFigures figures;
};

/// Figures of a method from its runs and the pixel statistics of their images, which are of `row`;
/// ratios stay empty.
[[nodiscard]] MethodFigures summarize(const MethodResult& row, const PixelStats& tested,
                                      const PixelStats& reference);

/// Medians of runs of this many samples.
[[nodiscard]] CurvePoint curve_point(int samples, std::span<const RunFigures> runs);

/// Slope of log rel_mse over log time, caches left out, by least squares; NaN for fewer than two
/// points with an error above the reference's noise.
[[nodiscard]] double log_slope(std::span<const CurvePoint> curve);

/// Fills in the ratios: each row's efficiency over that of the best reference row.
void rate_rows(std::vector<MethodResult>& rows);

}  // namespace mote
