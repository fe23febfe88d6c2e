#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runs/modes.h"
#include "study/error_figures.h"
#include "study/straight_light.h"
#include "study/temporal.h"

namespace mote {

/// What to test, and how. The scene's own settings hold for all that is not said here.
struct VerifyParams {
    std::string method;     ///< of all_methods(); empty: estimator restir with the scene's settings
    std::string reference;  ///< the same; empty: the path tracer that suits the scene
    std::optional<int> frame;    ///< the frame compared; empty: the scene's first after warm-up
    std::optional<int> warm_up;  ///< frames before it; empty: 8, in motion 4 or what there is
    /// Of the tested estimator, per frame; 0: one, but where frames do not depend on those before
    /// as many as take about a fifth of a second.
    int passes = 0;
    bool temporal = true;  ///< measure sequences as well, of methods that keep history
    StudyParams study;
};

struct VerifyHooks {
    StopRequested stop = nullptr;                 ///< ends it with Error(Interrupted)
    std::function<void(const std::string&)> say;  ///< progress, a line each
};

/// One of the two estimators.
struct EstimatorInfo {
    std::string name;
    int samples = 1;  ///< per pixel and frame
    int frames = 1;   ///< rendered per run; 1 where those before change nothing in the last one
    double run_seconds = 0.0;
};

struct VerifyResult {
    std::string path;
    std::string name;
    uint64_t hash = 0;  ///< of the scene with its overrides
    int width = 0;
    int height = 0;
    int frame = 0;
    int warm_up = 0;
    BenchMode mode = BenchMode::Static;
    EstimatorInfo tested;
    EstimatorInfo reference;
    StraightLight straight;  ///< what came from passes of its own
    StudyParams params;      ///< as they were used
    Study study;
    int64_t truncated_paths = 0;  ///< ended by the scene's limit of events, both estimators
    ErrorFigures errors;
    std::optional<TemporalFigures> temporal;
};

/// Tests an estimator on a scene against the path tracer of the same scope: the same frame of the
/// same media, lights and number of scattering events. All of an estimator that is known to be
/// biased (see is_unbiased) is judged by equivalence. Throws Error(Input) for a scene that shows
/// nothing, Error(Usage) for unknown methods.
[[nodiscard]] VerifyResult verify_scene(const SceneDescription& scene, const VerifyParams& params,
                                        const VerifyHooks& hooks);

}  // namespace mote
