#pragma once

#include "volumes/ray_bins.h"

namespace mote {

/// make_ray_bins through one medium that is not void, rays side by side.
void bin_batch(const Volume& volume, std::span<const BinQuery> queries, float cut,
               BinCounts& counts);

}  // namespace mote
