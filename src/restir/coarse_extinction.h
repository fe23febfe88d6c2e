#pragma once

#include <vector>

#include "core/float8.h"
#include "restir/smoke_cells.h"

namespace mote {

/// Mean extinction of all media on a lattice, and on coarser ones above it: approximate optical
/// depths in constant time. Only for weights of samples, never for their values.
struct CoarseExtinction {
    static constexpr int most_levels = 8;

    Lattice lattice;  ///< of the finest level; a cell of level k is 2^k times as wide
    int level_count = 0;
    int32_t first[most_levels]{};  ///< of each level in sigma_t
    int32_t row[most_levels]{};    ///< cells along x
    int32_t slice[most_levels]{};  ///< cells in x and y
    std::vector<float> sigma_t;    ///< [1/m]; x fastest
};

/// Means over the smoke cells, from 8 lookups per cell and volume (27 in wide cells), at the
/// middle of the shutter.
[[nodiscard]] CoarseExtinction make_coarse_extinction(const Media& media, const SmokeCells& cells);

/// Approximate optical depths between one point, moved into the lattice if outside, and eight
/// others anywhere, by `steps` lookups each on the level whose cells are about as long as a step.
void coarse_optical_depths(const CoarseExtinction& extinction, Vec3 from, const Float8& x,
                           const Float8& y, const Float8& z, int steps, Float8& tau);

}  // namespace mote
