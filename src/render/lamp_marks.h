#pragma once

#include "core/buffer2d.h"
#include "scene/camera.h"

namespace mote {

/// Pixels that small lamps may be seen in, by projecting the lamps' boxes.
class LampMarks {
  public:
    LampMarks(const Camera& camera, float time);

    /// False for lamps that are wide on the film, or beside the camera: they cannot hide between
    /// pixels' corners.
    bool add(const Bounds3& lamp, float radiance);
    /// Writes `value` to the pixels found, to `share` of all pixels at most: those with most to
    /// gain.
    void mark(uint8_t value, float share, Buffer2D<uint8_t>& map) const;

  private:
    Buffer2D<float> variance_;  ///< of one ray's light
    Vec3 eye_{0.0f};
    Mat3 camera_from_world_{1.0f};
    float per_tangent_ = 1.0f;  ///< [px]
};

}  // namespace mote
