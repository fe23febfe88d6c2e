#pragma once

#include <openvdb/openvdb.h>

#include "volumes/grid_source.h"

namespace mote {

/// Samples an analytic shape, centred at the object's origin, into a fog volume named "density".
/// `time_s` moves the noise by params.evolve. The grid depends on (params, time_s) alone.
/// Throws Error(Input) for parameters out of range, Error(Memory) above budget.max_voxels.
[[nodiscard]] openvdb::FloatGrid::Ptr make_procedural(const ProceduralParams& params, double time_s,
                                                      const GridBudget& budget = {});

}  // namespace mote
