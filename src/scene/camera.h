#pragma once

#include <optional>

#include "core/math.h"
#include "core/transform.h"

namespace mote {

/// Thin-lens perspective camera, moving over the shutter. Camera space looks along -z, +y up.
struct Camera {
    MovingTransform world_from_camera;
    int width = 640;
    int height = 360;
    float tan_half_fov_y = 0.4142f;  ///< tangent of half the vertical field of view
    float lens_radius = 0.0f;        ///< [m]; 0 is a pinhole
    float focus_distance = 1.0f;     ///< along the view axis [m]
};

/// Ray through film position p_px (pixels, origin top-left, (0.5,0.5) is the first pixel's
/// centre). u_lens in [0,1)^2 chooses the point on the lens, time in [0,1].
[[nodiscard]] Ray generate_ray(const Camera& camera, Vec2 p_px, Vec2 u_lens, float time);

/// Film position [px] of a world point at ray time; empty behind the camera. Pinhole projection.
[[nodiscard]] std::optional<Vec2> project(const Camera& camera, Vec3 p, float time);

}  // namespace mote
