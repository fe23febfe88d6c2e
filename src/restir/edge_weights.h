#pragma once

#include "core/float8.h"
#include "volumes/ray_bins.h"

namespace mote {

/// What light scattered in at each edge of a ray's bins counts with in the ray's integral
///     sum over bins of  integral T sigma_t [S_k + (S_{k+1} - S_k) (tau - tau_k) / D_k] dt
///     = sum over edges of  of[k] S_k:
/// the closed form for in-scatter that runs linearly in optical depth between edges.
struct EdgeWeights {
    static constexpr int capacity = (RayBins::capacity / lane_count + 1) * lane_count;
    static_assert(capacity > RayBins::capacity);

    alignas(32) float of[capacity];  ///< [0, bins.count]
};

/// Precondition: the bins are not empty. Exact up to float rounding, for any depths. Cost: eight
/// bins side by side, two exponentials each.
void weigh_edges(const RayBins& bins, EdgeWeights& out);

}  // namespace mote
