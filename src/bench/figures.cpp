#include "bench/figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runs/trimmed_mean.h"
#include "verify/statistics.h"

namespace mote {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class ValueOf>
double median_over(std::span<const RunFigures> runs, ValueOf value_of)
{
    std::vector<double> values;
    for (const RunFigures& run : runs) values.push_back(value_of(run));
    return median(std::move(values));
}

double efficiency_of(double mse, double cpu_us)
{
    return mse > 0.0 && cpu_us > 0.0 ? 1.0 / (mse * cpu_us) : nan;
}

/// Standard error of the mean logarithm of the runs' efficiencies: relative to first order.
double efficiency_error(std::span<const RunFigures> runs)
{
    RunningStats logs;
    for (const RunFigures& run : runs) {
        logs.add(std::log(efficiency_of(run.error.mse, run.cpu_us)));
    }
    return runs.size() > 1 ? logs.standard_error() : nan;
}

/// Of K runs the mean error is bias^2 + variance, that of their mean bias^2 + variance / K.
void add_bias(std::span<const RunFigures> runs, const PixelStats& tested,
              const PixelStats& reference, MethodFigures& f)
{
    const auto k = static_cast<double>(runs.size());
    if (runs.size() < 2) {
        f.bias_squared = f.rel_bias_squared = nan;
        return;
    }
    const RunError of_mean = measure_error(tested.mean, reference);
    double mse = 0.0;
    double rel_mse = 0.0;
    for (const RunFigures& run : runs) {
        mse += run.error.mse / k;
        rel_mse += run.error.rel_mse / k;
    }
    f.bias_squared = (k * of_mean.mse - mse) / (k - 1.0);
    f.rel_bias_squared = (k * of_mean.rel_mse - rel_mse) / (k - 1.0);
}

/// Largest value over the reference rows; NaN if none has one.
template <class ValueOf>
double best_reference(const std::vector<MethodResult>& rows, ValueOf value_of)
{
    double best = nan;
    for (const MethodResult& row : rows) {
        const double value = value_of(row.figures);
        if (row.is_reference && !(value <= best) && !std::isnan(value)) best = value;
    }
    return best;
}

}  // namespace

CurvePoint curve_point(int samples, std::span<const RunFigures> runs)
{
    return {samples, median_over(runs, [](const RunFigures& r) { return r.cpu_us; }),
            median_over(runs, [](const RunFigures& r) { return r.cache_us; }),
            median_over(runs, [](const RunFigures& r) { return r.error.mse; }),
            median_over(runs, [](const RunFigures& r) { return r.error.rel_mse; })};
}

double log_slope(std::span<const CurvePoint> curve)
{
    double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (const CurvePoint& point : curve) {
        const double x = std::log(point.cpu_us - point.cache_us);
        const double y = std::log(point.rel_mse);
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        n += 1.0;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const double spread = n * sxx - sx * sx;
    return n >= 2.0 && spread > 0.0 ? (n * sxy - sx * sy) / spread : nan;
}

MethodFigures summarize(const MethodResult& row, const PixelStats& tested,
                        const PixelStats& reference)
{
    const std::span<const RunFigures> runs = row.runs;
    MethodFigures f;
    const double truth = reference.image_means.mean;
    f.n_var = tested.run_count > 1 ? mean_variance(tested) / (truth * truth) : nan;
    const TestResult bias =
        welch_test(estimate_mean(tested.image_means), estimate_mean(reference.image_means));
    f.bias = bias.difference.mean / truth;
    f.bias_error = bias.difference.standard_error() / std::abs(truth);
    f.bias_p = bias.p;
    f.error.mse = median_over(runs, [](const RunFigures& r) { return r.error.mse; });
    f.error.trimmed_mse =
        median_over(runs, [](const RunFigures& r) { return r.error.trimmed_mse; });
    f.error.rel_mse = median_over(runs, [](const RunFigures& r) { return r.error.rel_mse; });
    f.error.trimmed_rel_mse =
        median_over(runs, [](const RunFigures& r) { return r.error.trimmed_rel_mse; });
    f.error.worst_share =
        median_over(runs, [](const RunFigures& r) { return r.error.worst_share; });
    f.cpu_us = median_over(runs, [](const RunFigures& r) { return r.cpu_us; });
    f.cache_us = median_over(runs, [](const RunFigures& r) { return r.cache_us; });
    f.wall_us = median_over(runs, [](const RunFigures& r) { return r.wall_us; });
    const double samples = double(row.samples) * row.compared;
    f.pass_us = (f.cpu_us - f.cache_us) / samples;
    add_bias(runs, tested, reference, f);
    const double floor = row.is_biased ? std::max(f.rel_bias_squared, 0.0) : 0.0;
    f.time_to_target = f.cache_us + samples * f.pass_us * std::max(f.error.rel_mse - floor, 0.0) /
                                        std::max(target_rel_mse - floor, 0.0);
    if (f.error.rel_mse <= 0.0) f.time_to_target = nan;
    if (floor >= target_rel_mse) f.time_to_target = std::numeric_limits<double>::infinity();
    f.slope = log_slope(row.curve);
    f.efficiency = efficiency_of(f.error.mse, f.cpu_us);
    f.trimmed_efficiency = efficiency_of(f.error.trimmed_mse, f.cpu_us);
    f.efficiency_error = efficiency_error(runs);
    f.ratio = f.trimmed_ratio = nan;
    return f;
}

void rate_rows(std::vector<MethodResult>& rows)
{
    const double best = best_reference(rows, [](const MethodFigures& f) { return f.efficiency; });
    const double trimmed_best =
        best_reference(rows, [](const MethodFigures& f) { return f.trimmed_efficiency; });
    for (MethodResult& row : rows) {
        row.figures.ratio = row.figures.efficiency / best;
        row.figures.trimmed_ratio = row.figures.trimmed_efficiency / trimmed_best;
    }
}

}  // namespace mote
