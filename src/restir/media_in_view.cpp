#include "restir/media_in_view.h"

namespace mote {
namespace {

/// Whether all corners of a box, in camera space, are on the outer side of one plane of the view
/// pyramid. `slope`: tangents of the half angles, widened against rounding.
bool is_outside(const Bounds3& box, const Trs& camera, glm::dvec2 slope)
{
    bool outside[5] = {true, true, true, true, true};
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p((corner & 1) != 0 ? box.hi.x : box.lo.x,
                      (corner & 2) != 0 ? box.hi.y : box.lo.y,
                      (corner & 4) != 0 ? box.hi.z : box.lo.z);
        const Vec3d q = glm::conjugate(camera.rotate) * (p - camera.translate);
        outside[0] &= q.z > 0.0;
        outside[1] &= q.x > -slope.x * q.z;
        outside[2] &= q.x < slope.x * q.z;
        outside[3] &= q.y > -slope.y * q.z;
        outside[4] &= q.y < slope.y * q.z;
    }
    return outside[0] || outside[1] || outside[2] || outside[3] || outside[4];
}

}  // namespace

bool media_in_view(const Scene& scene)
{
    const Camera& camera = scene.camera;
    if (camera.lens_radius > 0.0f || camera.world_from_camera.is_moving()) return true;
    const double half_height = 1.001 * static_cast<double>(camera.tan_half_fov_y);
    const glm::dvec2 slope(half_height * camera.width / camera.height, half_height);
    const Trs place = camera.world_from_camera.at(0.0f);
    for (const Volume& volume : scene.media.volumes) {
        const Bounds3 box = world_bounds(volume);
        if (!box.is_empty() && !is_outside(box, place, slope)) return true;
    }
    return false;
}

}  // namespace mote
