#pragma once

#include <memory>
#include <string>

#include <openvdb/openvdb.h>

#include "volumes/bricks.h"
#include "volumes/grid_source.h"

namespace mote {

/// The grid's transform: index coordinates -> object space [m]. Throws Error(Input) naming the
/// grid for frustum, singular and non-finite transforms.
[[nodiscard]] Mat4d object_from_index(const openvdb::GridBase& grid);

/// Render-time bricks of a fog volume. Inactive voxels count as 0 whatever the grid's background;
/// NaN, infinite and negative values become 0 and are counted in `report` (counts are added).
/// Parallel; bit-identical for any thread count. Tiles cost table entries, not voxels.
/// Throws Error(Memory) naming the grid if the result would be over the budget, Error(Input) for
/// level sets, frustum and degenerate transforms.
[[nodiscard]] std::shared_ptr<const BrickGrid> make_bricks(const openvdb::FloatGrid& grid,
                                                           const GridBudget& budget,
                                                           GridLoadReport& report);

/// The same for vectors: NaN and infinite components become 0; negative ones are kept (velocity).
/// Inactive voxels beside active ones take the mean of their active neighbours, so that the edge of
/// the cloud keeps its colour and velocity instead of fading to 0.
[[nodiscard]] std::shared_ptr<const ColorGrid> make_color_bricks(const openvdb::Vec3SGrid& grid,
                                                                 const GridBudget& budget,
                                                                 GridLoadReport& report);

}  // namespace mote
