#include "restir/in_view.h"

namespace mote {
namespace {

/// Tangents of the angles off the view axis between which rays lie, to the right and upwards.
struct ViewRange {
    glm::dvec2 lo;
    glm::dvec2 hi;
};

/// Of a range of pixels, a hair wider against rounding.
ViewRange view_range(const Camera& camera, const Tile& tile)
{
    const double per_pixel = 2.0 * static_cast<double>(camera.tan_half_fov_y) / camera.height;
    const double margin = 1e-3 * camera.height;
    const auto right = [&](double x) { return (x - 0.5 * camera.width) * per_pixel; };
    const auto up = [&](double y) { return (0.5 * camera.height - y) * per_pixel; };
    return {{right(tile.x0 - margin), up(tile.y1 + margin)},
            {right(tile.x1 + margin), up(tile.y0 - margin)}};
}

/// Whether all corners of a box are on the outer side of one plane of the pyramid of rays.
bool is_outside(const Bounds3& box, const Trs& camera, const ViewRange& range)
{
    bool outside[5] = {true, true, true, true, true};
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p((corner & 1) != 0 ? box.hi.x : box.lo.x,
                      (corner & 2) != 0 ? box.hi.y : box.lo.y,
                      (corner & 4) != 0 ? box.hi.z : box.lo.z);
        const Vec3d q = glm::conjugate(camera.rotate) * (p - camera.translate);
        outside[0] &= q.z > 0.0;
        outside[1] &= q.x > -range.hi.x * q.z;
        outside[2] &= q.x < -range.lo.x * q.z;
        outside[3] &= q.y > -range.hi.y * q.z;
        outside[4] &= q.y < -range.lo.y * q.z;
    }
    return outside[0] || outside[1] || outside[2] || outside[3] || outside[4];
}

/// Whether any of the boxes may be met by a ray of the tile.
template <class Boxes>
bool is_any_in_view(const Camera& camera, const Tile& tile, const Boxes& for_each_box)
{
    if (camera.lens_radius > 0.0f || camera.world_from_camera.is_moving()) return true;
    const ViewRange range = view_range(camera, tile);
    const Trs place = camera.world_from_camera.at(0.0f);
    bool in_view = false;
    for_each_box(
        [&](const Bounds3& box) { in_view |= !box.is_empty() && !is_outside(box, place, range); });
    return in_view;
}

}  // namespace

bool media_in_view(const Scene& scene)
{
    return media_in_view(scene, {0, 0, scene.camera.width, scene.camera.height});
}

bool media_in_view(const Scene& scene, const Tile& tile)
{
    return is_any_in_view(scene.camera, tile, [&](auto&& f) {
        for (const Volume& volume : scene.media.volumes) f(world_bounds(volume));
    });
}

bool surfaces_in_view(const Scene& scene, const Tile& tile)
{
    if (!scene.surfaces) return false;
    return is_any_in_view(scene.camera, tile, [&](auto&& f) { f(scene.surfaces->bvh->bounds()); });
}

}  // namespace mote
