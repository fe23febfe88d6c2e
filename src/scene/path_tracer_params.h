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

/// Which rays find the lights. Point and distant lights always take shadow rays.
enum class LightStrategy {
    Auto,       ///< Mis, but a constant environment through scattered rays alone: cheapest
    Mis,        ///< shadow rays and scattered rays, weighted against each other
    NextEvent,  ///< shadow rays alone
    Phase,      ///< scattered rays alone
};

/// Weights between two ways to sample the same path. Veach and Guibas 1995.
enum class MisHeuristic { Power, Balance };

/// How the path tracer samples; every choice is unbiased and only moves variance and cost.
struct PathTracerParams {
    int max_bounces = 1;     ///< scattering events of a path, [0, 10^6]; 1 = single scattering
    int roulette_start = 4;  ///< events before Russian roulette may end a path
    TransmittanceKind transmittance = TransmittanceKind::ResidualRatio;  ///< of shadow rays
    LightSamplerKind light_sampler = LightSamplerKind::Auto;
    LightStrategy light_strategy = LightStrategy::Auto;
    MisHeuristic mis = MisHeuristic::Power;
    bool equiangular =
        false;  ///< add equiangular distances by MIS: point and sphere lamps, first event
};

}  // namespace mote
