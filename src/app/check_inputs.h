#pragma once

#include <string>
#include <vector>

#include "scene/description.h"

namespace mote {

/// What is wrong with the files that a scene reads at the given frames, one message each; empty if
/// all is well. Every file of every frame must be there; of each sequence the first file is opened
/// and must hold the grids or attributes that the scene uses; images are read. Many problems are
/// cut short.
[[nodiscard]] std::vector<std::string> check_inputs(const SceneDescription& scene,
                                                    const std::vector<int>& frames);

}  // namespace mote
