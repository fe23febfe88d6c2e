#pragma once

#include <string>
#include <vector>

#include "render/frame.h"
#include "runs/modes.h"
#include "runs/pixel_stats.h"

namespace mote {

/// How the error falls after a sudden change, of a method that keeps history.
struct StepResponse {
    std::string name;         ///< "light" or "density"
    std::vector<double> mse;  ///< trimmed, of the frames from the change on, over the steady one
    int lag = -1;  ///< frames from the change until mse is at most twice the steady one; -1: later
};

/// What a sequence of frames of a scene at rest looks like.
struct TemporalFigures {
    int runs = 0;
    int frames = 0;                ///< per run, after the warm-up
    double autocorrelation = 0.0;  ///< of a pixel's error, from one frame to the next
    double boiling = 0.0;     ///< rms change of a pixel between frames over sqrt 2, relative to the
                              ///< picture's mean: of independent frames, the noise of one
    double steady_mse = 0.0;  ///< trimmed, over the square of the picture's mean
    std::vector<StepResponse> steps;
};

/// What is played: the scene with the method's settings.
struct TemporalInputs {
    const SceneDescription& scene;
    const RenderDescription& render;
    int frame = 1;    ///< at which the scene stands still
    int warm_up = 8;  ///< frames before those measured, >= 1 (asserted)
    uint32_t seed = 1;
    double seconds = 0.0;  ///< by the clock, about; at least two runs are played
    StopRequested stop = nullptr;
};

/// Plays the scene at rest, and after a step in which its lights, or its densities, become four
/// times as strong. `reference` is that of the scene itself.
[[nodiscard]] TemporalFigures measure_temporal(const TemporalInputs& inputs,
                                               const PixelStats& reference);

}  // namespace mote
