#pragma once

#include <cstddef>

#include "scene/description.h"
#include "scene/prepare.h"

namespace mote {

/// Most memory this process has used so far [bytes].
[[nodiscard]] size_t peak_memory();

/// Memory this process uses now [bytes].
[[nodiscard]] size_t current_memory();

/// Memory that rendering one frame of the scene adds to its prepared volumes [bytes]: pixels and
/// layers, once while they are summed and once while the file is written.
[[nodiscard]] size_t frame_buffer_memory(const SceneDescription& scene);

/// Makes allocations beyond `limit` bytes fail, so that they end as exit code 5 rather than by
/// the system's killer. 0: no limit.
void limit_allocations(double limit);

/// Throws Error(Memory), with what needs how much, if the frame that was just prepared would pass
/// `limit` bytes. 0: no limit.
void require_memory(double limit, const SceneDescription& scene, const PrepareStats& prepared);

}  // namespace mote
