#pragma once

#include "scene/description.h"

namespace mote {

/// Hash of every value that changes the picture, defaults included: two files that say the same in
/// another order or with other comments have the same hash. Contents of input files do not count.
[[nodiscard]] uint64_t hash_scene(const SceneDescription& scene);

}  // namespace mote
