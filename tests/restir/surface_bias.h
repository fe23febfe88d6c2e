#pragma once

#include <array>
#include <string>

#include "restir/reuse_runs.h"

namespace mote::test {

/// Mean over an image's pixels of the bias squared, of the image's mean luminance squared [%^2].
/// Unbiased, so it may be below 0.
struct SquaredBias {
    double mean = 0.0;
    double error = 0.0;

    [[nodiscard]] double root() const { return std::sqrt(std::max(mean, 0.0)); }
};

/// What reuse adds to the surfaces' direct light of the same candidates without it, which has the
/// right mean (see SurfaceReuseStat), in percent of the image's mean luminance.
struct SurfaceBias {
    double mean = 0.0;  ///< of the whole image's luminance
    double mean_error = 0.0;
    SquaredBias pixel;  ///< of luminance
    SquaredBias color;  ///< of red, green and blue
    double rays = 0.0;  ///< towards lights, per pixel of the last frame

    [[nodiscard]] std::string row(const std::string& name) const;
};

/// Plays the frames `runs` times (a multiple of 10), with and without reuse.
[[nodiscard]] SurfaceBias measure_surface_bias(const std::vector<Scene>& frames,
                                               const FrameCaches& caches,
                                               const RestirParams& params, int runs);

}  // namespace mote::test
