#pragma once

#include <vector>

#include "multiscatter/path_vertex.h"
#include "render/camera_pass.h"

namespace mote {

/// How many of `count` paths a ray is worth on which a share `lost` of the light collides in media,
/// or reaches the surface behind: in proportion to it, but of small shares more, as a few heavy
/// paths would show as spots.
[[nodiscard]] float paths_worth(float lost, int count);

/// Light scattered twice and more along a pixel's ray, by the path tracer from exact first events
/// on: stratified free flights that share what collides in media, and paths from the surface that
/// ends the ray for what reaches it. What media scatter first comes from nodes in previews, from
/// `path_light` where paths are reused, from residual walks where there is a cache of radiance;
/// where they are shared, first events go to `first` under `owner`, for light_shared_paths. Does
/// nothing if light scatters only once. `surface`: that ends the ray; may be null.
void add_indirect(const PassInputs& inputs, const PassKey& key, const PixelDomain& domain,
                  const SurfaceVertex* surface, int owner, std::vector<PathVertex>& first,
                  FilmSample& sample, PassCounts& counts);

/// What shared paths bring by owner; empty if there is nothing to be lit. Owners count up in
/// `first`, which is emptied. `key`: of all that share. If max_bounces cuts one path, all owners
/// count as cut.
[[nodiscard]] std::vector<Spectrum> light_shared_paths(const PassInputs& inputs, const PassKey& key,
                                                       std::vector<PathVertex>& first,
                                                       PassCounts& counts);

}  // namespace mote
