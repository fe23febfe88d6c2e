#pragma once

#include "scene/scene.h"

namespace mote {

/// Film motion until the next frame [px]: u to the right, v up, of what the ray sees at `distance`
/// (infinity: the background, which only the camera's rotation moves). Overlapping volumes move
/// with the mean of their velocities weighted by extinction. 0 for what leaves the camera's half
/// space. `object`: the surface that is seen there, -1: media. Without Scene::next, camera and
/// volume transforms count as still.
[[nodiscard]] Vec2 film_motion(const Scene& scene, const Ray& ray, float distance, int object = -1);

}  // namespace mote
