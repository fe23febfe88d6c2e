#include "runs/run_error.h"

#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "runs/trimmed_mean.h"
#include "verify/metrics.h"

namespace mote {

namespace {

/// Squared errors per pixel, mean over channels: as seen, and without the reference's noise.
struct PixelErrors {
    std::vector<double> seen;
    std::vector<double> corrected;
};

double squared_mean(const PixelStats& reference)
{
    return reference.image_means.mean * reference.image_means.mean;
}

/// Each channel's error is divided by weight_of(reference value).
template <class WeightOf>
PixelErrors pixel_errors(const Buffer2D<Spectrum>& image, const PixelStats& reference,
                         WeightOf weight_of)
{
    PixelErrors errors;
    errors.seen.reserve(image.size());
    errors.corrected.reserve(image.size());
    for (size_t i = 0; i < image.size(); ++i) {
        const Spectrum noise = variance_of_mean(reference, i);
        double seen = 0.0;
        double expected = 0.0;
        for (int c = 0; c < 3; ++c) {
            const double truth = double{reference.mean.data()[i][c]};
            const double difference = double{image.data()[i][c]} - truth;
            const double weight = weight_of(truth) / 3.0;
            seen += weight * difference * difference;
            expected += weight * double{noise[c]};
        }
        errors.seen.push_back(seen);
        errors.corrected.push_back(seen - expected);
    }
    return errors;
}

/// Full and trimmed mean. Trimmed are the pixels of largest error as seen: the correction is the
/// same for every method and must not choose them.
std::pair<double, double> both_means(const PixelErrors& errors)
{
    const double full = trimmed_mean(errors.corrected, worst_pixels(errors.seen, 0.0));
    return {full, trimmed_mean(errors.corrected, worst_pixels(errors.seen, trimmed_share))};
}

}  // namespace

double relative_epsilon(const PixelStats& reference)
{
    return MetricParams{}.epsilon_share * squared_mean(reference);
}

RunError measure_error(const Buffer2D<Spectrum>& image, const PixelStats& reference)
{
    MOTE_ASSERT(reference.run_count >= 2 && reference.image_means.mean != 0.0);
    MOTE_ASSERT(image.width() == reference.mean.width());
    MOTE_ASSERT(image.height() == reference.mean.height());
    const double scale = 1.0 / squared_mean(reference);
    const double epsilon = relative_epsilon(reference);
    RunError result;
    const PixelErrors absolute = pixel_errors(image, reference, [&](double) { return scale; });
    std::tie(result.mse, result.trimmed_mse) = both_means(absolute);
    const PixelErrors relative = pixel_errors(
        image, reference, [&](double truth) { return 1.0 / (truth * truth + epsilon); });
    std::tie(result.rel_mse, result.trimmed_rel_mse) = both_means(relative);
    if (result.mse > 0.0) {
        const double kept = static_cast<double>(image.size()) -
                            std::ceil(trimmed_share * static_cast<double>(image.size()));
        const double all = static_cast<double>(image.size()) * result.mse;
        result.worst_share = 1.0 - result.trimmed_mse * kept / all;
    }
    return result;
}

double reference_noise(const PixelStats& reference)
{
    return mean_variance(reference) / (reference.run_count * squared_mean(reference));
}

}  // namespace mote
