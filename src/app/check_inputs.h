#pragma once

#include <string>
#include <vector>

#include "scene/description.h"

namespace mote {

/// What was looked at, and what is wrong with it.
struct InputReport {
    std::vector<std::string> problems;  ///< one message each; empty if all is well
    size_t sequence_files = 0;          ///< particle and volume files that the frames show
    size_t opened_files = 0;            ///< of these; fewer where time ran out
};

/// Looks at the files that a scene reads at the given frames. Every one must be there. The first
/// file of a particle sequence is read; of every other particle or volume file the header is, and
/// must name the grids or attributes that the scene uses, as long as `max_seconds` are not over
/// [wall time]; images are read. Ends early when there are many problems.
[[nodiscard]] InputReport check_inputs(const SceneDescription& scene,
                                       const std::vector<int>& frames, double max_seconds = 10.0);

}  // namespace mote
