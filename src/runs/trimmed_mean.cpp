#include "runs/trimmed_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"

namespace mote {

std::vector<bool> worst_pixels(std::span<const double> values, double share)
{
    std::vector<bool> is_worst(values.size(), false);
    const auto wanted = static_cast<size_t>(std::ceil(share * static_cast<double>(values.size())));
    const size_t count = std::min(wanted, values.size());
    if (count == 0) return is_worst;
    std::vector<size_t> order(values.size());
    std::iota(order.begin(), order.end(), size_t{0});
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(count) - 1;
    std::nth_element(order.begin(), last, order.end(),
                     [&](size_t a, size_t b) { return values[a] > values[b]; });
    for (size_t i = 0; i < count; ++i) is_worst[order[i]] = true;
    return is_worst;
}

double trimmed_mean(std::span<const double> values, const std::vector<bool>& left_out)
{
    MOTE_ASSERT(values.size() == left_out.size());
    double sum = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        if (left_out[i]) continue;
        sum += values[i];
        ++count;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

double median(std::vector<double> values)
{
    const auto is_nan = [](double x) { return std::isnan(x); };
    if (values.empty() || std::any_of(values.begin(), values.end(), is_nan)) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    std::sort(values.begin(), values.end());
    const size_t middle = values.size() / 2;
    if (values.size() % 2 == 1) return values[middle];
    return 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace mote
