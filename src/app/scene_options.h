#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "scene/description.h"

namespace mote {

/// Loads the scene with everything the command line overrides. Throws as load_scene.
[[nodiscard]] SceneDescription load_render_scene(const RenderOptions& options);

/// The frames to work on: `list` where given, otherwise the scene's range.
[[nodiscard]] std::vector<int> chosen_frames(const std::string& list,
                                             const SceneDescription& scene);

/// Threads to use: `asked`, or all that this process may use where that is 0.
[[nodiscard]] int chosen_threads(int asked);

}  // namespace mote
