#pragma once

#include "volumes/tracking.h"

namespace mote {

/// How a light is chosen for next-event estimation.
enum class LightSamplerKind {
    Auto,           ///< one light: none of them; few: PowerDistance; many: Tree
    Power,          ///< alias table on emitted power
    PowerDistance,  ///< power over squared distance, evaluated per light: O(lights)
    Tree,           ///< light tree over power, distance and bounds
};

/// How the path tracer samples; every choice is unbiased and only moves variance and cost.
struct PathTracerParams {
    int max_bounces = 1;     ///< scattering events of a path, [0, 10^6]; 1 = single scattering
    int roulette_start = 4;  ///< events before Russian roulette may end a path
    TransmittanceKind transmittance = TransmittanceKind::Ratio;  ///< of shadow rays
    LightSamplerKind light_sampler = LightSamplerKind::Auto;
    bool equiangular = false;  ///< add equiangular distances by MIS (near lights, first event)
};

}  // namespace mote
