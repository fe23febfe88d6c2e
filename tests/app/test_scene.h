#pragma once

#include <string>

namespace mote {

/// A small scene of three frames: a puff under a sun. A frame takes a few milliseconds.
inline const std::string puff_scene = R"(
first_frame = 1
last_frame = 3

[camera]
position = [0, 0, 3]
look_at = [0, 0, 0]

[render]
width = 40
height = 24
samples = 2

[output]
path = "out/####.exr"
aovs = ["Z", "transmittance"]

[[volumes]]
name = "puff"
procedural = { type = "puff", voxel_size = 0.05, evolve = 1.0 }
density_scale = 4

[[lights]]
type = "distant"
direction = [0, 1, 0]
)";

}  // namespace mote
