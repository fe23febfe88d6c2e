#include "app/compare_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text.h"

namespace mote {

namespace {

using Json = nlohmann::ordered_json;

std::string channel_line(const ChannelMetrics& c)
{
    return fmt::format(
        "{:<20} {:>11.5g} {:>11.5g} {:>8.5f} {:>10.3e} {:>10.3e} {:>10.3e} "
        "{:>7.2f} {:>6.1f} %\n",
        "  " + printable(c.name, 60), c.mean_tested, c.mean_reference, c.mean_ratio, c.mse,
        c.rel_mse, c.rel_mse_trimmed, c.psnr, 100.0 * c.worst_share);
}

std::string layer_lines(const LayerMetrics& layer)
{
    std::string lines;
    // A layer of one channel of the same name needs no line of its own.
    if (layer.channels.size() > 1) {
        lines += fmt::format("{:<20} {:>11} {:>11} {:>8} {:>10.3e} {:>10.3e} {:>10.3e}\n",
                             printable(layer.name, 60), "", "", "", layer.mse, layer.rel_mse,
                             layer.rel_mse_trimmed);
    }
    for (const ChannelMetrics& channel : layer.channels) lines += channel_line(channel);
    return lines;
}

std::string worst_lines(const ChannelMetrics& channel)
{
    std::string lines;
    for (const PixelPair& pixel : channel.worst) {
        lines += fmt::format("  {:<18} ({}, {})  A {:.6g}  B {:.6g}\n", printable(channel.name, 60),
                             pixel.x, pixel.y, pixel.tested, pixel.reference);
    }
    return lines;
}

std::string noise_line(const ChannelMetrics& channel)
{
    if (!channel.noise) return "";
    const NoiseMetrics& noise = *channel.noise;
    return fmt::format("  {:<18} MSE {:.3e}, mean A - B = {:.3e} +- {:.1e} (z = {:.2f}){}\n",
                       printable(channel.name, 60), noise.mse, noise.z * noise.standard_error,
                       noise.standard_error, noise.z,
                       noise.bad_variances > 0
                           ? fmt::format(", {} bad variances left out", noise.bad_variances)
                           : "");
}

std::string non_finite_line(const ChannelMetrics& channel)
{
    if (channel.non_finite_tested == 0 && channel.non_finite_reference == 0) return "";
    return fmt::format("  {:<18} {} pixels of A, {} of B, {} of them not the same in both\n",
                       printable(channel.name, 60), channel.non_finite_tested,
                       channel.non_finite_reference, channel.non_finite_differing);
}

/// A paragraph of the lines that `line_of` gives, under a title; nothing if there are none.
template <class LineOf>
std::string paragraph(const CompareReport& report, const char* title, LineOf line_of)
{
    std::string lines;
    for (const LayerMetrics& layer : report.layers) {
        for (const ChannelMetrics& channel : layer.channels) lines += line_of(channel);
    }
    return lines.empty() ? lines : fmt::format("\n{}\n{}", title, lines);
}

Json to_json(const NoiseMetrics& noise)
{
    return {{"mse", noise.mse},
            {"standard_error_of_mean_difference", noise.standard_error},
            {"z", noise.z},
            {"bad_variances", noise.bad_variances}};
}

Json to_json(const ChannelMetrics& c)
{
    Json worst = Json::array();
    for (const PixelPair& p : c.worst) {
        worst.push_back({{"x", p.x}, {"y", p.y}, {"a", p.tested}, {"b", p.reference}});
    }
    return {{"name", c.name},
            {"pixels", c.pixel_count},
            {"non_finite_a", c.non_finite_tested},
            {"non_finite_b", c.non_finite_reference},
            {"non_finite_differing", c.non_finite_differing},
            {"mean_a", c.mean_tested},
            {"mean_b", c.mean_reference},
            {"mean_ratio", c.mean_ratio},
            {"mse", c.mse},
            {"relmse", c.rel_mse},
            {"relmse_epsilon", c.epsilon},
            {"trimmed_relmse", c.rel_mse_trimmed},
            {"peak", c.peak},
            {"psnr", c.psnr},
            {"worst_share", c.worst_share},
            {"worst", std::move(worst)},
            {"noise", c.noise ? to_json(*c.noise) : Json(nullptr)}};
}

Json to_json(const LayerMetrics& layer)
{
    Json channels = Json::array();
    for (const ChannelMetrics& channel : layer.channels) channels.push_back(to_json(channel));
    return {{"name", layer.name},
            {"mse", layer.mse},
            {"relmse", layer.rel_mse},
            {"trimmed_relmse", layer.rel_mse_trimmed},
            {"channels", std::move(channels)}};
}

}  // namespace

std::string compare_table(const CompareReport& report)
{
    std::string table =
        fmt::format("A  {}\nB  {} (reference)\n{} x {} pixels\n\n",
                    printable(report.tested.name, 1000), printable(report.reference.name, 1000),
                    report.reference.image.width, report.reference.image.height);
    table += fmt::format("{:<20} {:>11} {:>11} {:>8} {:>10} {:>10} {:>10} {:>7} {:>8}\n", "",
                         "mean A", "mean B", "A/B", "MSE", "relMSE", "trimmed", "PSNR dB", "worst");
    for (const LayerMetrics& layer : report.layers) table += layer_lines(layer);
    table +=
        "\nrelMSE: mean of (A-B)^2 / (B^2 + 0.01 mean(|B|)^2); trimmed: without the 0.1 % of the\n"
        "pixels that err most; PSNR: against the largest |B|; worst: share of the squared error\n"
        "in the worst 0.1 % of the pixels.\n";
    table += paragraph(report, "Worst pixels (x, y from the top left):", worst_lines);
    table += paragraph(report, "Without the noise of B (its variance layer):", noise_line);
    table += paragraph(report, "Not finite, left out above:", non_finite_line);
    return table;
}

std::string compare_json(const CompareReport& report)
{
    Json layers = Json::array();
    for (const LayerMetrics& layer : report.layers) layers.push_back(to_json(layer));
    const Json json{{"a", report.tested.name},
                    {"b", report.reference.name},
                    {"width", report.reference.image.width},
                    {"height", report.reference.image.height},
                    {"layers", std::move(layers)},
                    {"thresholds", report.thresholds},
                    {"violations", report.violations}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mote
