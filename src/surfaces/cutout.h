#pragma once

#include <embree3/rtcore.h>

namespace mote {

struct Surfaces;

/// What goes with one ray into Embree and comes back to the filter below.
struct SurfaceQuery {
    RTCIntersectContext embree;  ///< first: Embree hands back a pointer to it
    const Surfaces* surfaces;

    explicit SurfaceQuery(const Surfaces& of);
};

/// Embree's filter of hits: rejects those where a material is cut out. Called only if any is.
void reject_cut_out(const RTCFilterFunctionNArguments* arguments);

}  // namespace mote
