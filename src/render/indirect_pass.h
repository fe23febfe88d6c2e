#pragma once

#include <vector>

#include "multiscatter/path_vertex.h"
#include "render/camera_pass.h"

namespace mote {

/// How many of `count` paths a ray is worth on which a share `lost` of the light collides: in
/// proportion to it, but where smoke is thin more, as a few heavy paths would show as spots.
[[nodiscard]] float paths_worth(float lost, int count);

/// Whether a frame's pixels share paths of many events; its light caches then need mean extinction.
[[nodiscard]] bool shares_paths(const Scene& scene, const RenderDescription& render);

/// Whether a constant environment is the only light of the scene, and paths go on until they find
/// it. Then what a path brings hardly depends on when it does, and parts of its light vary far more
/// than their sum: light scattered once is best left to the same paths. (Measured: puff_sky, 480 x
/// 270, 2.8 times as efficient.) Needs no light caches.
[[nodiscard]] bool paths_bring_sky(const Scene& scene, const RenderDescription& render);

/// The same of surfaces, where the sky's light can be told from that of lamps: whatever else
/// shines.
[[nodiscard]] bool surface_paths_bring_sky(const Scene& scene, const RenderDescription& render);

/// Whether residual walks from a frame's pixels correct a cache of radiance.
[[nodiscard]] bool corrects_cache(const Scene& scene, const RenderDescription& render);

/// Light scattered twice and more along a pixel's ray, by the path tracer from exact first events
/// on: stratified free flights, each worth the share of light that collides; where a surface ends
/// the ray, that is all. What media scatter first comes from nodes in previews, from
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
