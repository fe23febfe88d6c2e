#pragma once

#include "runs/pixel_stats.h"

namespace mote {

/// Share of the pixels that trimmed figures leave out: those that err most in the run at hand.
inline constexpr double trimmed_share = 1e-3;

/// Squared errors of one image, averaged over pixels and channels. The noise of the reference is
/// subtracted, so that mse is unbiased, and may fall below 0 where the reference is the noisier
/// one. rel_mse divides by the reference itself, so it needs one that is accurate in every pixel.
struct RunError {
    double mse = 0.0;          ///< over the square of the reference's mean: its nVar if unbiased
    double trimmed_mse = 0.0;  ///< without the worst trimmed_share of the pixels
    double rel_mse = 0.0;      ///< each pixel's over reference^2 + epsilon
    double trimmed_rel_mse = 0.0;
    double worst_share = 0.0;  ///< share of mse in the pixels that trimmed_mse leaves out
};

/// Constant under the relative error: 0.01 times the squared mean of the reference, as in
/// MetricParams. [radiance^2]
[[nodiscard]] double relative_epsilon(const PixelStats& reference);

/// Errors of an image against the mean of the reference's runs (>= 2, asserted), whose mean must
/// not be 0 (asserted).
[[nodiscard]] RunError measure_error(const Buffer2D<Spectrum>& image, const PixelStats& reference);

/// Mean variance of the reference's mean, in the unit of RunError::mse: what was subtracted.
[[nodiscard]] double reference_noise(const PixelStats& reference);

}  // namespace mote
