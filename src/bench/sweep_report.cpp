#include "bench/sweep_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text.h"
#include "plots/log_plot.h"
#include "plots/page.h"

namespace mote {

namespace {

using Json = nlohmann::ordered_json;

constexpr double megabyte = 1e6;

double pixels(const SweepPoint& point)
{
    return static_cast<double>(point.width) * point.height;
}

Json to_json(const SweepPoint& point)
{
    Json rows = Json::array();
    for (const SweepRow& row : point.rows) {
        Json work = Json::object();
        for (const WorkField& field : work_fields()) work[field.name] = row.work.*field.value;
        rows.push_back({{"method", row.method},
                        {"cache_cpu_s", row.cache_seconds},
                        {"render_cpu_s", row.render_seconds},
                        {"wall_s", row.wall_seconds},
                        {"work", std::move(work)}});
    }
    Json memory = Json::object();
    for (const MemoryField& field : memory_fields()) {
        memory[field.name] = point.memory.*field.value;
    }
    return {{"x", point.x},
            {"width", point.width},
            {"height", point.height},
            {"prepare_cpu_s", point.prepare_seconds},
            {"memory_bytes", std::move(memory)},
            {"methods", std::move(rows)}};
}

}  // namespace

std::string sweep_text(const SweepResult& sweep)
{
    const SweepInfo& info = sweep_info(sweep.kind);
    std::string text =
        fmt::format("sweep {}: {} ({})\n", info.name, info.doc, printable(sweep.scene, 1000));
    text += fmt::format("  {:>12} {:>11} {:<28}{:>9}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n",
                        info.column, "prepare s", "method", "caches s", "render s", "us/pixel",
                        "wall s", "lookups", "cells", "grids MB", "caches MB");
    for (const SweepPoint& point : sweep.points) {
        for (const SweepRow& row : point.rows) {
            text += fmt::format(
                "  {:>12g} {:>11.3f} {:<28}{:>9.3f}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.3g}{:>10.3g}"
                "{:>10.2f}{:>10.2f}\n",
                point.x, point.prepare_seconds, row.method, row.cache_seconds, row.render_seconds,
                1e6 * row.render_seconds / pixels(point), row.wall_seconds,
                row.work.lookups / pixels(point), row.work.cells / pixels(point),
                point.memory.grids / megabyte, point.memory.caches() / megabyte);
        }
    }
    for (size_t i = 0; !sweep.points.empty() && i < sweep.points.front().rows.size(); ++i) {
        const double slope = sweep_slope(sweep, i);
        // CPU time does not grow with threads: the clock's column tells.
        if (!std::isfinite(slope) || sweep.kind == SweepKind::Threads) continue;
        text += fmt::format("  {}: render time as the {:.2f}th power\n",
                            sweep.points.front().rows[i].method, slope);
    }
    for (const double x : sweep.left_out) {
        text += fmt::format("  {:g} left out: more --max-seconds would reach it\n", x);
    }
    return text;
}

std::string sweep_plot(const SweepResult& sweep)
{
    const SweepInfo& info = sweep_info(sweep.kind);
    const bool by_clock = sweep.kind == SweepKind::Threads;
    std::vector<LogSeries> series;
    LogSeries prepare{"prepare", {}, {}, true};
    for (const SweepPoint& point : sweep.points) {
        prepare.x.push_back(point.x);
        prepare.y.push_back(point.prepare_seconds);
        series.resize(std::max(series.size(), 2 * point.rows.size()));
        for (size_t i = 0; i < point.rows.size(); ++i) {
            const SweepRow& row = point.rows[i];
            LogSeries& frame = series[2 * i];
            LogSeries& caches = series[2 * i + 1];
            frame.name = row.method;
            caches.name = row.method + ", caches";
            caches.dashed = true;
            frame.x.push_back(point.x);
            frame.y.push_back(by_clock ? row.wall_seconds : row.render_seconds);
            caches.x.push_back(point.x);
            // Looking whether there is anything to build takes no time worth a line.
            caches.y.push_back(row.cache_seconds > 1e-4 && !by_clock ? row.cache_seconds : 0.0);
        }
    }
    std::erase_if(series, [](const LogSeries& s) {
        return std::all_of(s.y.begin(), s.y.end(), [](double y) { return y == 0.0; });
    });
    if (!by_clock) series.push_back(std::move(prepare));
    const LogPlot plot{fmt::format("{}: {}", info.name, info.doc), info.x_label,
                       by_clock ? "wall time of a frame [s]" : "CPU time of a frame [s]", 0.0};
    return log_plot(plot, series);
}

std::string sweeps_json(const std::vector<SweepResult>& sweeps)
{
    Json all = Json::array();
    for (const SweepResult& sweep : sweeps) {
        Json points = Json::array();
        for (const SweepPoint& point : sweep.points) points.push_back(to_json(point));
        all.push_back({{"sweep", sweep_info(sweep.kind).name},
                       {"scene", sweep.scene},
                       {"points", std::move(points)},
                       {"left_out", sweep.left_out}});
    }
    const Json json{{"format", "mote sweep 1"}, {"sweeps", std::move(all)}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string sweeps_csv(const std::vector<SweepResult>& sweeps)
{
    std::string text =
        "sweep,x,width,height,prepare_cpu_s,method,cache_cpu_s,render_cpu_s,wall_s,grid_bytes,"
        "cache_bytes\n";
    for (const SweepResult& sweep : sweeps) {
        for (const SweepPoint& point : sweep.points) {
            for (const SweepRow& row : point.rows) {
                text += fmt::format("{},{:g},{},{},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.0f},{:.0f}\n",
                                    sweep_info(sweep.kind).name, point.x, point.width, point.height,
                                    point.prepare_seconds, row.method, row.cache_seconds,
                                    row.render_seconds, row.wall_seconds, point.memory.grids,
                                    point.memory.caches());
            }
        }
    }
    return text;
}

std::string sweeps_html(const std::vector<SweepResult>& sweeps)
{
    std::string html = page_begin("mote bench --sweep") + "<h1>mote bench --sweep</h1>\n";
    for (const SweepResult& sweep : sweeps) {
        html += sweep_plot(sweep) + "\n" + preformatted(sweep_text(sweep));
    }
    return html + page_end();
}

}  // namespace mote
