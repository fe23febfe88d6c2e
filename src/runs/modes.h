#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/prepare.h"

namespace mote {

/// What is shown and compared.
enum class BenchMode {
    Still,   ///< one frame alone, of many samples
    Static,  ///< one frame after warm-up frames, nothing moves
    Moving,  ///< one frame of the animation, after the frames before it
};

struct ModeInfo {
    BenchMode mode;
    const char* name;  ///< on the command line and in the results
    const char* doc;
};

[[nodiscard]] std::span<const ModeInfo> mode_table();
[[nodiscard]] const char* mode_name(BenchMode mode);

/// The modes named in a list by comma. An empty list: Moving for a scene in which something moves,
/// else Still and Static. Throws Error(Usage) for an unknown name.
[[nodiscard]] std::vector<BenchMode> choose_modes(const std::string& list,
                                                  const SceneDescription& scene);

/// Whether camera, volumes, particles or lights may change from frame to frame.
[[nodiscard]] bool is_animated(const SceneDescription& scene);

/// Frames that a mode renders in one run, oldest first. The last one is compared.
struct FramePlan {
    std::vector<Scene> frames;
    int sample_factor = 1;  ///< multiplies the samples that methods take per frame
};

struct FrameCounts {
    int warm_up = 8;  ///< frames before the one compared, Static and Moving
    int still = 8;    ///< the sample_factor of Still
};

/// Prepares the frames; all modes show the same frame last. Frames of a scene at rest share their
/// grids, and carry their own numbers, so that their random numbers differ.
[[nodiscard]] FramePlan plan_frames(const SceneDescription& scene, BenchMode mode, int frame,
                                    const FrameCounts& counts, SceneCache& cache);

}  // namespace mote
