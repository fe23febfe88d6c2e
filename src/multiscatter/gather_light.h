#pragma once

#include "core/rng.h"
#include "multiscatter/path_level.h"

namespace mote {

/// Takes in the light that a level's paths have found. First vertices (`light` not empty) add what
/// all of it brings to light[v.from], others keep one arrival, drawn in proportion to what each
/// would bring: resampled importance sampling (Talbot et al. 2005) with the sum known.
///
/// Kernels assume transmittances. The difference to the true ones is estimated by one exact ray per
/// vertex, towards the sample that was drawn, so that nothing is biased; where the two agree there
/// is no noise either. Cost: a ray per vertex.
void gather_light(const SharingContext& context, PathLevel& level, const PathLevel& next, Rng& rng,
                  std::span<Spectrum> light);

}  // namespace mote
