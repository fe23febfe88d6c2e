#pragma once

#include <array>
#include <vector>

#include "multiscatter/sh_basis.h"
#include "reference/scatter_event.h"
#include "reference/trace_context.h"
#include "restir/smoke_lattice.h"

namespace mote {

/// What arrives at the nodes of a lattice having scattered at least once, from all directions, in
/// spherical harmonics: a rough guess of the light of many events, of one time while the shutter is
/// open, for estimators that are right whatever it says. 108 bytes per node.
struct RadianceCache {
    using Node = std::array<Spectrum, sh_count>;

    SmokeLattice lattice;
    std::vector<Node> incident;  ///< per slot [W/(m^2 sr)]; slot 0 is black
    float mean_events = 0.0f;    ///< in media, of walks that start in them; an estimate
    double cpu_seconds = 0.0;
};

/// How much is spent on a cache.
struct RadianceCacheParams {
    int directions = 32;  ///< per node, a path each
    int nodes = 4096;     ///< at most
    uint32_t seed = 0;
};

/// One part in `share` of what a frame spends that traces so many paths for its pixels: few nodes
/// for small ones.
[[nodiscard]] RadianceCacheParams share_of_paths(int64_t paths, int share, uint32_t seed);

/// Traces the nodes' paths, in parallel. max_bounces counts from a node as from a pixel's first
/// event.
[[nodiscard]] RadianceCache make_radiance_cache(const TraceContext& context,
                                                const RadianceCacheParams& params);

/// Light scattered twice and more that an event in a medium sends towards event.wo as far as the
/// cache knows, albedo left out: at least 0. Trilinear between active nodes; Henyey and Greenstein
/// scale order l by g^l (Funk-Hecke).
[[nodiscard]] Spectrum eval_cached_light(const RadianceCache& cache, const ScatterEvent& event);

}  // namespace mote
