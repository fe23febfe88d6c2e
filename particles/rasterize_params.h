#pragma once

#include <cstdint>

namespace mote {

/// Grids to build: only those that the scene uses.
struct RasterChannels {
    bool velocity = false;
    bool temperature = false;
    bool color = false;
};

struct RasterizeParams {
    float voxel_size = 0.02f;      ///< edge of a voxel [m]
    float shutter_open_s = 0.0f;   ///< blur along the velocity from here ... [s, relative to frame]
    float shutter_close_s = 0.0f;  ///< ... to here; equal means no blur
    int64_t max_voxels = 2'000'000'000;  ///< refuse larger results, Error(Memory)
    int64_t max_splats = 16'000'000;     ///< held at once, about 25 bytes each; more go in waves
    RasterChannels channels;
};

}  // namespace mote
