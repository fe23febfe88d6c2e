#pragma once

#include "bench/modes.h"
#include "core/buffer2d.h"
#include "core/math.h"
#include "render/frame.h"

namespace mote {

/// What one run of a method gave. Times are those of the measured frames, image writing and the
/// scene's preparation apart.
struct PlayedRun {
    Buffer2D<Spectrum> image;        ///< mean of the measured frames
    double cpu_seconds = 0.0;        ///< process CPU time, this run's share of caches included
    double cache_cpu_seconds = 0.0;  ///< that share
    double wall_seconds = 0.0;       ///< as cpu_seconds, by the clock
    int64_t non_finite = 0;          ///< pixels and samples replaced by black; must be 0
};

/// Renders the plan's frames in order, from empty history, and averages the measured ones. Without
/// history only the measured ones are rendered. Caches are charged as they are built, evenly over
/// the frames rendered: in full where every frame builds them, spread where one build serves all.
/// Throws Error(Interrupted) once `stop` says so. This is the one place where the benchmark calls
/// the renderer.
[[nodiscard]] PlayedRun play_run(const FramePlan& plan, bool keeps_history,
                                 const RenderDescription& render, StopRequested stop);

}  // namespace mote
