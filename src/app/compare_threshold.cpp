#include "app/compare_threshold.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

constexpr ThresholdMetric metrics[] = {
    {"mse", "mean squared difference", [](const ChannelMetrics& c) { return c.mse; }, false},
    {"relmse", "mean squared relative difference",
     [](const ChannelMetrics& c) { return c.rel_mse; }, false},
    {"trimmed-relmse", "the same without the worst 0.1 % of the pixels",
     [](const ChannelMetrics& c) { return c.rel_mse_trimmed; }, false},
    {"psnr", "at least so many dB", [](const ChannelMetrics& c) { return c.psnr; }, true},
    {"mean-ratio", "|mean A / mean B - 1|",
     [](const ChannelMetrics& c) { return std::abs(c.mean_ratio - 1.0); }, false},
    {"corrected-mse", "mse minus the variance of B",
     [](const ChannelMetrics& c) { return c.noise ? c.noise->mse : not_a_number; }, false},
    {"z", "|mean difference| in standard errors",
     [](const ChannelMetrics& c) { return c.noise ? std::abs(c.noise->z) : not_a_number; }, false},
};

bool needs_variance(const ThresholdMetric& metric)
{
    return std::string_view(metric.name) == "corrected-mse" || std::string_view(metric.name) == "z";
}

[[noreturn]] void refuse(const std::string& text, const std::string& reason)
{
    throw Error(ExitCode::Usage, fmt::format("--threshold \"{}\": {}", printable(text), reason));
}

double parse_limit(const std::string& text, const std::string& digits)
{
    std::istringstream in(digits);
    in.imbue(std::locale::classic());
    double limit = 0.0;
    if (!(in >> limit) || !in.eof() || !std::isfinite(limit)) {
        refuse(text, fmt::format("\"{}\" is not a number", printable(digits)));
    }
    return limit;
}

void find_in_channel(const ChannelMetrics& channel, std::span<const Threshold> thresholds,
                     std::vector<std::string>& violations)
{
    for (const Threshold& threshold : thresholds) {
        const ThresholdMetric& metric = *threshold.metric;
        if (needs_variance(metric) && !channel.noise) {
            throw Error(ExitCode::Input,
                        fmt::format("--threshold {} needs the variance of {}, which B does not "
                                    "have; render B with --aovs variance, or choose with --layers",
                                    metric.name, printable(channel.name)));
        }
        const double value = metric.value(channel);
        const bool is_kept =
            metric.is_lower_limit ? value >= threshold.limit : value <= threshold.limit;
        if (is_kept) continue;
        violations.push_back(
            fmt::format("{} of {} is {:.6g}, {} {:g}", metric.name, printable(channel.name), value,
                        metric.is_lower_limit ? "under" : "over", threshold.limit));
    }
    if (channel.non_finite_differing > 0) {
        violations.push_back(fmt::format("{} pixels of {} are NaN or infinite in one image only",
                                         channel.non_finite_differing, printable(channel.name)));
    }
}

}  // namespace

std::span<const ThresholdMetric> threshold_metrics()
{
    return metrics;
}

Threshold parse_threshold(const std::string& text)
{
    const size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const auto metric = std::find_if(std::begin(metrics), std::end(metrics),
                                     [&](const ThresholdMetric& m) { return name == m.name; });
    if (metric == std::end(metrics)) {
        std::vector<std::string> known;
        for (const ThresholdMetric& m : metrics) known.emplace_back(m.name);
        refuse(text, fmt::format("no such figure{}; those known are {}", did_you_mean(name, known),
                                 fmt::join(known, ", ")));
    }
    if (equals == std::string::npos) {
        refuse(text, fmt::format("the limit is missing, as in {}=0.01", name));
    }
    return {metric, parse_limit(text, text.substr(equals + 1))};
}

std::vector<std::string> find_violations(std::span<const Threshold> thresholds,
                                         std::span<const LayerMetrics> layers)
{
    std::vector<std::string> violations;
    if (thresholds.empty()) return violations;
    for (const LayerMetrics& layer : layers) {
        for (const ChannelMetrics& channel : layer.channels) {
            find_in_channel(channel, thresholds, violations);
        }
    }
    return violations;
}

}  // namespace mote
