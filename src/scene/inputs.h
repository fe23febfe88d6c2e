#pragma once

#include <string>

#include "scene/description.h"

namespace mote {

/// Sixteen hexadecimal digits over path, size and modification time of every file that the picture
/// at `frame` is made of: particle caches, volume files and meshes that are shown, and images of
/// environment lights; "" if it needs none. The scene file is not among them: its own hash covers
/// what it says. Throws Error(Input) naming a file that is missing.
[[nodiscard]] std::string inputs_hash(const SceneDescription& description, int frame);

}  // namespace mote
