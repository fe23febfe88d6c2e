#pragma once

#include "render/camera_pass.h"
#include "restir/combine.h"

namespace mote {

/// Draws a surface's candidates into `candidates` (appended) and chooses one: the target is its
/// unshadowed light times what the caches know of its shadow. The reservoir's f has no shadow.
[[nodiscard]] PixelReservoir resample_surface(const PassInputs& inputs, const PassKey& key,
                                              const SurfaceDomain& domain,
                                              std::vector<Candidate>& candidates,
                                              PassCounts& counts);

/// Asks for the shadow ray of a surface's reservoir; it brings the surface's direct light as the
/// camera sees it.
void ask_for_light(const FrameDomain& frame, const SurfaceDomain& domain, const Reservoir& r,
                   int owner, LightRays& rays);

/// Surfaces of a pass under way, as reuse needs them; none if the scene has none.
struct SurfaceBuffers {
    Buffer2D<PixelReservoir> current;
    Buffer2D<PixelReservoir> next;
    Buffer2D<Spectrum> colors;  ///< direct light of the surfaces, media in front of them apart
};

/// The surfaces' own reservoirs of a tile, each with its exact shadow: targets of reuse have them.
void fill_surface_reservoirs(const PassInputs& inputs, const Tile& tile, uint32_t pass,
                             const Buffer2D<SurfaceDomain>& domains, SurfaceBuffers& out,
                             PassCounts& counts);

}  // namespace mote
