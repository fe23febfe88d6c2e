#include "render/pixel_split.h"

#include "core/parallel.h"
#include "render/seen_look.h"
#include "restir/in_view.h"

namespace mote {
namespace {

/// Lamps that are wider than this on the film cannot hide between the pixels' corners [px].
constexpr float wide_lamp = 8.0f;

/// Looks at the corners of a tile's pixels; marks those whose corners differ.
void mark_edges(const Scene& scene, const LampSurfaces& lamps, const Tile& tile, uint8_t strata,
                SplitMap& map)
{
    const int width = tile.x1 - tile.x0 + 1;
    std::vector<SeenLook> above(static_cast<size_t>(width));
    std::vector<SeenLook> below(static_cast<size_t>(width));
    for (int y = tile.y0; y <= tile.y1; ++y) {
        for (int i = 0; i < width; ++i) {
            const auto k = static_cast<size_t>(i);
            const Ray ray = generate_ray(scene.camera, Vec2(tile.x0 + i, y), Vec2(0.5f), 0.5f);
            below[k] = look_along(scene, lamps, ray, i > 0 ? &below[k - 1] : &above[k]);
        }
        for (int i = 0; y > tile.y0 && i + 1 < width; ++i) {
            const auto k = static_cast<size_t>(i);
            const SeenLook& first = above[k];
            const bool is_smooth = looks_alike(first, above[k + 1]) &&
                                   looks_alike(first, below[k]) && looks_alike(first, below[k + 1]);
            if (!is_smooth) map.at(tile.x0 + i, y - 1) = strata;
        }
        std::swap(above, below);
    }
}

/// Marks the pixels that small lamps may be seen in.
class LampMarks {
  public:
    LampMarks(const Camera& camera, float time, uint8_t strata, SplitMap& map)
        : strata_(strata), map_(map)
    {
        const Trs place = camera.world_from_camera.at(time);
        eye_ = Vec3(place.translate);
        camera_from_world_ = Mat3(glm::mat3_cast(glm::conjugate(place.rotate)));
        per_tangent_ = 0.5f * static_cast<float>(camera.height) / camera.tan_half_fov_y;
    }

    void add(const Bounds3& lamp)
    {
        const Vec3 p = camera_from_world_ * (lamp.centre() - eye_);
        const float scale = per_tangent_ / -p.z;  // pixels per metre there
        const float radius = 0.5f * scale * glm::length(lamp.extent());
        if (!(p.z < 0.0f) || !(2.0f * radius <= wide_lamp)) return;
        const Vec2 size(map_.width(), map_.height());
        const Vec2 film = 0.5f * size + scale * Vec2(p.x, -p.y);
        const Vec2 lo = glm::max(film - radius, Vec2(0.0f));
        const Vec2 hi = glm::min(film + radius, size - 1.0f);
        for (int y = static_cast<int>(lo.y); static_cast<float>(y) <= hi.y; ++y) {
            for (int x = static_cast<int>(lo.x); static_cast<float>(x) <= hi.x; ++x) {
                map_.at(x, y) = strata_;
            }
        }
    }

  private:
    uint8_t strata_;
    SplitMap& map_;
    Vec3 eye_{0.0f};
    Mat3 camera_from_world_{1.0f};
    float per_tangent_ = 1.0f;
};

[[nodiscard]] bool has_surface(const Light& light)
{
    return std::holds_alternative<SphereLight>(light) || std::holds_alternative<QuadLight>(light) ||
           std::holds_alternative<TriangleLight>(light);
}

}  // namespace

SplitMap find_split_pixels(const Scene& scene, const LampSurfaces& lamps, int strata)
{
    const Camera& camera = scene.camera;
    if (strata < 2 || (!scene.surfaces && lamps.is_empty())) return {};
    SplitMap map(camera.width, camera.height, 1);
    const auto mark = static_cast<uint8_t>(strata);
    for_each_tile(camera.width, camera.height, [&](const Tile& tile) {
        if (surfaces_in_view(scene, tile) || !lamps.is_empty()) {
            mark_edges(scene, lamps, tile, mark, map);
        }
    });
    LampMarks marks(camera, 0.5f, mark, map);
    for (const Light& light : scene.lights) {
        if (has_surface(light)) marks.add(light_bounds(light));
    }
    return map;
}

}  // namespace mote
