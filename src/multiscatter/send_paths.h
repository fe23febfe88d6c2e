#pragma once

#include "core/rng.h"
#include "multiscatter/path_level.h"

namespace mote {

/// Sends paths from the vertices of a level, one each on average, of first ones (`is_first`) more
/// where their weight is larger. What they find goes to `next`, each vertex lit by a shadow ray;
/// what later vertices' own rays see on the way arrives there. Surfaces are lit to the end.
/// `event_count`: events up to this level's vertices.
///
/// With share_k of the group's n paths leaving from vertex k, a path finds y with the density
/// n sum_k share_k K_k(y), whichever vertex it left from. So the kernel of vertex i,
///     a_i(y) = K_i(y) / (n sum_k share_k K_k(y)),
/// makes sum_y a_i(y) S(y -> i) an unbiased estimate of the light that i scatters from all of
/// space, if K is the true density of i's paths: the balance heuristic (Veach 1997) between all
/// vertices of a group, "reconnection" in Lin et al. 2022. Transmittances in K are assumed ones.
/// That leaves the factor (T_i / assumed_i) (assumed_k / T_k) to be made good; see gather_light.
///
/// Of S, what is known beforehand (C: isotropic, of a place alone) is not shared: of each vertex on
/// the way S - C is, and C goes to the vertex before by its own path, where it has weight 1. A
/// control variate: sum_y a_i(y) is 1 in the mean only, and S varies less than its mean.
void send_paths(const SharingContext& context, int event_count, bool is_first, PathLevel& level,
                PathLevel& next, Rng& rng);

/// Follows what a vertex scatters to the end, by the path tracer: arrives at the vertex.
void follow_own_path(const SharingContext& context, const ScatterEvent& event, int event_count,
                     PathVertex& v, Rng& rng);

}  // namespace mote
