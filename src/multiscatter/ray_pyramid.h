#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "reference/trace_context.h"
#include "restir/pixel_domain.h"

namespace mote {

/// Rays that the pixels of a tile share for light of many events: one through the middle of the
/// tile, of its quarters, and so on down to squares of two pixels. With I(r) the light scattered
/// twice and more along ray r, R_1 the smallest square's ray and R_4 the tile's,
///     I(pixel) = [I(pixel) - I(R_1)] + [I(R_1) - I(R_2)] + ... + I(R_4),
/// where every bracket is estimated by pairs of paths (estimate_difference): the nearer two rays,
/// the less noise, and the further apart, the more pixels share the cost. Unbiased for any rays.
/// A multilevel Monte Carlo estimator (Heinrich 2001; Giles 2008) over image space, with the pairs
/// of gradient-domain rendering (Kettunen et al. 2015). Precondition: is_still_but_for_camera.
///
/// The error that the pixels of a block share shows as squares where few passes are rendered, and
/// at the smoke's edge as single dark or bright ones. Memory: 85 tabulated rays of about 2 KB for
/// each tile under way; nothing per pixel.
struct RayPyramid {
    static constexpr int levels = 4;
    static constexpr int root_size = 1 << levels;  ///< [px]
    static_assert(root_size == image_tile_size);

    struct SharedRay {
        PixelDomain domain;
        Spectrum light{0.0f};  ///< this pass's estimate of I
    };
    Tile tile{0, 0, 0, 0};
    std::vector<SharedRay> rays;  ///< level 4 first; blocks of a level row by row

    /// The ray of the block of 2^level pixels around pixel x, y of the image.
    [[nodiscard]] const SharedRay& ray_of(int level, int x, int y) const
    {
        return rays[index_of(level, x, y)];
    }
    [[nodiscard]] size_t index_of(int level, int x, int y) const;
};

/// How many of `count` paths or pairs a ray is worth on which a share `lost` of the light collides:
/// in proportion to it, but where smoke is thin more, as a few heavy paths would show as spots.
[[nodiscard]] inline float paths_worth(float lost, int count)
{
    return std::max(lost * static_cast<float>(count), std::sqrt(lost));
}

/// How many pairs or paths are spent.
struct RayPyramidParams {
    int pairs = 1;  ///< per pixel and pass; shared rays take theirs in proportion
};

/// Tabulates the shared rays of a tile. Cost: a camera ray for every three pixels, once for all
/// passes.
void make_ray_pyramid(const FrameDomain& frame, const Tile& tile, RayPyramid& pyramid,
                      BinCounts& counts);

/// Estimates the shared rays' light anew.
void light_ray_pyramid(const TraceContext& context, const RayPyramidParams& params, Rng& rng,
                       RayPyramid& pyramid, bool& truncated);

/// Light scattered twice and more along a pixel's own ray, given the shared ones'.
[[nodiscard]] Spectrum light_of_pixel(const TraceContext& context, const RayPyramidParams& params,
                                      const RayPyramid& pyramid, int x, int y,
                                      const PixelDomain& domain, Rng& rng, bool& truncated);

/// Whether sharing pays on this tile: where neighbouring pixels are much closer together than the
/// smoke's mean free path, narrow lobes counting as shorter ones, and no lamps are near, whose
/// light changes from place to place. Cost: the ray through the
/// tile's middle, where there are no lamps.
[[nodiscard]] bool is_worth_sharing(const FrameDomain& frame, const Tile& tile, BinCounts& counts);

}  // namespace mote
