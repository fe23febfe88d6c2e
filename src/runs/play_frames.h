#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "render/frame.h"
#include "runs/modes.h"

namespace mote {

struct LightCaches;

/// Light caches of each frame of a plan, kept from run to run. They depend on the scenes alone, not
/// on seeds or history, so runs that share them stay independent and only save the time.
struct PlanCaches {
    std::vector<std::shared_ptr<const LightCaches>> frames;
};

/// Called after each frame rendered, with its index in the plan.
using FramePlayed =
    std::function<void(size_t index, const LayeredImage& image, const FrameStats& stats)>;

/// Renders the plan's frames in order, from empty history; without history only those compared.
/// `caches` may be null: then this run builds its own. Throws Error(Interrupted) once `stop` says
/// so. This is the one place where runs call the renderer.
void play_frames(const FramePlan& plan, bool keeps_history, const RenderDescription& render,
                 const OutputDescription& output, StopRequested stop, PlanCaches* caches,
                 const FramePlayed& played);

/// Layers named, all channels as 32-bit floats: what is compared must not be rounded to half.
[[nodiscard]] OutputDescription float_output(std::vector<std::string> aovs = {});

}  // namespace mote
