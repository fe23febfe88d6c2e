#pragma once

#include "core/parallel.h"
#include "restir/combine.h"
#include "restir/reproject.h"

namespace mote {

/// Reservoirs of a pass under way and what they live in: read by the passes below, never written.
struct PassView {
    const FrameDomain& frame;
    const DomainStore& domains;
    const Buffer2D<PixelReservoir>& reservoirs;
};

/// Random numbers of a pixel for one purpose.
using PixelRng = std::function<Rng(int x, int y)>;

/// Where a reuse pass writes: the pixels of its tile, in both.
struct ReuseOutput {
    Buffer2D<PixelReservoir>& reservoirs;
    Buffer2D<Spectrum>& colors;  ///< radiance of the sampled lights
};

/// Combines each pixel of a tile with the pixel it was in the pass before (or in the frame before,
/// by motion), whose confidence is capped and scaled by profile_agreement. Reads frozen buffers, so
/// the result does not depend on tile order. Unbiased for any change of camera, media and lights:
/// the earlier domain is evaluated as it was. `still`: nothing changed.
void reuse_in_time(const PassView& pass, const FinishedPass& before, bool still, const Tile& tile,
                   const PixelRng& rng, Combination& scratch, const ReuseOutput& out,
                   WalkCounts& counts);

/// Combines each pixel of a tile with neighbours in a disk, a spiral turned at random for each
/// pixel and pass; rays without smoke are passed over. out must not be pass.reservoirs (asserted).
void reuse_in_space(const PassView& pass, const Tile& tile, const PixelRng& rng,
                    Combination& scratch, const ReuseOutput& out, WalkCounts& counts);

/// The rules that the frame's parameters stand for.
[[nodiscard]] CombineRules temporal_rules(const RestirParams& params, bool still);
[[nodiscard]] CombineRules spatial_rules(const RestirParams& params);

}  // namespace mote
