#pragma once

#include "core/buffer2d.h"
#include "core/math.h"
#include "render/frame.h"
#include "runs/modes.h"
#include "runs/work.h"

namespace mote {

/// What one run of a method gave: the mean of the plan's frames compared, and what those took.
/// Image writing and the scene's preparation are not part of the times.
struct PlayedRun {
    Buffer2D<Spectrum> image;
    double cpu_seconds = 0.0;        ///< process CPU time, its share of caches included
    double cache_cpu_seconds = 0.0;  ///< that share
    double wall_seconds = 0.0;       ///< by the clock, with the caches the frames built themselves
    int64_t non_finite = 0;          ///< pixels and samples replaced by black, all frames
    WorkCounts work;                 ///< of the frames compared
    MemoryUse memory;                ///< in the last frame
};

/// Renders the plan's frames in order, from empty history; without history only those compared.
/// Caches are charged evenly over the frames rendered: in full where every frame builds them,
/// spread where one build serves all. Throws Error(Interrupted) once `stop` says so.
[[nodiscard]] PlayedRun play_run(const FramePlan& plan, bool keeps_history,
                                 const RenderDescription& render, StopRequested stop);

}  // namespace mote
