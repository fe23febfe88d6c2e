#include "plots/log_plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "plots/svg.h"

namespace mote {

namespace {

constexpr double width = 640.0, height = 320.0;
constexpr double left = 60.0, right = 180.0, top = 26.0, bottom = 40.0;
constexpr const char* colors[] = {"#c33", "#27c", "#292", "#a5a", "#d80", "#088",
                                  "#845", "#888", "#44d", "#9a0", "#e6a", "#333"};
constexpr double bar_height = 16.0;

/// A logarithmic axis between whole decades.
struct LogAxis {
    double first = 0.0, last = 1.0;  ///< decades
    double begin = 0.0, end = 1.0;   ///< in the picture

    [[nodiscard]] double at(double value) const
    {
        return begin + (std::log10(value) - first) / (last - first) * (end - begin);
    }
};

bool is_shown(double value)
{
    return std::isfinite(value) && value > 0.0;
}

LogAxis make_axis(double least, double most, double begin, double end)
{
    if (!(most > 0.0)) return {0.0, 1.0, begin, end};
    const double first = std::floor(std::log10(least) + 1e-9);
    const double last = std::ceil(std::log10(most) - 1e-9);
    return {first, std::max(last, first + 1.0), begin, end};
}

struct Range {
    double least = INFINITY;
    double most = 0.0;

    void add(double value)
    {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

std::string text_at(double x, double y, const char* anchor, const std::string& text)
{
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor,
                       html_text(text));
}

std::string line(double x0, double y0, double x1, double y1, const char* style)
{
    return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" {}/>", x0, y0, x1, y1, style);
}

std::string open_svg(double w, double h, const std::string& title)
{
    return fmt::format(
               "<svg viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
               "role=\"img\">",
               w, h) +
           text_at(8.0, 16.0, "start", title);
}

std::string rules(const LogPlot& plot, const LogAxis& x, const LogAxis& y)
{
    std::string svg;
    for (double decade = x.first; decade <= x.last; decade += 1.0) {
        const double at = x.at(std::pow(10.0, decade));
        svg += line(at, top, at, height - bottom, "stroke=\"#ddd\"");
        svg += text_at(at, height - bottom + 14.0, "middle", fmt::format("1e{:.0f}", decade));
    }
    for (double decade = y.first; decade <= y.last; decade += 1.0) {
        const double at = y.at(std::pow(10.0, decade));
        svg += line(left, at, width - right, at, "stroke=\"#ddd\"");
        svg += text_at(left - 4.0, at + 4.0, "end", fmt::format("1e{:.0f}", decade));
    }
    svg += text_at(0.5 * (left + width - right), height - 8.0, "middle", plot.x_label);
    svg += fmt::format("<g transform=\"translate(12 {:.1f}) rotate(-90)\">{}</g>",
                       0.5 * (top + height - bottom), text_at(0.0, 0.0, "middle", plot.y_label));
    return svg;
}

std::string draw(const LogSeries& series, const char* color, const LogAxis& x, const LogAxis& y)
{
    std::string points;
    std::string marks;
    for (size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
        if (!is_shown(series.x[i]) || !is_shown(series.y[i])) continue;
        const std::string place =
            fmt::format("{:.1f},{:.1f}", x.at(series.x[i]), y.at(series.y[i]));
        points += place + " ";
        marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\"/>", x.at(series.x[i]),
                             y.at(series.y[i]));
    }
    return fmt::format(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"{}/>"
        "<g fill=\"{}\">{}</g>",
        points, color, series.dashed ? " stroke-dasharray=\"5 3\"" : "", color, marks);
}

}  // namespace

std::string log_plot(const LogPlot& plot, std::span<const LogSeries> series)
{
    Range xs, ys;
    for (const LogSeries& s : series) {
        for (size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
            if (!is_shown(s.x[i]) || !is_shown(s.y[i])) continue;
            xs.add(s.x[i]);
            ys.add(s.y[i]);
        }
    }
    const LogAxis x = make_axis(xs.least, xs.most, left, width - right);
    const LogAxis y = make_axis(ys.least, ys.most, height - bottom, top);
    std::string svg = open_svg(width, height, plot.title) + rules(plot, x, y);
    if (is_shown(plot.y_level)) {
        const double at = y.at(plot.y_level);
        if (at >= top && at <= height - bottom) {
            svg += line(left, at, width - right, at, "stroke=\"#444\" stroke-dasharray=\"2 3\"");
        }
    }
    double name_y = top + 10.0;
    for (size_t i = 0; i < series.size(); ++i, name_y += 14.0) {
        const char* color = colors[i % std::size(colors)];
        svg += draw(series[i], color, x, y);
        svg += fmt::format("<g fill=\"{}\">{}</g>", color,
                           text_at(width - right + 10.0, name_y, "start", series[i].name));
    }
    return svg + "</svg>";
}

std::string named_bars(const std::string& title, std::span<const std::string> names,
                       std::span<const double> values, double level)
{
    double most = level;
    for (const double value : values) {
        if (is_shown(value)) most = std::max(most, value);
    }
    const double scale = (width - 2.0 * right) / (most > 0.0 ? most : 1.0);
    const double h = top + bar_height * static_cast<double>(names.size()) + 8.0;
    std::string svg = open_svg(width, h, title);
    double y = top;
    for (size_t i = 0; i < std::min(names.size(), values.size()); ++i, y += bar_height) {
        svg += text_at(right - 6.0, y + 12.0, "end", names[i]);
        if (!is_shown(values[i])) continue;
        svg += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#69b\"/>",
            right, y + 2.0, scale * values[i], bar_height - 4.0);
        svg += text_at(right + scale * values[i] + 4.0, y + 12.0, "start",
                       fmt::format("{:.3g}", values[i]));
    }
    svg += line(right + scale * level, top, right + scale * level, h - 6.0,
                "stroke=\"#444\" stroke-dasharray=\"2 3\"");
    return svg + "</svg>";
}

}  // namespace mote
