#pragma once

#include <vector>

#include "bench/figures.h"
#include "runs/methods.h"
#include "runs/play_run.h"

namespace mote {

/// What one row of a mode's table is about.
struct RowInputs {
    const Method& method;
    int samples = 1;  ///< per frame, before the plan's sample_factor
    const FramePlan& plan;
    const RenderDescription& render;  ///< the scene's
    const PixelStats& reference;
    StopRequested stop = nullptr;
};

/// Samples, in multiples of a method's own, at which its error is measured: powers of four up to
/// the plan's sample_factor, which is the last.
[[nodiscard]] std::vector<int> curve_factors(const FramePlan& plan);

/// The scene's settings as a method changes them.
[[nodiscard]] RenderDescription settings_of(const RenderDescription& render, const Method& method,
                                            int samples, uint32_t seed);

/// A row while it is measured.
struct RowRuns {
    MethodResult row;
    PixelStats images;
    std::vector<std::vector<RunFigures>> shorter;  ///< of each curve factor but the last
};

[[nodiscard]] RowRuns start_row(const RowInputs& inputs);

/// One run of a row, and one at each of the smaller numbers of samples.
void add_run(const RowInputs& inputs, uint32_t seed, RowRuns& runs);

/// The row with its figures; ratios stay empty.
[[nodiscard]] MethodResult finish_row(const RowInputs& inputs, RowRuns runs);

}  // namespace mote
