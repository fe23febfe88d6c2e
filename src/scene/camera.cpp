#include "scene/camera.h"

#include "core/sampling.h"

namespace mote {
namespace {

/// Film half extents at unit distance, and the map from pixels to it.
Vec2 pixel_to_plane(const Camera& camera, Vec2 p_px)
{
    const Vec2 size(camera.width, camera.height);
    const float half_height = camera.tan_half_fov_y;
    const float half_width = half_height * size.x / size.y;
    return {(2.0f * p_px.x / size.x - 1.0f) * half_width,
            (1.0f - 2.0f * p_px.y / size.y) * half_height};
}

}  // namespace

Ray generate_ray(const Camera& camera, Vec2 p_px, Vec2 u_lens, float time)
{
    const Trs trs = camera.world_from_camera.at(time);
    const Vec2 plane = pixel_to_plane(camera, p_px);
    Vec3 origin(0.0f);
    Vec3 direction(plane.x, plane.y, -1.0f);
    if (camera.lens_radius > 0.0f) {
        const Vec2 lens = camera.lens_radius * sample_disk(u_lens);
        origin = Vec3(lens.x, lens.y, 0.0f);
        direction = camera.focus_distance * direction - origin;
    }
    const Vec3d world_origin = trs.translate + trs.rotate * Vec3d(origin);
    const Vec3d world_direction = trs.rotate * glm::normalize(Vec3d(direction));
    return {Vec3(world_origin), Vec3(world_direction), time};
}

std::optional<Vec2> project(const Camera& camera, Vec3 p, float time)
{
    const Trs trs = camera.world_from_camera.at(time);
    const Vec3d in_camera = glm::conjugate(trs.rotate) * (Vec3d(p) - trs.translate);
    if (!(in_camera.z < 0.0)) return std::nullopt;
    const double half_height = static_cast<double>(camera.tan_half_fov_y);
    const double half_width = half_height * camera.width / camera.height;
    const double x = in_camera.x / -in_camera.z / half_width;
    const double y = in_camera.y / -in_camera.z / half_height;
    return Vec2(static_cast<float>(0.5 * (x + 1.0) * camera.width),
                static_cast<float>(0.5 * (1.0 - y) * camera.height));
}

}  // namespace mote
