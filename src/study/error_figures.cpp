#include "study/error_figures.h"

#include "image/color.h"
#include "runs/run_error.h"

namespace mote {

namespace {

constexpr int longest_lag = 8;

void add_share(ErrorSplit& sum, const ErrorSplit& part, double share)
{
    sum.bias_squared += share * part.bias_squared;
    sum.noise += share * part.noise;
    sum.variance += share * part.variance;
}

Buffer2D<double> luminance_error(const Buffer2D<Spectrum>& image, const PixelStats& reference)
{
    Buffer2D<double> error(image.width(), image.height());
    for (size_t i = 0; i < image.size(); ++i) {
        error.data()[i] = double{luminance(image.data()[i] - reference.mean.data()[i])};
    }
    return error;
}

/// Mean product of errors `lag` pixels apart, along rows and columns.
double covariance_at(const Buffer2D<double>& error, int lag)
{
    double sum = 0.0;
    int64_t count = 0;
    const auto add = [&](int x, int y, int other_x, int other_y) {
        if (other_x >= error.width() || other_y >= error.height()) return;
        sum += error.at(x, y) * error.at(other_x, other_y);
        ++count;
    };
    for (int y = 0; y < error.height(); ++y) {
        for (int x = 0; x < error.width(); ++x) {
            add(x, y, x + lag, y);
            add(x, y, x, y + lag);
        }
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

void measure_single_runs(const Study& study, ErrorFigures& figures)
{
    figures.single_runs = static_cast<int>(study.kept.size());
    std::vector<double> covariances(longest_lag + 1, 0.0);
    for (Buffer2D<Spectrum> image : study.kept) {
        replace_non_finite(image);
        const RunError error = measure_error(image, study.reference_mean);
        figures.rel_mse += error.rel_mse / figures.single_runs;
        figures.trimmed_rel_mse += error.trimmed_rel_mse / figures.single_runs;
        figures.worst_share += error.worst_share / figures.single_runs;
        const Buffer2D<double> errors = luminance_error(image, study.reference_mean);
        for (int lag = 0; lag <= longest_lag; ++lag) {
            covariances[static_cast<size_t>(lag)] += covariance_at(errors, lag);
        }
    }
    if (!(covariances[0] > 0.0)) return;
    for (const double covariance : covariances) {
        figures.autocovariance.push_back(covariance / covariances[0]);
    }
}

}  // namespace

ErrorFigures measure_errors(const Study& study)
{
    ErrorFigures figures;
    figures.epsilon = relative_epsilon(study.reference_mean);
    for (const char* channel : {"R", "G", "B"}) {
        add_share(figures.absolute,
                  split_error(study.tested_pixels, study.reference_pixels, channel), 1.0 / 3.0);
        add_share(figures.relative,
                  split_relative_error(study.tested_pixels, study.reference_pixels, channel,
                                       figures.epsilon),
                  1.0 / 3.0);
    }
    measure_single_runs(study, figures);
    return figures;
}

}  // namespace mote
