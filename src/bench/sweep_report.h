#pragma once

#include <string>
#include <vector>

#include "bench/sweep.h"

namespace mote {

/// A sweep as text: times, memory and counts of every size and method.
[[nodiscard]] std::string sweep_text(const SweepResult& sweep);

/// Time of a frame against size, log over log, as an <svg> element.
[[nodiscard]] std::string sweep_plot(const SweepResult& sweep);

[[nodiscard]] std::string sweeps_json(const std::vector<SweepResult>& sweeps);
[[nodiscard]] std::string sweeps_csv(const std::vector<SweepResult>& sweeps);
[[nodiscard]] std::string sweeps_html(const std::vector<SweepResult>& sweeps);

}  // namespace mote
