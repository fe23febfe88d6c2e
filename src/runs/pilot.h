#pragma once

#include <vector>

#include "runs/methods.h"
#include "runs/play_run.h"

namespace mote {

/// What two short runs of a method tell: how many samples to give it, and how good it is.
struct Pilot {
    double sample_seconds = 0.0;   ///< CPU time of one sample per pixel of one frame
    double cache_seconds = 0.0;    ///< CPU time of building caches, where there are any
    double sample_variance = 0.0;  ///< of it, averaged over the image without the worst pixels

    [[nodiscard]] double cost() const { return sample_variance * sample_seconds; }
};

/// Renders a plan of one frame twice.
[[nodiscard]] Pilot run_pilot(const FramePlan& plan, const Method& method,
                              const RenderDescription& render, StopRequested stop);

/// Samples per frame of each method: its own number, else `samples`, else (0) as many as take the
/// median time of the rows with a number of their own, or where there are none, that of 4 samples
/// of the slowest row. At least 1.
[[nodiscard]] std::vector<int> equal_time_samples(const std::vector<Method>& methods,
                                                  const std::vector<Pilot>& pilots, int samples);

/// Whether each method is worth full runs: no, if it is a reference row whose variance times time
/// is several times that of the best one, which no judgement by more runs would turn round.
[[nodiscard]] std::vector<bool> worth_measuring(const std::vector<Method>& methods,
                                                const std::vector<Pilot>& pilots);

/// The reference row of least variance times time; -1 if there is none.
[[nodiscard]] int best_reference_row(const std::vector<Method>& methods,
                                     const std::vector<Pilot>& pilots);

}  // namespace mote
