#pragma once

#include <string>

#include "image/layers.h"
#include "scene/description.h"
#include "scene/scene.h"

namespace mote {

/// Counts and times of one rendered frame, written to --stats.
struct FrameStats {
    double render_seconds = 0.0;      ///< wall
    double render_cpu_seconds = 0.0;  ///< process CPU time
    int64_t paths = 0;
    int64_t dropped_non_finite = 0;   ///< samples replaced by 0; must be 0
    int64_t truncated_paths = 0;
};

/// Called between tiles, returns true to abandon the frame.
using StopRequested = bool (*)();

/// Renders one frame into a layered image holding RGBA and the AOVs asked for, nothing else.
/// Empty image if stopped. Bit-identical for any thread count.
[[nodiscard]] LayeredImage render_frame(const Scene& scene, const RenderDescription& render,
                                        const OutputDescription& output, StopRequested stop,
                                        FrameStats& stats);

}  // namespace mote
