#pragma once

#include "core/rng.h"
#include "restir/pixel_domain.h"

namespace mote {

/// Unbiased estimate of the light that media emit straight towards the camera on a binned ray. Of
/// what follows the density (black bodies) each bin shows the exact share T_k - T_{k+1}, of the
/// source function at a free flight in that bin: without noise where the source is constant. Of
/// emission grids a lookup every two cells, with exact transmittance.
[[nodiscard]] Spectrum emission_along(const FrameDomain& frame, const PixelDomain& domain,
                                      Rng& rng);

}  // namespace mote
