#pragma once

#include "render/lamp_lists.h"

namespace mote {

/// Strata per side of each pixel [W x H] from which its passes take a camera ray each; 1: one ray.
using SplitMap = Buffer2D<uint8_t>;

/// Where several camera rays of a pixel see different things. Empty maps: nowhere.
struct PixelSplits {
    SplitMap parts;   ///< edges of surfaces: see split_pixel()
    SplitMap lamps;   ///< edges of spheres and quads, which hide nothing: see look_for_lamps()
    LampLists lists;  ///< and those that are narrow
};

/// Finds edges by looks at the pixels' corners, and lamps that could hide between those, by
/// projecting them; of spheres and quads it then knows where to look. Depends on scene and frame
/// alone, not on any sample, so that pixels it misses are noisier but not biased. Small glowing
/// triangles mark at most a sixteenth of all pixels, those with most to gain. Cost: a ray per pixel
/// of tiles that may see surfaces or wide lamps; per lamp with a surface 60 ns, more while the
/// camera moves, and 10 ns per pixel of its box.
[[nodiscard]] PixelSplits find_split_pixels(const Scene& scene, int strata);

}  // namespace mote
