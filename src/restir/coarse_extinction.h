#pragma once

#include <vector>

#include "restir/smoke_cells.h"

namespace mote {

/// Mean extinction of all media on a lattice, and on coarser ones above it: approximate optical
/// depths in constant time. Only for weights of samples, never for their values.
struct CoarseExtinction {
    struct Level {
        Vec3i count{0};
        std::vector<float> sigma_t;  ///< [1/m]; x fastest
    };
    Lattice lattice;  ///< of the finest level; a cell of level k is 2^k times as wide
    std::vector<Level> levels;
};

/// Means over the smoke cells, from 8 lookups per cell and volume (27 in wide cells), at the
/// middle of the shutter.
[[nodiscard]] CoarseExtinction make_coarse_extinction(const Media& media, const SmokeCells& cells);

/// Approximate optical depth between two world points, one of them in the lattice. Cost: at most
/// `most_steps` lookups, on the level that is as fine as that allows.
[[nodiscard]] float coarse_optical_depth(const CoarseExtinction& extinction, Vec3 from, Vec3 to,
                                         int most_steps = 12);

}  // namespace mote
