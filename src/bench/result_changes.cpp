#include "bench/result_changes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text.h"
#include "verify/p_values.h"

namespace mote {

namespace {

constexpr double confidence = 0.95;
/// Logarithms closer than this are equal but for rounding.
constexpr double rounding = 1e-9;

template <class ValueOf>
Change change_of(const MethodResult& before, const MethodResult& after, ValueOf value_of)
{
    RunningStats logs;
    for (size_t k = 0; k < std::min(before.runs.size(), after.runs.size()); ++k) {
        const double log_ratio =
            std::log(value_of(after, after.runs[k]) / value_of(before, before.runs[k]));
        if (std::isfinite(log_ratio)) logs.add(log_ratio);
    }
    const MeanEstimate mean = estimate_mean(logs);
    const ConfidenceInterval range = confidence_interval(mean, confidence);
    return {std::exp(mean.mean),
            {std::exp(range.lower), std::exp(range.upper)},
            test_zero(mean, rounding).p,
            false};
}

const ModeResult* find(const SceneResult& scene, BenchMode mode)
{
    const auto it = std::find_if(scene.modes.begin(), scene.modes.end(),
                                 [&](const ModeResult& m) { return m.mode == mode; });
    return it == scene.modes.end() ? nullptr : &*it;
}

/// The same scene at the same size; its text may have changed.
const SceneResult* find(const BenchReport& report, const SceneResult& like)
{
    const auto it =
        std::find_if(report.scenes.begin(), report.scenes.end(), [&](const SceneResult& s) {
            return s.path == like.path && s.width == like.width && s.height == like.height &&
                   s.frame == like.frame && s.seed == like.seed;
        });
    return it == report.scenes.end() ? nullptr : &*it;
}

void add_rows(const SceneResult& scene, const ModeResult& before, const ModeResult& after,
              std::vector<RowChange>& changes)
{
    for (const MethodResult& a : before.rows) {
        for (const MethodResult& b : after.rows) {
            if (a.name != b.name) continue;
            const auto mse = [](const MethodResult& row, const RunFigures& run) {
                return run.error.mse * row.samples;
            };
            const auto cpu = [](const MethodResult& row, const RunFigures& run) {
                return run.cpu_us / row.samples;
            };
            const auto efficiency = [](const MethodResult&, const RunFigures& run) {
                return 1.0 / (run.error.mse * run.cpu_us);
            };
            changes.push_back({scene.path, mode_name(before.mode), a.name, change_of(a, b, mse),
                               change_of(a, b, cpu), change_of(a, b, efficiency)});
        }
    }
}

void mark_changes(std::vector<RowChange>& changes)
{
    std::vector<double> p;
    for (const RowChange& row : changes) {
        for (const Change* c : {&row.mse, &row.cpu, &row.efficiency}) p.push_back(c->p);
    }
    const std::vector<double> adjusted = holm_adjusted(p);
    size_t i = 0;
    for (RowChange& row : changes) {
        for (Change* c : {&row.mse, &row.cpu, &row.efficiency}) {
            c->exceeds_noise = adjusted[i++] <= change_significance;
        }
    }
}

std::string cell(const Change& c)
{
    return fmt::format("{:>7.3f} [{:.3f}, {:.3f}]{}", c.ratio, c.range.lower, c.range.upper,
                       c.exceeds_noise ? " *" : "");
}

}  // namespace

std::vector<RowChange> find_changes(const BenchReport& before, const BenchReport& after)
{
    std::vector<RowChange> changes;
    for (const SceneResult& scene : before.scenes) {
        const SceneResult* other = find(after, scene);
        if (other == nullptr) continue;
        for (const ModeResult& mode : scene.modes) {
            const ModeResult* other_mode = find(*other, mode.mode);
            if (other_mode != nullptr) add_rows(scene, mode, *other_mode, changes);
        }
    }
    mark_changes(changes);
    return changes;
}

std::string changes_table(const std::vector<RowChange>& changes)
{
    std::string text = fmt::format("{:<36}{:<8}{:<28}{:<27}{:<27}{}\n", "scene", "mode", "method",
                                   "MSE x samples", "CPU / samples", "efficiency");
    for (const RowChange& row : changes) {
        text += fmt::format("{:<36}{:<8}{:<28}{:<27}{:<27}{}\n", printable(row.scene), row.mode,
                            row.method, cell(row.mse), cell(row.cpu), cell(row.efficiency));
    }
    text += fmt::format(
        "\nFirst file over second one, with 95 % ranges; * is above the noise (at most {:.0f} %\n"
        "chance of any false * here). CPU times of files from busier hours look worse.\n",
        100.0 * change_significance);
    return text;
}

}  // namespace mote
