#pragma once

#include <span>
#include <vector>

#include "core/rng.h"
#include "multiscatter/mean_radiance.h"
#include "multiscatter/path_vertex.h"
#include "reference/trace_context.h"
#include "restir/coarse_extinction.h"
#include "volumes/depth_batch.h"

namespace mote {

/// How far paths are shared. Any values are unbiased.
struct PathSharing {
    int group_size = 64;  ///< vertices that share their paths; a quarter where there are surfaces
    int levels = 2;  ///< of vertices, from the first ones on; behind them each has its own path
    float near_share = 0.25f;  ///< places near lamps that are looked at besides, per path
    const MeanRadiance* known = nullptr;  ///< what is not shared, as it is known; null: nothing
    const MeanRadiance* guide = nullptr;  ///< what first events are drawn by; null: by what
                                          ///< collides. Read where they are drawn.
};

/// How far sharing pays. Where walks are long (`mean_events`) and lobes narrow, so that few of a
/// group look at what one of them finds: twice the group and a third level. Measured, variance
/// times time, 128 x 72 pixels cut out of 1280 x 720: cloud of optical depth 40, albedo 0.999,
/// g = 0.85: 0.69; but with g = 0: 1.1, with albedo 0.95: 1.4.
[[nodiscard]] PathSharing sharing_for(const Media& media, float mean_events);

/// Light scattered twice and more, at the scattering events on the rays of a tile's pixels. Each
/// vertex sends one path on to a second one; vertices close together form groups, and all of a
/// group take the light that any of their paths finds, in proportion to how likely they would have
/// found it themselves. The same once more from the second vertices (and the third, if levels is
/// 3), and then the path tracer.
/// Added to light[v.from], times v.weight; to `cut`, what the paths had left when max_bounces cut
/// them (see PathResult), so weighted. Unbiased given the first vertices, whatever they are.
///
/// What ReSTIR's spatial reuse of suffixes does with reservoirs (Lin et al. 2021, 2022), for whole
/// groups at once, with all samples instead of one; Deng et al. 2021 ("Path Graphs") gather alike,
/// but iterate to a biased fixed point. Precondition: is_still_but_for_camera, as the events'
/// rays may belong to different times. Cost: for each first vertex a path and about 5 ns for each
/// of the group. Memory: about 1 KB per first vertex of tiles under way, twice that if groups are
/// of 128.
void share_paths(const TraceContext& context, const CoarseExtinction& extinction,
                 const PathSharing& sharing, std::vector<PathVertex> first, Rng& rng,
                 std::span<Spectrum> light, WalkCounts& counts, float& cut);

}  // namespace mote
