#pragma once

#include "render/camera_pass.h"
#include "restir/combine.h"

namespace mote {

/// What a surface's candidates were resampled to, and what that takes; reused from pixel to pixel.
struct SurfaceChoice {
    std::vector<PixelReservoir> kept;   ///< of lamps and glowing media, one of each group
    std::vector<Candidate> candidates;  ///< all that were drawn
    std::vector<Candidate> group;       ///< some of them
    /// Those of lights at infinity: little is gained by reusing them, and much lost by having to
    /// choose between them, so they are shaded all. None without params.control_variate: then they
    /// compete with the lamps.
    std::span<const Candidate> apart;
};

/// Draws a surface's candidates and chooses among them, one of each of `groups` groups, whose light
/// adds up: the target is the unshadowed light times what the caches know of its shadow. The
/// reservoirs' f have no shadow. At least one reservoir is kept; it may be empty.
void resample_surface(const PassInputs& inputs, const PassKey& key, const SurfaceDomain& domain,
                      size_t groups, SurfaceChoice& choice, PassCounts& counts);

/// Asks for the shadow ray of a surface's reservoir; it brings its light as the camera sees it.
void ask_for_light(const FrameDomain& frame, const SurfaceDomain& domain, const Reservoir& r,
                   int owner, LightRays& rays);

/// The same of the lights that are shaded all.
void ask_for_lights_apart(const SurfaceDomain& domain, const SurfaceChoice& choice, int owner,
                          LightRays& rays);

/// Surfaces of a pass under way, as reuse needs them; none if the scene has none.
struct SurfaceBuffers {
    Buffer2D<PixelReservoir> current;
    Buffer2D<PixelReservoir> next;
    Buffer2D<Spectrum> colors;  ///< light of the reservoirs, media in front of the surface apart
};

/// The surfaces' own reservoirs of a tile as surface.visibility has them: with exact shadows in
/// their targets, without (`colors` means nothing then, unless all are shaded), or with V. Lights
/// that are shaded all go into `samples`.
void fill_surface_reservoirs(const PassInputs& inputs, const Tile& tile, uint32_t pass,
                             const Buffer2D<SurfaceDomain>& domains, SurfaceBuffers& out,
                             Buffer2D<FilmSample>& samples, PassCounts& counts);

/// Fills `colors` of a tile: the chosen samples, each shaded by an exact ray. For targets that know
/// no shadows.
void shade_surface_reservoirs(const FrameDomain& frame, const Tile& tile,
                              const Buffer2D<SurfaceDomain>& domains, SurfaceBuffers& out,
                              PassCounts& counts);

}  // namespace mote
