#include "render/pixel_split.h"

#include <algorithm>

#include "core/parallel.h"
#include "render/seen_look.h"
#include "restir/in_view.h"

namespace mote {
namespace {

/// Lamps that are wider than this on the film cannot hide between the pixels' corners [px].
constexpr float wide_lamp = 8.0f;

/// Looks at the corners of a tile's pixels; marks those whose corners differ.
void mark_edges(const Camera& camera, const Seeable& seeable, const Tile& tile, uint8_t strata,
                SplitMap& map)
{
    const int width = tile.x1 - tile.x0 + 1;
    std::vector<SeenLook> above(static_cast<size_t>(width));
    std::vector<SeenLook> below(static_cast<size_t>(width));
    for (int y = tile.y0; y <= tile.y1; ++y) {
        for (int i = 0; i < width; ++i) {
            const auto k = static_cast<size_t>(i);
            const Ray ray = generate_ray(camera, Vec2(tile.x0 + i, y), Vec2(0.5f), 0.5f);
            below[k] = look_along(seeable, ray, i > 0 ? &below[k - 1] : &above[k]);
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

/// Of all pixels at most this share is marked for small lamps: those with most to gain. Where lamps
/// are everywhere, several rays cost more than they bring (measured: 1e5 lamps in smoke).
constexpr size_t lamp_share = 16;

/// Marks the pixels that small lamps may be seen in.
class LampMarks {
  public:
    LampMarks(const Camera& camera, float time, SplitMap& map)
        : map_(map), variance_(map.width(), map.height(), 0.0f)
    {
        const Trs place = camera.world_from_camera.at(time);
        eye_ = Vec3(place.translate);
        camera_from_world_ = Mat3(glm::mat3_cast(glm::conjugate(place.rotate)));
        per_tangent_ = 0.5f * static_cast<float>(camera.height) / camera.tan_half_fov_y;
    }

    /// False for lamps that are wide, or beside the camera: looks find those.
    bool add(const Bounds3& lamp, float radiance)
    {
        const Vec3 p = camera_from_world_ * (lamp.centre() - eye_);
        const float scale = per_tangent_ / -p.z;  // pixels per metre there
        const float radius = 0.5f * scale * glm::length(lamp.extent());
        if (!(glm::length(p) > glm::length(lamp.extent()))) return false;
        if (!(p.z < 0.0f)) return true;  // out of view
        if (!(2.0f * radius <= wide_lamp)) return false;
        const Vec2 size(map_.width(), map_.height());
        const Vec2 film = 0.5f * size + scale * Vec2(p.x, -p.y);
        const Vec2 lo = glm::clamp(film - radius, Vec2(0.0f), size);  // film may be huge
        const Vec2 hi = glm::min(film + radius, size - 1.0f);
        // Of one ray's light: brightness squared by the area, here over all pixels alike.
        const float pixels = sqr(1.0f + 2.0f * radius);
        const float share = sqr(radiance) * sqr(radius) / pixels + least_variance;
        for (int y = static_cast<int>(lo.y); static_cast<float>(y) <= hi.y; ++y) {
            for (int x = static_cast<int>(lo.x); static_cast<float>(x) <= hi.x; ++x) {
                variance_.at(x, y) += share;
            }
        }
        return true;
    }

    void mark(uint8_t strata)
    {
        std::vector<size_t> seen;
        for (size_t i = 0; i < variance_.size(); ++i) {
            if (variance_.data()[i] > 0.0f) seen.push_back(i);
        }
        const size_t most = std::max<size_t>(variance_.size() / lamp_share, 1);
        if (seen.size() > most) {
            const auto gains_more = [&](size_t a, size_t b) {
                const float va = variance_.data()[a];
                const float vb = variance_.data()[b];
                return va != vb ? va > vb : a < b;
            };
            std::nth_element(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(most),
                             seen.end(), gains_more);
            seen.resize(most);
        }
        for (const size_t i : seen) map_.data()[i] = strata;
    }

  private:
    static constexpr float least_variance = 1e-30f;
    SplitMap& map_;
    Buffer2D<float> variance_;
    Vec3 eye_{0.0f};
    Mat3 camera_from_world_{1.0f};
    float per_tangent_ = 1.0f;
};

/// Luminance of what a lamp's surface gives off; empty for lamps without one.
[[nodiscard]] std::optional<float> surface_radiance(const Light& light)
{
    return std::visit(
        [](const auto& lamp) -> std::optional<float> {
            if constexpr (requires { lamp.radiance; }) return luminance(lamp.radiance);
            return std::nullopt;
        },
        light);
}

}  // namespace

SplitMap find_split_pixels(const Scene& scene, int strata)
{
    const Camera& camera = scene.camera;
    if (strata < 2) return {};
    SplitMap map(camera.width, camera.height, 1);
    const auto mark = static_cast<uint8_t>(strata);
    LampMarks marks(camera, 0.5f, map);
    std::vector<Light> wide;
    bool has_lamps = false;
    for (const Light& light : scene.lights) {
        const std::optional<float> radiance = surface_radiance(light);
        has_lamps |= radiance.has_value();
        if (radiance && !marks.add(light_bounds(light), *radiance)) wide.push_back(light);
    }
    if (!scene.surfaces && !has_lamps) return {};
    marks.mark(mark);
    const LampSurfaces wide_lamps(wide);
    const Seeable seeable{scene.surfaces.get(), wide, wide_lamps};
    for_each_tile(camera.width, camera.height, [&](const Tile& tile) {
        if (surfaces_in_view(scene, tile) || !wide_lamps.is_empty()) {
            mark_edges(camera, seeable, tile, mark, map);
        }
    });
    return map;
}

}  // namespace mote
