#pragma once

#include "core/math.h"

namespace mote {

/// Colour of a black body of temperature T [K] in linear Rec. 709, of luminance 1 and without
/// negative components (hues outside the gamut, below about 1900 K, are clamped to it). Held
/// constant below 500 K. From a table in 1/T; relative error below 1e-3.
[[nodiscard]] Spectrum blackbody_rgb(float temperature);

/// The same from Planck's law, integrated each time. Matching functions: the fit of Wyman, Sloan
/// and Shirley 2013 (multi-lobe), good to 0.003 in chromaticity. Cost: about 20 us.
[[nodiscard]] Spectrum blackbody_rgb_exact(double temperature);

}  // namespace mote
