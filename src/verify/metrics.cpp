#include "verify/metrics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "core/error.h"

namespace mote {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Sum of the `count` largest values, and of the others.
struct SplitSum {
    double largest = 0.0;
    double others = 0.0;
};

/// Reorders `values`, of which there are at least `count`.
SplitSum split_sum(std::vector<double>& values, size_t count)
{
    const auto border = values.begin() + static_cast<std::ptrdiff_t>(count);
    if (border != values.end()) {
        std::nth_element(values.begin(), border, values.end(), std::greater<>());
    }
    return {std::accumulate(values.begin(), border, 0.0),
            std::accumulate(border, values.end(), 0.0)};
}

bool both_finite(float a, float b)
{
    return std::isfinite(a) && std::isfinite(b);
}

double difference(const PixelPair& pixel)
{
    return static_cast<double>(pixel.tested) - static_cast<double>(pixel.reference);
}

/// x / y where nothing divided by nothing is `none`.
double ratio(double x, double y, double none)
{
    return x == 0.0 && y == 0.0 ? none : x / y;
}

/// Calls f(pixel) for the pixels that are finite in both channels.
template <class F>
void for_each_finite(const ChannelPair& pair, const F& f)
{
    for (int y = 0; y < pair.reference.data.height(); ++y) {
        for (int x = 0; x < pair.reference.data.width(); ++x) {
            const PixelPair pixel{x, y, pair.tested.data.at(x, y), pair.reference.data.at(x, y)};
            if (both_finite(pixel.tested, pixel.reference)) f(pixel);
        }
    }
}

void count_non_finite(const ChannelPair& pair, ChannelMetrics& metrics)
{
    for (size_t i = 0; i < pair.reference.data.size(); ++i) {
        const float a = pair.tested.data.data()[i];
        const float b = pair.reference.data.data()[i];
        if (both_finite(a, b)) continue;
        metrics.non_finite_tested += std::isfinite(a) ? 0 : 1;
        metrics.non_finite_reference += std::isfinite(b) ? 0 : 1;
        const bool same = a == b || (std::isnan(a) && std::isnan(b));
        metrics.non_finite_differing += same ? 0 : 1;
    }
}

/// Means, peak and the epsilon that they give.
void measure_levels(const ChannelPair& pair, const MetricParams& params, ChannelMetrics& metrics)
{
    double magnitude = 0.0;
    for_each_finite(pair, [&](const PixelPair& pixel) {
        ++metrics.pixel_count;
        metrics.mean_tested += static_cast<double>(pixel.tested);
        metrics.mean_reference += static_cast<double>(pixel.reference);
        magnitude += std::abs(static_cast<double>(pixel.reference));
        metrics.peak = std::max(metrics.peak, std::abs(static_cast<double>(pixel.reference)));
    });
    const auto count = static_cast<double>(metrics.pixel_count);
    metrics.mean_tested /= count;
    metrics.mean_reference /= count;
    metrics.mean_ratio = ratio(metrics.mean_tested, metrics.mean_reference, 1.0);
    metrics.epsilon = params.epsilon_share * (magnitude / count) * (magnitude / count);
}

void note_worst(const PixelPair& pixel, int worst_count, std::vector<PixelPair>& worst)
{
    const auto is_worse = [](const PixelPair& a, const PixelPair& b) {
        return std::abs(difference(a)) > std::abs(difference(b));
    };
    if (difference(pixel) == 0.0) return;
    const bool is_full = worst.size() >= static_cast<size_t>(std::max(worst_count, 0));
    if (is_full && (worst.empty() || !is_worse(pixel, worst.back()))) return;
    worst.insert(std::upper_bound(worst.begin(), worst.end(), pixel, is_worse), pixel);
    if (is_full) worst.pop_back();
}

void measure_errors(const ChannelPair& pair, const MetricParams& params, ChannelMetrics& metrics)
{
    std::vector<double> squared;
    std::vector<double> relative;
    squared.reserve(static_cast<size_t>(metrics.pixel_count));
    relative.reserve(static_cast<size_t>(metrics.pixel_count));
    for_each_finite(pair, [&](const PixelPair& pixel) {
        const double error = difference(pixel) * difference(pixel);
        const auto level = static_cast<double>(pixel.reference);
        squared.push_back(error);
        relative.push_back(ratio(error, level * level + metrics.epsilon, 0.0));
        note_worst(pixel, params.worst_count, metrics.worst);
    });
    const auto count = static_cast<double>(metrics.pixel_count);
    const auto dropped = static_cast<size_t>(std::ceil(params.trimmed_share * count));
    const SplitSum squared_sum = split_sum(squared, dropped);
    const SplitSum relative_sum = split_sum(relative, dropped);
    const double total = squared_sum.largest + squared_sum.others;
    metrics.mse = total / count;
    metrics.worst_share = ratio(squared_sum.largest, total, 0.0);
    metrics.rel_mse = (relative_sum.largest + relative_sum.others) / count;
    metrics.rel_mse_trimmed = ratio(relative_sum.others, count - static_cast<double>(dropped), 0.0);
    metrics.psnr = metrics.mse == 0.0
                       ? std::numeric_limits<double>::infinity()
                       : 10.0 * std::log10(metrics.peak * metrics.peak / metrics.mse);
}

void set_undefined(ChannelMetrics& metrics)
{
    for (double* figure :
         {&metrics.mean_tested, &metrics.mean_reference, &metrics.mean_ratio, &metrics.mse,
          &metrics.rel_mse, &metrics.rel_mse_trimmed, &metrics.psnr, &metrics.worst_share}) {
        *figure = not_a_number;
    }
}

bool is_variance(float value)
{
    return std::isfinite(value) && value >= 0.0f;
}

NoiseMetrics measure_noise(const ChannelPair& pair)
{
    NoiseMetrics noise;
    int64_t pixel_count = 0;
    double sum = 0.0;
    double sum_squared = 0.0;
    double sum_reference_variance = 0.0;
    double sum_tested_variance = 0.0;
    for_each_finite(pair, [&](const PixelPair& pixel) {
        const float of_reference = pair.reference_variance->data.at(pixel.x, pixel.y);
        const float of_tested = pair.tested_variance == nullptr
                                    ? 0.0f
                                    : pair.tested_variance->data.at(pixel.x, pixel.y);
        if (!is_variance(of_reference) || !is_variance(of_tested)) {
            ++noise.bad_variances;
            return;
        }
        ++pixel_count;
        sum += difference(pixel);
        sum_squared += difference(pixel) * difference(pixel);
        sum_reference_variance += static_cast<double>(of_reference);
        sum_tested_variance += static_cast<double>(of_tested);
    });
    const auto count = static_cast<double>(pixel_count);
    const double sum_variance = pair.tested_variance == nullptr
                                    ? sum_squared
                                    : sum_reference_variance + sum_tested_variance;
    noise.mse = (sum_squared - sum_reference_variance) / count;
    noise.standard_error = std::sqrt(sum_variance) / count;
    noise.z = ratio(sum / count, noise.standard_error, 0.0);
    return noise;
}

}  // namespace

ChannelMetrics measure_channel(const ChannelPair& pair, const MetricParams& params)
{
    MOTE_ASSERT(pair.tested.data.width() == pair.reference.data.width());
    MOTE_ASSERT(pair.tested.data.height() == pair.reference.data.height());
    MOTE_ASSERT(params.trimmed_share >= 0.0 && params.trimmed_share <= 1.0);
    ChannelMetrics metrics;
    metrics.name = pair.reference.name;
    count_non_finite(pair, metrics);
    measure_levels(pair, params, metrics);
    if (metrics.pixel_count == 0) {
        set_undefined(metrics);
        return metrics;
    }
    measure_errors(pair, params, metrics);
    if (pair.reference_variance != nullptr) metrics.noise = measure_noise(pair);
    return metrics;
}

}  // namespace mote
