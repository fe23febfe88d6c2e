#pragma once

namespace mote {

/// Steps and grid of the ray marcher, the baseline of `mote bench`; finer ones are less biased.
struct MarchParams {
    float step = 1.0f;            ///< along camera rays [finest voxels]
    float shadow_spacing = 2.0f;  ///< of the shadow grid's nodes [finest voxels]; grows with budget
    int node_budget = 2'000'000;  ///< nodes times lights, 4 bytes each
    int sky_bands = 4;            ///< the sky is this many bands of twice as many directions
};

}  // namespace mote
