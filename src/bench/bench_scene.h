#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/figures.h"
#include "render/frame.h"
#include "runs/modes.h"

namespace mote {

/// How to benchmark; the scene's own settings hold for all that methods do not change.
struct BenchParams {
    std::string modes;         ///< by comma; empty: by what moves in the scene
    std::string methods;       ///< by comma; empty: those worthwhile for the scene's lights
    std::string reference;     ///< method of the reference image; empty: the best path tracer
    std::optional<int> frame;  ///< the frame compared; empty: the scene's first after warm-up
    FrameCounts frames;
    int runs = 8;                 ///< per method, >= 2; independent: own seeds, empty history
    int samples = 0;              ///< of rows without their own number; 0: equal times
    int passes = 1;               ///< of rows with one: passes of restir per frame
    double time_budget = 0.0;     ///< about how long a scene may take [s]; 0: no limit
    double reference_time = 0.0;  ///< CPU time of the reference image [s]; 0: that of all runs
    uint32_t seed = 1;            ///< of the first run; the reference has its own
};

/// Asked and told while the benchmark runs.
struct BenchHooks {
    StopRequested stop = nullptr;                 ///< ends it with Error(Interrupted)
    std::function<void(const std::string&)> say;  ///< progress, a line each
};

struct ModeResult {
    BenchMode mode = BenchMode::Still;
    std::vector<MethodResult> rows;
};

/// How the reference image was made.
struct ReferenceInfo {
    std::string method;
    int runs = 0;
    int samples = 0;              ///< per run and pixel
    double mean = 0.0;            ///< radiance, over pixels and channels
    double relative_error = 0.0;  ///< standard error of `mean`, relative
    double noise = 0.0;           ///< what is subtracted from every mse
};

struct SceneResult {
    std::string path;
    std::string name;
    uint64_t hash = 0;  ///< of the scene with its overrides
    int width = 0;
    int height = 0;
    int frame = 0;
    uint32_t seed = 0;
    ReferenceInfo reference;
    std::vector<ModeResult> modes;
    std::vector<std::string> left_out;  ///< path tracers that short runs showed to be far behind
};

/// Measures the methods on a scene. Methods take turns, run by run, so that what else the machine
/// does disturbs all alike. Uses the threads of the caller's arena; CPU times are the process's.
/// Throws Error(Input) for a scene that shows nothing, Error(Usage) for unknown names.
[[nodiscard]] SceneResult bench_scene(const SceneDescription& scene, const BenchParams& params,
                                      const BenchHooks& hooks);

}  // namespace mote
