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

MethodFigures summarize(std::span<const RunFigures> runs, const PixelStats& tested,
                        const PixelStats& reference)
{
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
