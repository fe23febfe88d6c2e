#pragma once

#include "particles/particle_set.h"
#include "particles/source.h"

namespace mote {

/// Particles of a built-in emitter at `time_s` [s]: a pure function of (params, time), computed
/// without any other frame. Empty before params.start_time. All attributes in `mask` are filled,
/// velocity is the time derivative of position. Parallel, bit-identical for any thread count.
/// Throws Error(Input) naming the parameter that is out of range.
[[nodiscard]] ParticleSet emit_particles(const EmitterParams& params, double time_s,
                                         const AttributeMask& mask = {});

}  // namespace mote
