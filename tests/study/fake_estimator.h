#pragma once

#include <cmath>

#include "core/rng.h"
#include "image/layers.h"

namespace mote::test {

/// An estimator of a known picture, one run per seed: R, G, B of 24 x 16 pixels that brighten to
/// the right, with noise as skewed as that of light paths, part of it common to pixels and
/// channels, and alpha of the upper half that comes from one sample in hundreds.
struct FakeEstimator {
    double scale = 1.0;         ///< of the whole picture; 1: unbiased
    double corner_scale = 1.0;  ///< of the 8 x 8 pixels at the lower right
    double noise = 1.0;         ///< of a pixel, relative
    double rare_chance = 2e-3;  ///< of a sample of the upper half to have alpha
    int alpha_samples = 1;      ///< per pixel
    int width = 24;
    int height = 16;

    [[nodiscard]] LayeredImage operator()(uint32_t seed) const
    {
        LayeredImage image;
        image.width = width;
        image.height = height;
        for (const char* name : {"R", "G", "B", "A"}) {
            image.channels.push_back({name, PixelType::Float, Buffer2D<float>(width, height)});
        }
        Rng shared(seed, 1, Stream::Test, 0, 0);
        const double run_error = 0.02 * std::sqrt(12.0) * (double{shared.uniform()} - 0.5);
        for (int y = 0; y < height; ++y) {
            Rng rng(seed, 0, Stream::Test, static_cast<uint32_t>(y), 0);
            for (int x = 0; x < width; ++x) {
                const bool in_corner = x >= width - 8 && y >= height - 8;
                const double expected =
                    (1.0 + x) / width * scale * (in_corner ? corner_scale : 1.0);
                const double path = exponential(rng);
                for (size_t c = 0; c < 3; ++c) {
                    const double deviation = 0.5 * (path + exponential(rng)) - 1.0;
                    image.channels[c].data.at(x, y) =
                        static_cast<float>(expected * (1.0 + run_error + noise * deviation));
                }
                const double chance = y < 8 ? rare_chance : 0.5;
                float hits = 0.0f;
                for (int i = 0; i < alpha_samples; ++i) {
                    hits += double{rng.uniform()} < chance ? 1.0f : 0.0f;
                }
                image.channels[3].data.at(x, y) = hits / static_cast<float>(alpha_samples);
            }
        }
        return image;
    }

  private:
    static double exponential(Rng& rng) { return -std::log1p(-double{rng.uniform()}); }
};

}  // namespace mote::test
