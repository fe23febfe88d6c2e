#pragma once

#include "scene/camera.h"

namespace mote {

/// Distance along a ray -> depth along the camera's view axis [m].
[[nodiscard]] inline float view_depth(const Camera& camera, const Ray& ray, float distance)
{
    const Quatd rotation = camera.world_from_camera.at(ray.time).rotate;
    const Vec3d forward = rotation * Vec3d(0.0, 0.0, -1.0);
    return distance * static_cast<float>(glm::dot(forward, Vec3d(ray.d)));
}

}  // namespace mote
