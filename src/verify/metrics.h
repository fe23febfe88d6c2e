#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "image/layers.h"

namespace mote {

struct MetricParams {
    double epsilon_share = 1e-2;  ///< relMSE adds this times mean(|reference|)^2 to reference^2
    double trimmed_share = 1e-3;  ///< pixels that trimmed figures drop, rounded up to whole ones
    int worst_count = 3;          ///< pixels listed per channel
};

/// One pixel of one channel, origin top-left.
struct PixelPair {
    int x = 0;
    int y = 0;
    float tested = 0.0f;
    float reference = 0.0f;
};

/// What a reference's variance layer (variance of the mean, per pixel) says about the differences.
struct NoiseMetrics {
    /// MSE without the reference's share: minus its mean variance. Below 0 when within the noise.
    double mse = 0.0;
    /// Of the mean difference, for noise that is independent between pixels. From the variance
    /// layers of both images; if the tested one has none, from the squared differences, which
    /// without bias hold the noise of both.
    double standard_error = 0.0;
    double z = 0.0;             ///< mean difference over its standard error
    int64_t bad_variances = 0;  ///< pixels left out: variance negative or not finite
};

/// Errors of one channel. Sums run over the pixels that are finite in both images; the others are
/// counted. Without any such pixel the figures are NaN.
struct ChannelMetrics {
    std::string name;
    int64_t pixel_count = 0;        ///< finite in both images
    int64_t non_finite_tested = 0;  ///< NaN or infinite
    int64_t non_finite_reference = 0;
    int64_t non_finite_differing = 0;  ///< not finite in one image, and not the same in the other
    double mean_tested = 0.0;
    double mean_reference = 0.0;
    double mean_ratio = 1.0;       ///< tested over reference; not 1: light was lost or gained
    double mse = 0.0;              ///< mean of (tested - reference)^2
    double epsilon = 0.0;          ///< of the relative errors, see MetricParams
    double rel_mse = 0.0;          ///< mean of (tested - reference)^2 / (reference^2 + epsilon)
    double rel_mse_trimmed = 0.0;  ///< without the pixels of largest relative error
    double peak = 0.0;             ///< largest |reference|
    double psnr = 0.0;             ///< 10 log10(peak^2 / mse) [dB]; infinite for equal images
    double worst_share = 0.0;      ///< share of the squared error in the worst trimmed_share pixels
    std::vector<PixelPair> worst;  ///< of largest squared error, largest first; none of error 0
    std::optional<NoiseMetrics> noise;  ///< if the reference has a variance of this channel
};

/// One channel of two images of the same size, and its variances where known.
struct ChannelPair {
    const Channel& tested;
    const Channel& reference;
    const Channel* tested_variance = nullptr;     ///< of the mean, per pixel
    const Channel* reference_variance = nullptr;  ///< of the mean, per pixel
};

[[nodiscard]] ChannelMetrics measure_channel(const ChannelPair& pair, const MetricParams& params);

}  // namespace mote
