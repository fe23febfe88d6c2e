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

/// Reservoirs that took part.
struct ReuseCounts {
    int64_t histories = 0;
    int64_t neighbours = 0;
};

/// Reservoirs that a pixel's reuse looked at in a pass, and those of them that took part.
struct Acceptance {
    uint16_t asked = 0;
    uint16_t used = 0;

    [[nodiscard]] float share() const
    {
        return asked > 0 ? static_cast<float>(used) / static_cast<float>(asked) : 0.0f;
    }
};

/// Random numbers of a pixel for one purpose.
using PixelRng = std::function<Rng(int x, int y)>;

/// The same without each pixel's first number, which has turned the spiral of its neighbours.
[[nodiscard]] PixelRng after_turn(const PixelRng& rng);

/// Where a reuse pass writes: the pixels of its tile, in both.
struct ReuseOutput {
    Buffer2D<PixelReservoir>& reservoirs;
    Buffer2D<Spectrum>& colors;        ///< radiance of the sampled lights
    Buffer2D<Acceptance>& acceptance;  ///< added to
};

/// Finishes the combinations of all pixels of a tile, begun in order.
void finish_tile(const Tile& tile, const PixelRng& rng, const Combination& combination,
                 const ReuseOutput& out);

/// Combines each pixel of a tile with the pixel it was in the pass before (or in the frame before,
/// by motion), whose confidence is capped and scaled by profile_agreement. Reads frozen buffers, so
/// the result does not depend on tile order. Unbiased for any change of camera, media and lights:
/// the earlier domain is evaluated as it was. `still`: nothing changed.
void reuse_in_time(const PassView& pass, const FinishedPass& before, bool still, const Tile& tile,
                   const PixelRng& rng, Combination& scratch, const ReuseOutput& out,
                   WalkCounts& walks, ReuseCounts& counts);

/// Combines each pixel of a tile with neighbours in a disk, a spiral turned at random for each
/// pixel and pass; rays without smoke are passed over. out must not be pass.reservoirs (asserted).
void reuse_in_space(const PassView& pass, const Tile& tile, const PixelRng& rng,
                    Combination& scratch, const ReuseOutput& out, WalkCounts& walks,
                    ReuseCounts& counts);

/// Shades the chosen samples of a tile by one exact ray each: for targets that do not know shadows
/// exactly. Where they do, the combination's colors are better.
void shade_chosen(const PassView& pass, const Tile& tile, Buffer2D<Spectrum>& colors,
                  WalkCounts& walks);

/// Most confidence that history may have. `still`: nothing changed.
[[nodiscard]] float cap_of(const TemporalParams& params, bool still);

/// The rules that the frame's parameters stand for.
[[nodiscard]] CombineRules temporal_rules(const RestirParams& params, bool still);
[[nodiscard]] CombineRules spatial_rules(const RestirParams& params);

}  // namespace mote
