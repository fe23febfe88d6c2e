#include "plots/svg.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text.h"

namespace mote {

namespace {

constexpr double width = 420.0, height = 200.0;
constexpr double left = 46.0, right = 10.0, top = 26.0, bottom = 24.0;
constexpr const char* line_colors[] = {"#c44", "#27c", "#292", "#a5a"};

double y_of(const Plot& plot, double value)
{
    const double share = (value - plot.y_min) / (plot.y_max - plot.y_min);
    return top + (1.0 - std::clamp(share, 0.0, 1.0)) * (height - top - bottom);
}

double x_of(double share)
{
    return left + share * (width - left - right);
}

std::string text_at(double x, double y, const char* anchor, const std::string& text)
{
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor,
                       html_text(text));
}

std::string open_plot(const Plot& plot, double level)
{
    std::string svg =
        fmt::format("<svg viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" role=\"img\">", width,
                    height, width, height);
    svg += text_at(left, 16.0, "start", plot.title);
    svg +=
        text_at(left - 4.0, y_of(plot, plot.y_max) + 4.0, "end", fmt::format("{:.3g}", plot.y_max));
    svg +=
        text_at(left - 4.0, y_of(plot, plot.y_min) + 4.0, "end", fmt::format("{:.3g}", plot.y_min));
    if (!plot.x_labels.empty()) {
        svg += text_at(left, height - 8.0, "start", plot.x_labels.front());
        svg += text_at(width - right, height - 8.0, "end", plot.x_labels.back());
    }
    svg +=
        fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\" fill=\"none\" stroke=\"#888\"/>",
                    left, top, height - bottom, width - right);
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}H{2:.1f}\" stroke=\"#444\" stroke-dasharray=\"4 3\"/>", left,
        y_of(plot, level), width - right);
    return svg;
}

}  // namespace

std::string bar_plot(const Plot& plot, std::span<const double> values, double level)
{
    std::string svg = open_plot(plot, level);
    const auto count = static_cast<double>(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i])) continue;
        const double zero = y_of(plot, 0.0);
        const double end = y_of(plot, values[i]);
        const double x = x_of((static_cast<double>(i) + 0.1) / count);
        svg += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#69b\"/>", x,
            std::min(zero, end), x_of(0.8 / count) - left, std::abs(zero - end));
    }
    return svg + "</svg>";
}

std::string line_plot(const Plot& plot, const std::vector<std::string>& names,
                      const std::vector<std::vector<double>>& rows, double level)
{
    std::string svg = open_plot(plot, level);
    for (size_t row = 0; row < rows.size(); ++row) {
        const char* color = line_colors[row % std::size(line_colors)];
        std::string points;
        for (size_t i = 0; i < rows[row].size(); ++i) {
            if (!std::isfinite(rows[row][i])) continue;
            const double steps = std::max(static_cast<double>(rows[row].size()) - 1.0, 1.0);
            points += fmt::format("{:.1f},{:.1f} ", x_of(static_cast<double>(i) / steps),
                                  y_of(plot, rows[row][i]));
        }
        svg += fmt::format(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" "
            "stroke-width=\"1.5\"/>",
            points, color);
        svg += fmt::format("<g fill=\"{}\">{}</g>", color,
                           text_at(width - right, top + 14.0 * (double(row) + 1.0), "end",
                                   row < names.size() ? names[row] : ""));
    }
    return svg + "</svg>";
}

std::string html_text(const std::string& text)
{
    std::string escaped;
    for (const char c : printable(text, 2000)) {
        switch (c) {
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '&':
                escaped += "&amp;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            default:
                escaped += c;
        }
    }
    return escaped;
}

}  // namespace mote
