#pragma once

#include <chrono>

#include "runs/methods.h"
#include "runs/play_frames.h"
#include "study/verify_scene.h"

namespace mote {

/// A study while it is set up.
struct VerifySetup {
    const SceneDescription& scene;
    const VerifyParams& params;
    const VerifyHooks& hooks;
    FramePlan plan;
    FramePlan last_frame;
    PlanCaches caches;
    PlanCaches straight_caches;
    std::vector<std::string> parts;  ///< layers that show anything
    StraightLight straight;
    Method tested;
    Method reference;
    int passes = 1;               ///< of the tested method, per frame
    int64_t truncated_paths = 0;  ///< so far

    void say(const std::string& line) const
    {
        if (hooks.say) hooks.say(line);
    }
};

/// By the clock.
[[nodiscard]] inline double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Layers that are judged beside the picture, where they show anything.
[[nodiscard]] const std::vector<std::string>& part_names();

/// The scene's settings, changed by the method.
[[nodiscard]] RenderDescription settings_of(const VerifySetup& setup, const Method& method,
                                            int samples);

/// The last frame without events. Throws Error(BiasFound) as the runs below do.
[[nodiscard]] LayeredImage straight_run(VerifySetup& setup, const Method& method, int passes,
                                        uint32_t seed);

/// Runs of a method, each of which is the plan's last frame from empty history; straight light from
/// passes of its own, if there are any. A run throws Error(BiasFound) for what no statistics are
/// needed for: samples that are not finite, densities above their majorants.
[[nodiscard]] RunSource source_of(VerifySetup& setup, const Method& method, int samples,
                                  int straight_passes = 0);

}  // namespace mote
