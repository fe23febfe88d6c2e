#pragma once

#include "render/restir_frame.h"
#include "restir/reuse_passes.h"

namespace mote {

/// What a frame's passes reuse, decided before the first of them.
struct ReusePlan {
    bool temporal = false;
    bool spatial = false;
    bool surface_temporal = false;
    bool surface_spatial = false;
    bool paths = false;         ///< of light of many events, see light_reused_paths
    bool keeps_passes = false;  ///< this frame's passes may count for the next frames too
    bool accumulates = false;   ///< and those of the frames before count for this one

    [[nodiscard]] bool reuses_samples() const
    {
        return temporal || spatial || paths || reuses_surfaces();
    }
    [[nodiscard]] bool reuses_surfaces() const { return surface_temporal || surface_spatial; }
};

/// What the frame reuses. `auto`: where frames of one pass each show a scene that does not change,
/// each frame is the mean of all passes so far: unbiased, as all estimate the same image, and at no
/// cost. Reservoirs are left alone: measured, passes that are accumulated gain nothing from reuse
/// (they would only be correlated), and in motion more candidates are worth more than history. But
/// for surfaces among many lamps history is worth more in motion: their samples stay where they
/// are.
[[nodiscard]] ReusePlan plan_reuse(const FrameDomain& domain, const RenderDescription& render,
                                   const std::optional<Change>& change);

/// All passes of a frame with reuse: each in whole-image steps that read frozen buffers. `before`
/// is the last pass of the frame before (empty at the start and after cuts) and becomes the last
/// pass of this one. `kept` becomes the frame's passes if the plan says so; `paths` are those of
/// the pass before, and become those of the last one. False if stopped.
[[nodiscard]] bool render_reusing_passes(const PassInputs& inputs, const ReusePlan& plan,
                                         const FrameControl& control, FinishedPass& before,
                                         Film& film, PassCounts& counts, int64_t& dropped,
                                         Buffer2D<PixelFilm>& kept, FinishedPaths& paths);

}  // namespace mote
