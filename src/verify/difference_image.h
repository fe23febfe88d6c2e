#pragma once

#include <span>

#include "core/buffer2d.h"
#include "core/math.h"
#include "image/layers.h"
#include "verify/compare_images.h"

namespace mote {

/// tested - reference of every compared channel, as 32-bit floats. Pixels that are equal are 0 even
/// where both are infinite; NaN stays NaN.
[[nodiscard]] LayeredImage difference_image(const LayeredImage& tested,
                                            const LayeredImage& reference,
                                            std::span<const LayerMetrics> layers);

/// Display colour in [0,1] of a signed value: white 0, red positive, blue negative, full colour
/// from
/// +-full_scale on, green not finite.
[[nodiscard]] Spectrum signed_colour(double value, double full_scale);

/// A picture of one layer's signed relative difference, mean over its channels of
/// (tested - reference) / sqrt(reference^2 + epsilon). Display colours in [0,1]: white 0, red
/// brighter than the reference, blue darker, full colour at +-full_scale, green not finite.
[[nodiscard]] Buffer2D<Spectrum> false_colour(const LayeredImage& tested,
                                              const LayeredImage& reference,
                                              const LayerMetrics& layer, double full_scale);

}  // namespace mote
