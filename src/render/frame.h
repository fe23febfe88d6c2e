#pragma once

#include <cstdint>

#include "image/layers.h"
#include "scene/description.h"
#include "scene/scene.h"

namespace mote {

/// Counts and times of one rendered frame, written to --stats.
struct FrameStats {
    double render_seconds = 0.0;      ///< wall
    double render_cpu_seconds = 0.0;  ///< process CPU time
    int64_t paths = 0;
    int64_t dropped_non_finite = 0;  ///< samples replaced by 0; must be 0
    int64_t truncated_paths = 0;     ///< cut by max_bounces though they could have gone on
};

/// Asked by several threads, at every pixel and every few samples, so it must be cheap; true
/// abandons the frame. May be null.
using StopRequested = bool (*)();

/// Called by several threads after each 16 x 16 tile. May be null.
using TileDone = void (*)();

/// Renders one frame into a layered image holding RGBA and the layers of output.aovs (see aov.h),
/// nothing else: layers not asked for are not computed. RGB is the mean over the pixel's square,
/// premultiplied by nothing but the volumes themselves; A is 1 minus the mean transmittance.
/// Attributes describe the camera. Empty image if stopped. Bit-identical for any thread count:
/// every sample has its own random stream, keyed by (seed, frame, pixel, sample), and a pixel adds
/// its samples in order. Throws Error(Input) for unknown layers.
[[nodiscard]] LayeredImage render_frame(const Scene& scene, const RenderDescription& render,
                                        const OutputDescription& output, StopRequested stop,
                                        FrameStats& stats, TileDone tile_done = nullptr);

}  // namespace mote
