#pragma once

#include <span>

#include "render/pixel_parts.h"
#include "render/surface_pass.h"
#include "restir/candidates.h"

namespace mote {

/// Parts of pixels' passes under way, without reuse, and what sampling them takes; cleared between
/// passes rather than made anew.
struct PartScratch {
    std::vector<FilmSample> samples;  ///< of the parts traced since clear()
    TileRays rays;                    ///< from media, owned by `samples`
    LightRays surface_rays;           ///< from surfaces
    LightRays lamp_rays;              ///< from the camera, see look_for_lamps()
    std::vector<Candidate> candidates;
    SurfaceChoice choice;
    std::vector<PixelDomain> domains;
    SurfaceDomain surface;
    std::vector<PathVertex> first;  ///< for light of many events

    void clear();
};

/// A part that is to be traced.
struct DuePart {
    PassKey key;
    PixelPart part;
};

/// Samples parts: appends to scratch.samples, in order. Candidates are shaded all, not resampled:
/// with an exact target the sum over all is the reservoir's expectation, without the noise of
/// choosing one. What rays towards lights bring comes by shade_parts().
void trace_parts(const PassInputs& inputs, std::span<const DuePart> parts, PartScratch& scratch,
                 PassCounts& counts);

/// Traces the rays towards lights of all parts together, and the paths that they share, and adds
/// what they bring. `key`: of all parts, a tile's say; differs from that of other calls.
void shade_parts(const PassInputs& inputs, const PassKey& key, PartScratch& scratch,
                 PassCounts& counts);

}  // namespace mote
