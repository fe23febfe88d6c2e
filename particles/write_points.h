#pragma once

#include <string>

#include "particles/particle_set.h"

namespace mote {

/// Writes particles as one OpenVDB PointDataGrid "particles", uncompressed in value (Blosc in the
/// file): P, and where the set has them v [m/s], pscale [m], mass [kg], temperature [K], Cd, id,
/// age [s]. Reading the file back gives the same numbers, positions to float rounding, in another
/// order. Writes exactly this path, not atomically: rename it afterwards.
/// Throws Error(Output) naming the path.
void write_points(const std::string& path, const ParticleSet& particles);

}  // namespace mote
