#pragma once

#include <cstdint>
#include <vector>

#include "restir/lattice.h"
#include "volumes/tracking.h"

namespace mote {

/// Where there is smoke, on a lattice over all media. Volumes that move are taken over the whole
/// shutter.
struct SmokeCells {
    enum Mark : uint8_t { Empty, Border, Smoke };

    Lattice lattice;          ///< at least one Empty or Border cell wide around all Smoke cells
    std::vector<Mark> marks;  ///< Border: empty, but next to smoke (26 neighbours)
    size_t smoke_count = 0;
    size_t border_count = 0;
};

/// Cells of about `edge_voxels` voxels of the finest volume, larger where there would be more than
/// `most_cells` with smoke or border, or 32 times as many in all. Cells line up with the bricks of
/// the first volume if that is not rotated. Empty without smoke.
[[nodiscard]] SmokeCells find_smoke_cells(const Media& media, float edge_voxels, size_t most_cells);

}  // namespace mote
