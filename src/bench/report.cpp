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

std::string number(double x, const char* format)
{
    return std::isfinite(x) ? fmt::format(fmt::runtime(format), x) : "-";
}

std::string row_line(const MethodResult& row)
{
    const MethodFigures& f = row.figures;
    const std::string ratio_error = number(100.0 * f.efficiency_error, "{:.0f}");
    return fmt::format(
        "  {:<22}{:>5}{:>9}{:>8}{:>10}{:>10}{:>10}{:>10}{:>10}{:>6}{:>9} +-{:<6}{:>10}{:>8}{:>9} "
        "+-{}%\n",
        row.name, row.samples, number(f.cpu_us, "{:.3f}"), number(f.cache_us, "{:.3f}"),
        number(f.n_var, "{:.3e}"), number(f.error.mse, "{:.3e}"),
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
    if (f.bias_p < doubtful_p) {
        text += fmt::format("  ! {}: the mean differs from the reference's (p = {:.1e})\n",
                            row.name, f.bias_p);
    }
    return text;
}

std::string mode_table(const ModeResult& mode, const ReferenceInfo& reference)
{
    size_t runs = 0;
    for (const MethodResult& row : mode.rows) runs = std::max(runs, row.runs.size());
    std::string text = fmt::format("\n{}, {} runs\n", mode_name(mode.mode), runs);
    text += fmt::format(
        "  {:<22}{:>5}{:>9}{:>8}{:>10}{:>10}{:>10}{:>10}{:>10}{:>6}{:>18}{:>10}{:>8}{:>9}\n",
        "method", "spp", "CPU us", "caches", "nVar", "MSE", "trimmed", "relMSE", "trimmed", "worst",
        "bias %", "1/(MSE t)", "x best", "trimmed");
    for (const MethodResult& row : mode.rows) text += row_line(row);
    for (const MethodResult& row : mode.rows) text += remarks(row, reference);
    return text;
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
)";
}

}  // namespace mote
