#pragma once

#include <functional>

#include "multiscatter/path_reuse.h"
#include "render/camera_pass.h"

namespace mote {

/// Whether pixels reuse each other's paths for light scattered twice and more in media: where the
/// scene asks for it and nothing but the camera moves while the shutter is open.
[[nodiscard]] bool reuses_paths(const Scene& scene, const RenderDescription& render);

/// Calls f(tile, counts) for all tiles in parallel; f is not called any more once a frame is to be
/// abandoned.
using ForTiles = std::function<void(const std::function<void(const Tile&, PassCounts&)>&)>;

/// Light scattered twice and more in media, of all pixels of a pass, each on a camera ray of its
/// own: walks from exact first events, as add_indirect's, streamed into one reservoir per pixel,
/// which is combined with the pass before (`history`, which becomes this pass) and with neighbours.
/// Memory while it works: 200 bytes per pixel, beside the history's.
void light_reused_paths(const PassInputs& inputs, uint32_t pass, const ForTiles& for_tiles,
                        FinishedPaths& history, Buffer2D<Spectrum>& light);

}  // namespace mote
