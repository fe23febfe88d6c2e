#pragma once

#include "restir/reuse_passes.h"

namespace mote {

/// Surface reservoirs of a pass under way and what they live in: read by the passes below.
struct SurfaceView {
    const FrameDomain& frame;
    const Buffer2D<SurfaceDomain>& domains;
    const Buffer2D<PixelReservoir>& reservoirs;
};

/// The pixel at which a surface point was seen in an earlier pass: by the earlier place of its
/// object and the earlier camera. Empty off screen. `distance`: from that camera [m].
struct PreviousSurface {
    int x = 0;
    int y = 0;
    float distance = 0.0f;
};
[[nodiscard]] std::optional<PreviousSurface> previous_surface(const FrameDomain& before,
                                                              const FrameDomain& now,
                                                              const SurfaceDomain& domain);

/// Whether two pixels' surfaces are alike enough to share samples: normals within 25 degrees,
/// distances from the camera within 10 %, alike in material. From pixel data alone, so that sharing
/// stays unbiased. `distance`: that at which `other` is expected [m].
[[nodiscard]] bool is_similar(const SurfaceDomain& own, const SurfaceDomain& other, float distance);

/// The rules between surfaces: the caches know too little beside walls, so targets have exact
/// shadows or none, as surface.visibility says, whatever they have in media.
[[nodiscard]] CombineRules surface_temporal_rules(const RestirParams& params, bool still);
[[nodiscard]] CombineRules surface_spatial_rules(const RestirParams& params);

/// Combines each pixel's surface reservoir of a tile with that of the pixel it was in the pass
/// before, if that is similar. As reuse_in_time.
void reuse_surfaces_in_time(const SurfaceView& pass, const FinishedPass& before, bool still,
                            const Tile& tile, const PixelRng& rng, Combination& scratch,
                            const ReuseOutput& out, WalkCounts& walks, ReuseCounts& counts);

/// Combines each pixel's surface reservoir of a tile with those of similar neighbours, more of them
/// where history is short. As reuse_in_space.
void reuse_surfaces_in_space(const SurfaceView& pass, const Tile& tile, const PixelRng& rng,
                             Combination& scratch, const ReuseOutput& out, WalkCounts& walks,
                             ReuseCounts& counts);

}  // namespace mote
