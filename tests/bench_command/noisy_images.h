#pragma once

#include <cmath>

#include "core/rng.h"
#include "runs/pixel_stats.h"

namespace mote {

/// An image of one value plus uniform noise of this variance, independent in pixels and channels.
inline Buffer2D<Spectrum> noisy_image(int width, int height, float value, double variance,
                                      uint32_t seed)
{
    Buffer2D<Spectrum> image(width, height);
    const auto half_width = static_cast<float>(std::sqrt(3.0 * variance));
    Rng rng(seed, 0, Stream::Test, 0, 0);
    for (Spectrum& pixel : image) {
        pixel = Spectrum(value) + half_width * (2.0f * rng.uniform3() - Spectrum(1.0f));
    }
    return image;
}

/// Statistics of `runs` such images.
inline PixelStats noisy_runs(int width, int height, float value, double variance, int runs,
                             uint32_t seed)
{
    PixelStats stats;
    for (int k = 0; k < runs; ++k) {
        add_run(stats,
                noisy_image(width, height, value, variance, seed + static_cast<uint32_t>(k)));
    }
    return stats;
}

}  // namespace mote
