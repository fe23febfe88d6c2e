#pragma once

#include "march/march.h"
#include "render/film.h"
#include "render/frame.h"
#include "restir/media_key.h"

namespace mote {

struct FrameControl;

/// What the ray marcher keeps from frame to frame: shadows, while media and lights are the same.
struct MarchHistory {
    std::shared_ptr<const ShadowGrid> shadows;
    MediaKey media;
    std::vector<MarchLight> lights;
};

/// All samples of a frame by the ray marcher, at places of a low-discrepancy sequence: no random
/// numbers, the same image for every seed. False if stopped.
[[nodiscard]] bool render_marched(const Scene& scene, const RenderDescription& render,
                                  const FrameControl& control, MarchHistory& history, Film& film,
                                  FrameStats& stats);

}  // namespace mote
