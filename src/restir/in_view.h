#pragma once

#include "core/parallel.h"
#include "scene/scene.h"

namespace mote {

/// Whether camera rays may meet a medium: false only if all media lie outside one side of the view
/// pyramid. Conservative: always true for open lenses and for cameras that move while the shutter
/// is open. What no ray can meet needs no light caches.
[[nodiscard]] bool media_in_view(const Scene& scene);

/// The same for the pixels of a tile.
[[nodiscard]] bool media_in_view(const Scene& scene, const Tile& tile);

/// The same of surfaces.
[[nodiscard]] bool surfaces_in_view(const Scene& scene, const Tile& tile);

}  // namespace mote
