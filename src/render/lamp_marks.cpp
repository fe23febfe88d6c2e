#include "render/lamp_marks.h"

#include <algorithm>
#include <vector>

namespace mote {
namespace {

/// Lamps that are wider than this on the film cannot hide between the pixels' corners [px].
constexpr float wide_lamp = 8.0f;
constexpr float least_variance = 1e-30f;

}  // namespace

LampMarks::LampMarks(const Camera& camera, float time)
    : variance_(camera.width, camera.height, 0.0f)
{
    const Trs place = camera.world_from_camera.at(time);
    eye_ = Vec3(place.translate);
    camera_from_world_ = Mat3(glm::mat3_cast(glm::conjugate(place.rotate)));
    per_tangent_ = 0.5f * static_cast<float>(camera.height) / camera.tan_half_fov_y;
}

bool LampMarks::add(const Bounds3& lamp, float radiance)
{
    const Vec3 p = camera_from_world_ * (lamp.centre() - eye_);
    const float scale = per_tangent_ / -p.z;  // pixels per metre there
    const float radius = 0.5f * scale * glm::length(lamp.extent());
    if (!(glm::length(p) > glm::length(lamp.extent()))) return false;
    if (!(p.z < 0.0f)) return true;  // out of view
    if (!(2.0f * radius <= wide_lamp)) return false;
    const Vec2 size(variance_.width(), variance_.height());
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

void LampMarks::mark(uint8_t value, float share, Buffer2D<uint8_t>& map) const
{
    std::vector<size_t> seen;
    for (size_t i = 0; i < variance_.size(); ++i) {
        if (variance_.data()[i] > 0.0f) seen.push_back(i);
    }
    const auto most =
        static_cast<size_t>(std::max(1.0f, share * static_cast<float>(variance_.size())));
    if (seen.size() > most) {
        const auto gains_more = [&](size_t a, size_t b) {
            const float va = variance_.data()[a];
            const float vb = variance_.data()[b];
            return va != vb ? va > vb : a < b;
        };
        std::nth_element(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(most), seen.end(),
                         gains_more);
        seen.resize(most);
    }
    for (const size_t i : seen) map.data()[i] = value;
}

}  // namespace mote
