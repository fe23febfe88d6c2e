#pragma once

#include <algorithm>

#include "scene/scene.h"

namespace mote {

/// Whether nothing but the camera moves while the shutter is open, so that the light of two places
/// belongs to one time whatever the rays' times are.
[[nodiscard]] inline bool is_still_but_for_camera(const Scene& scene)
{
    const auto moves = [](const auto& thing) { return thing.world_from_object.is_moving(); };
    const std::vector<Volume>& volumes = scene.media.volumes;
    if (std::any_of(volumes.begin(), volumes.end(), moves)) return false;
    if (!scene.surfaces) return true;
    const std::vector<MeshInstance>& instances = scene.surfaces->bvh->instances();
    return std::none_of(instances.begin(), instances.end(), moves);
}

}  // namespace mote
