#pragma once

#include "core/buffer2d.h"
#include "scene/scene.h"

namespace mote {

/// Strata per side of each pixel [W x H] from which its passes take a camera ray each; 1: one ray.
using SplitMap = Buffer2D<uint8_t>;

/// Finds pixels in which several camera rays see different things: edges of surfaces and of wide
/// lamps, by looks at the pixels' corners, and lamps that could hide between those, by projecting
/// them. Depends on scene and frame alone, not on any sample, so that pixels it misses are noisier
/// but not biased. Empty where nothing but media is in view. Lamps mark at most a sixteenth of all
/// pixels, those with most to gain. Cost: a ray per pixel of tiles that may see surfaces, and 20 ns
/// per lamp with a surface.
[[nodiscard]] SplitMap find_split_pixels(const Scene& scene, int strata);

}  // namespace mote
