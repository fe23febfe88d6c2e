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
    Still,        ///< one frame alone, of many samples
    Static,       ///< one frame after warm-up frames, nothing moves
    Accumulated,  ///< the mean of several frames after warm-up frames, nothing moves
    Camera,       ///< one frame after warm-up frames, only the camera moves
    Moving,       ///< one frame of the animation, after the frames before it
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

/// Whether camera, volumes, particles, lights or objects may change from frame to frame. Throws
/// Error(Input) if a glTF file cannot be read.
[[nodiscard]] bool is_animated(const SceneDescription& scene);

/// Frames that a mode renders in one run, oldest first. The mean of the last ones is compared.
struct FramePlan {
    std::vector<Scene> frames;
    int sample_factor = 1;  ///< multiplies the samples that methods take per frame
    int compared = 1;       ///< frames, >= 1
};

/// Frames of a plan that a method renders: without history only those compared.
[[nodiscard]] int frames_rendered(const FramePlan& plan, bool keeps_history);

struct FrameCounts {
    int warm_up = 8;  ///< frames before those compared, but for Still
    int still = 8;    ///< the sample_factor of Still, and the frames of Accumulated
};

/// How far the camera of BenchMode::Camera travels around what it is focused on [degrees/frame].
inline constexpr double camera_step = 1.0;

/// Prepares the frames; all modes show the same frame last. Frames of a scene at rest share their
/// grids, and carry their own numbers, so that their random numbers differ.
[[nodiscard]] FramePlan plan_frames(const SceneDescription& scene, BenchMode mode, int frame,
                                    const FrameCounts& counts, SceneCache& cache);

}  // namespace mote
