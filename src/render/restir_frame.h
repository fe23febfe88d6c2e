#pragma once

#include "render/camera_pass.h"
#include "render/frame.h"
#include "render/march_frame.h"
#include "render/path_pass.h"
#include "restir/pass_state.h"

namespace mote {

/// Called after each tile, and asked before each tile's pass: true abandons the frame.
struct FrameControl {
    StopRequested stop = nullptr;
    TileDone tile_done = nullptr;
};

struct FrameHistory::Impl {
    std::shared_ptr<const LightCaches> caches;
    FrameDomain last;            ///< of the frame before, if a next one may reuse its samples
    FinishedPass before;         ///< its last pass, if that kept samples
    Buffer2D<PixelFilm> pixels;  ///< all passes since something changed, if they are accumulated
    FinishedPaths paths;         ///< of light of many events, if paths are reused
    std::optional<MeanRadiance> known;  ///< of the frames before, if samples may be reused
    bool is_last = false;               ///< no frame follows
    MarchHistory march;                 ///< of the ray marcher
};

/// All passes of a frame by the ReSTIR estimator; builds the light caches, or takes those of the
/// frame before where nothing they know of changed. False if stopped.
[[nodiscard]] bool render_restir(const Scene& scene, const RenderDescription& render,
                                 const AovSet& aovs, const LightSampler& lights,
                                 const FrameControl& control, FrameHistory::Impl& history,
                                 Film& film, FrameStats& stats);

/// All passes of a frame without reuse: every tile on its own, so that what a pass needs stays in
/// the processor's caches. Candidates are shaded all, not resampled: with an exact target the sum
/// over all is the reservoir's expectation, without the noise of choosing one. `pixels` holds
/// the passes that count already, and takes up the new ones; null: only the new ones count. False
/// if stopped.
[[nodiscard]] bool render_independent_passes(const PassInputs& inputs, const FrameControl& control,
                                             Film& film, PassCounts& counts, int64_t& dropped,
                                             Buffer2D<PixelFilm>* pixels = nullptr);

}  // namespace mote
