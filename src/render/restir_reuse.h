#pragma once

#include "render/restir_frame.h"
#include "restir/reuse_passes.h"

namespace mote {

/// What a frame's passes reuse, decided before the first of them.
struct ReusePlan {
    bool temporal = false;
    bool spatial = false;

    [[nodiscard]] bool any() const { return temporal || spatial; }
};

/// What `auto` stands for in this frame. Measured: accumulated passes gain nothing from reuse (they
/// would only be correlated), and in motion more candidates are worth as much as history; history
/// wins where a single pass is shown of a scene that did not change. Lights at infinity need no
/// reservoirs.
[[nodiscard]] ReusePlan plan_reuse(const FrameDomain& domain, const RenderDescription& render,
                                   const std::optional<Change>& change);

/// All passes of a frame with reuse: each in whole-image steps that read frozen buffers. `before`
/// is the last pass of the frame before (empty at the start and after cuts) and becomes the last
/// pass of this one. False if stopped.
[[nodiscard]] bool render_reusing_passes(const PassInputs& inputs, const ReusePlan& plan,
                                         const FrameControl& control, FinishedPass& before,
                                         Film& film, PassCounts& counts, int64_t& dropped);

}  // namespace mote
