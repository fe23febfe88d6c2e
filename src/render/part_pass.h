#pragma once

#include "render/pixel_parts.h"
#include "render/surface_pass.h"
#include "restir/candidates.h"

namespace mote {

/// Parts of pixels' passes under way, without reuse, and what sampling them takes; cleared between
/// passes rather than made anew.
struct PartScratch {
    std::vector<FilmSample> samples;  ///< of the parts traced since clear()
    LightRays rays;                   ///< from media, owned by `samples`
    LightRays surface_rays;           ///< from surfaces
    std::vector<Candidate> candidates;
    SurfaceChoice choice;
    PassDomain domain;

    void clear();
};

/// Samples one part: appends to scratch.samples. Candidates are shaded all, not resampled: with an
/// exact target the sum over all is the reservoir's expectation, without the noise of choosing one.
/// What rays towards lights bring comes by shade_parts().
void trace_part(const PassInputs& inputs, const PassKey& key, const PixelPart& part,
                const RayPyramid* pyramid, PartScratch& scratch, PassCounts& counts);

/// Traces the rays towards lights of all parts together and adds what they bring.
void shade_parts(const FrameDomain& frame, PartScratch& scratch, PassCounts& counts);

}  // namespace mote
