#pragma once

#include "volumes/bricks.h"

namespace mote {

/// Writes -k into the empty entries of grid.table, k the distance in bricks (largest of the three
/// axes) to the nearest brick that is not empty, at most 16: a ray there may advance to the border
/// of the cube of (2k-1)^3 positions around it at once. Three separable passes, O(table).
void set_skip_distances(BrickGrid& grid);

}  // namespace mote
