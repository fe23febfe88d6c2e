#include "bench/report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text.h"

namespace mote {

namespace {

/// A reference noisier than this share of a row's error makes its figures uncertain.
constexpr double noisy_reference = 0.5;
/// Rows that differ from the reference by less than chance once in this many are not remarked on.
constexpr double doubtful_p = 1e-3;
constexpr double megabyte = 1e6;

std::string number(double x, const char* format)
{
    return std::isfinite(x) ? fmt::format(fmt::runtime(format), x) : "-";
}

std::string row_line(const MethodResult& row)
{
    const MethodFigures& f = row.figures;
    const std::string ratio_error = number(100.0 * f.efficiency_error, "{:.0f}");
    return fmt::format(
        "  {:<28}{:>5}{:>9}{:>8}{:>10}{:>10}{:>10}{:>10}{:>10}{:>6}{:>9} +-{:<6}{:>10}{:>8}{:>9} "
        "+-{}%\n",
        row.name + (row.is_biased ? " *" : ""), row.samples, number(f.cpu_us, "{:.3f}"),
        number(f.cache_us, "{:.3f}"), number(f.n_var, "{:.3e}"), number(f.error.mse, "{:.3e}"),
        number(f.error.trimmed_mse, "{:.3e}"), number(f.error.rel_mse, "{:.3e}"),
        number(f.error.trimmed_rel_mse, "{:.3e}"), number(100.0 * f.error.worst_share, "{:.0f}%"),
        number(100.0 * f.bias, "{:+.3f}"), number(100.0 * f.bias_error, "{:.3f}"),
        number(f.efficiency, "{:.3g}"), number(f.ratio, "{:.2f}"),
        number(f.trimmed_ratio, "{:.2f}"), ratio_error);
}

std::string remarks(const MethodResult& row, const ReferenceInfo& reference)
{
    std::string text;
    const MethodFigures& f = row.figures;
    if (row.non_finite > 0) {
        text += fmt::format("  ! {}: {} pixels or samples were not finite and count as black\n",
                            row.name, row.non_finite);
    }
    if (!(reference.noise < noisy_reference * f.error.mse)) {
        text += fmt::format(
            "  ! {}: the reference's noise ({:.1e}) is not small against its error; "
            "a longer --reference-time makes the figures surer\n",
            row.name, reference.noise);
    }
    if (f.bias_p < doubtful_p && !row.is_biased) {
        text += fmt::format("  ! {}: the mean differs from the reference's (p = {:.1e})\n",
                            row.name, f.bias_p);
    }
    return text;
}

/// With a sign for infinity: a bias that no time takes away.
std::string time_to_target(double us)
{
    return std::isinf(us) ? "never" : number(us, "{:.3g}");
}

std::string cost_line(const MethodResult& row)
{
    const MethodFigures& f = row.figures;
    const std::string floor =
        row.is_biased ? number(100.0 * std::sqrt(std::max(f.rel_bias_squared, 0.0)), "{:.2f}")
                      : "-";
    std::string line =
        fmt::format("  {:<28}{:>9}{:>10}{:>7}{:>8}", row.name, number(f.pass_us, "{:.3f}"),
                    time_to_target(f.time_to_target), number(f.slope, "{:.2f}"), floor);
    for (const WorkField& field : work_fields()) {
        line += fmt::format("{:>12}", number(row.work.*field.value, "{:.3g}"));
    }
    return line + fmt::format("{:>11.2f}{:>11.2f}\n", row.memory.caches() / megabyte,
                              row.memory.history / megabyte);
}

std::string cost_table(const ModeResult& mode)
{
    std::string text =
        fmt::format("\n  {:<28}{:>9}{:>10}{:>7}{:>8}", mode_name(mode.mode) + std::string(", cost"),
                    "us/pass", "us to 1%", "slope", "bias %");
    for (const WorkField& field : work_fields()) text += fmt::format("{:>12}", field.name);
    text += fmt::format("{:>11}{:>11}\n", "caches MB", "history MB");
    for (const MethodResult& row : mode.rows) text += cost_line(row);
    return text;
}

std::string mode_table(const ModeResult& mode, const ReferenceInfo& reference)
{
    size_t runs = 0;
    for (const MethodResult& row : mode.rows) runs = std::max(runs, row.runs.size());
    std::string text = fmt::format("\n{}, {} runs\n", mode_name(mode.mode), runs);
    if (!mode.rows.empty() && mode.rows.front().compared > 1) {
        text = fmt::format("\n{}, the mean of {} frames, {} runs\n", mode_name(mode.mode),
                           mode.rows.front().compared, runs);
    }
    text += fmt::format(
        "  {:<28}{:>5}{:>9}{:>8}{:>10}{:>10}{:>10}{:>10}{:>10}{:>6}{:>18}{:>10}{:>8}{:>9}\n",
        "method", "spp", "CPU us", "caches", "nVar", "MSE", "trimmed", "relMSE", "trimmed", "worst",
        "bias %", "1/(MSE t)", "x best", "trimmed");
    for (const MethodResult& row : mode.rows) text += row_line(row);
    for (const MethodResult& row : mode.rows) text += remarks(row, reference);
    return text + cost_table(mode);
}

}  // namespace

std::string bench_table(const SceneResult& scene)
{
    const ReferenceInfo& r = scene.reference;
    std::string text = fmt::format("{}: {} x {} pixels, frame {}\n", printable(scene.path, 1000),
                                   scene.width, scene.height, scene.frame);
    text += fmt::format(
        "reference: {}, {} x {} samples per pixel, mean {:.5g} +- {:.3f} %, noise {:.1e} (taken "
        "off "
        "the MSE)\n",
        r.method, r.runs, r.samples, r.mean, 100.0 * r.relative_error, r.noise);
    if (!scene.left_out.empty()) {
        text += fmt::format("left out, far behind in short runs: {}\n",
                            fmt::join(scene.left_out, ", "));
    }
    if (!scene.modes.empty() && !scene.modes.front().rows.empty()) {
        const MemoryUse& memory = scene.modes.front().rows.front().memory;
        text += fmt::format("memory: grids {:.2f} MB, film {:.2f} MB\n", memory.grids / megabyte,
                            memory.film / megabyte);
    }
    for (const ModeResult& mode : scene.modes) text += mode_table(mode, r);
    return text;
}

std::string bench_legend()
{
    return R"(
spp: samples per pixel of the frame; CPU us: process CPU time per pixel of the frame
compared, of it caches: those of all frames rendered over their number. nVar: variance
over the runs; MSE against the reference; both over the square of the reference's mean.
relMSE: each pixel's over reference^2 + 0.01 mean^2. trimmed: without the 0.1 % of the
pixels that err most; worst: their share of the MSE. Errors and times are medians over
the runs. 1/(MSE t): efficiency, t in CPU us. x best: over the best row of the path
tracer, by the full and by the trimmed MSE, with the efficiency's standard error.
*: known to be biased; bias %: root of the part of relMSE that more samples leave.
us/pass: CPU time per pixel and sample, caches apart; to 1%: CPU us per pixel to a
relMSE of 1 %, from what was measured, if the variance falls as one over time; slope:
of log relMSE over log time (still; -1: as one over time). Then counts per pixel and
sample, which no clock disturbs: rays tabulated from the camera, density lookups, cells
and bricks of 8^3 in closed form, rays towards lights, candidates, reservoirs reused.
)";
}

}  // namespace mote
