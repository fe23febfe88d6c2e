#include <cmath>

#include <fmt/format.h>

#include "bench/report.h"
#include "plots/log_plot.h"
#include "plots/page.h"
#include "plots/svg.h"

namespace mote {

namespace {

/// A row's error against time: its curve, or the one point it has.
LogSeries series_of(const MethodResult& row)
{
    LogSeries series;
    series.name = row.name + (row.is_biased ? " (biased)" : "");
    series.dashed = row.is_biased;
    for (const CurvePoint& point : row.curve) {
        series.x.push_back(point.cpu_us);
        series.y.push_back(point.rel_mse);
    }
    if (row.curve.empty()) {
        series.x.push_back(row.figures.cpu_us);
        series.y.push_back(row.figures.error.rel_mse);
    }
    return series;
}

std::string efficiency_bars(const ModeResult& mode)
{
    std::vector<std::string> names;
    std::vector<double> ratios;
    for (const MethodResult& row : mode.rows) {
        names.push_back(row.name + (row.is_biased ? " (biased)" : ""));
        ratios.push_back(row.figures.ratio);
    }
    return named_bars("Efficiency over the best path tracer (dashed: equal)", names, ratios, 1.0);
}

}  // namespace

std::string error_plot(const SceneResult& scene, const ModeResult& mode)
{
    std::vector<LogSeries> series;
    for (const MethodResult& row : mode.rows) series.push_back(series_of(row));
    const LogPlot plot{
        fmt::format("{}, {}, {} x {} pixels", scene.name.empty() ? scene.path : scene.name,
                    mode_name(mode.mode), scene.width, scene.height),
        "CPU time [us per pixel]", "relMSE", target_rel_mse};
    return log_plot(plot, series);
}

std::string bench_html(const BenchReport& report)
{
    std::string html = page_begin("mote bench");
    for (const SceneResult& scene : report.scenes) {
        html += fmt::format("<h1>mote bench: {}</h1>\n",
                            html_text(scene.name.empty() ? scene.path : scene.name));
        for (const ModeResult& mode : scene.modes) {
            html += fmt::format("<h2>{}</h2>\n", mode_name(mode.mode));
            html += error_plot(scene, mode) + efficiency_bars(mode) + "\n";
        }
        html += preformatted(bench_table(scene));
    }
    html += preformatted(bench_legend());
    html += fmt::format("<p>mote {}, {}, {} thread{}.</p>\n", html_text(report.version),
                        html_text(report.build), report.threads, report.threads == 1 ? "" : "s");
    return html + page_end();
}

}  // namespace mote
