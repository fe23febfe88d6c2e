#include "render/lamp_lists.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mote {
namespace {

/// Lamps that are wider on the film cannot hide between the pixels' corners [px].
constexpr double widest = 8.0;
/// Boxes are this much wider than what they hold, for the rounding of rays [px].
constexpr double margin = 1e-3;

/// In camera space, looking along +z, y upwards. Rays leave the eye as floats have it.
Vec3d seen_from(const Trs& place, Vec3 p)
{
    const Vec3d q = glm::conjugate(place.rotate) * (Vec3d(p) - Vec3d(Vec3(place.translate)));
    return {q.x, q.y, -q.z};
}

/// What a lamp covers of the plane at distance 1, the depths that it reaches over, and the largest
/// coordinate that rays to it are made of.
struct Outline {
    glm::dvec2 lo{std::numeric_limits<double>::infinity()};
    glm::dvec2 hi{-std::numeric_limits<double>::infinity()};
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0.0;
    double largest = 0.0;
};

Outline outline_of(const Trs& place, const SphereLight& sphere)
{
    const Vec3d p = seen_from(place, sphere.position);
    const auto r = static_cast<double>(sphere.radius);
    Outline out;
    out.nearest = p.z - r;
    out.farthest = p.z + r;
    out.largest = std::max(glm::length(place.translate), glm::length(Vec3d(sphere.position)));
    // Tangents from the eye, axis by axis.
    const double below = (p.z - r) * (p.z + r);
    for (int axis = 0; axis < 2; ++axis) {
        const double reach = r * std::sqrt(std::max(0.0, p[axis] * p[axis] + below));
        out.lo[axis] = (p[axis] * p.z - reach) / below;
        out.hi[axis] = (p[axis] * p.z + reach) / below;
    }
    return out;
}

Outline outline_of(const Trs& place, const QuadLight& quad)
{
    Outline out;
    for (int i = 0; i < 4; ++i) {
        const Vec3 corner = quad.corner + static_cast<float>(i & 1) * quad.edge_u +
                            static_cast<float>(i >> 1) * quad.edge_v;
        const Vec3d p = seen_from(place, corner);
        out.lo = glm::min(out.lo, glm::dvec2(p) / p.z);
        out.hi = glm::max(out.hi, glm::dvec2(p) / p.z);
        out.nearest = std::min(out.nearest, p.z);
        out.farthest = std::max(out.farthest, p.z);
        out.largest = std::max(out.largest, glm::length(Vec3d(corner)));
    }
    out.largest = std::max(out.largest, glm::length(place.translate));
    return out;
}

/// In doubles, as it may reach far beyond the film [px].
struct WideBox {
    glm::dvec2 lo;
    glm::dvec2 hi;
};

std::optional<WideBox> box_of(const Camera& camera, const Outline& outline)
{
    if (!(outline.nearest > 0.0)) return std::nullopt;
    const glm::dvec2 middle(0.5 * camera.width, 0.5 * camera.height);
    const double per_tangent = middle.y / static_cast<double>(camera.tan_half_fov_y);
    double blur = 0.0;
    if (camera.lens_radius > 0.0f) {
        const double sharp = 1.0 / static_cast<double>(camera.focus_distance);
        blur = static_cast<double>(camera.lens_radius) *
               std::max(std::abs(1.0 / outline.nearest - sharp),
                        std::abs(1.0 / outline.farthest - sharp));
    }
    // Origins and directions of rays are floats.
    const double rounding = 0x1p-22 + 0x1p-22 * outline.largest / outline.nearest;
    const double rim = per_tangent * (blur + rounding) + margin;
    return WideBox{middle + per_tangent * glm::dvec2(outline.lo.x, -outline.hi.y) - rim,
                   middle + per_tangent * glm::dvec2(outline.hi.x, -outline.lo.y) + rim};
}

/// Times that a moving camera is looked at, per key. Between two of them a lamp is taken to stray
/// from the straight way by less than the whole way: motion between keys is smooth.
constexpr int times_per_key = 8;

template <class Lamp>
std::optional<WideBox> box_over_shutter(const Camera& camera, std::span<const Trs> poses,
                                        const Lamp& lamp)
{
    std::optional<WideBox> all;
    WideBox before{};
    double stride = 0.0;
    for (const Trs& pose : poses) {
        const std::optional<WideBox> box = box_of(camera, outline_of(pose, lamp));
        if (!box) return std::nullopt;
        if (all) {
            const glm::dvec2 low = glm::abs(box->lo - before.lo);
            const glm::dvec2 high = glm::abs(box->hi - before.hi);
            stride = std::max({stride, low.x, low.y, high.x, high.y});
            all = WideBox{glm::min(all->lo, box->lo), glm::max(all->hi, box->hi)};
        } else {
            all = box;
        }
        before = *box;
    }
    return WideBox{all->lo - stride, all->hi + stride};
}

/// Calls f(index of a pixel) for those that a box lies in.
template <class F>
void for_each_pixel(const FilmBox& box, int width, int height, F&& f)
{
    if (box.is_empty()) return;
    const int x1 = std::min(static_cast<int>(box.hi.x), width - 1);
    const int y1 = std::min(static_cast<int>(box.hi.y), height - 1);
    for (int y = static_cast<int>(box.lo.y); y <= y1; ++y) {
        for (int x = static_cast<int>(box.lo.x); x <= x1; ++x) {
            f(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
        }
    }
}

}  // namespace

std::vector<Trs> shutter_poses(const Camera& camera)
{
    const MovingTransform& motion = camera.world_from_camera;
    const int steps = static_cast<int>(motion.keys.size() - 1) * times_per_key;
    std::vector<Trs> poses{motion.at(0.0f)};
    for (int i = 1; i <= steps; ++i) {
        poses.push_back(motion.at(static_cast<float>(i) / static_cast<float>(steps)));
    }
    return poses;
}

std::optional<FilmBox> film_box(const Camera& camera, std::span<const Trs> poses,
                                const Light& light)
{
    std::optional<WideBox> box;
    if (const auto* sphere = std::get_if<SphereLight>(&light)) {
        box = box_over_shutter(camera, poses, *sphere);
    } else if (const auto* quad = std::get_if<QuadLight>(&light)) {
        box = box_over_shutter(camera, poses, *quad);
    }
    if (!box) return std::nullopt;
    const glm::dvec2 extent = box->hi - box->lo;
    if (!(extent.x <= widest && extent.y <= widest)) return std::nullopt;
    const glm::dvec2 size(camera.width, camera.height);
    return FilmBox{Vec2(glm::clamp(box->lo, glm::dvec2(0.0), size)),
                   Vec2(glm::clamp(box->hi, glm::dvec2(0.0), size))};
}

LampLists list_lamps(std::vector<FilmBox> boxes, uint8_t crowded, Buffer2D<uint8_t>& map)
{
    LampLists lists;
    lists.boxes = std::move(boxes);
    lists.width = map.width();
    const int width = map.width();
    const int height = map.height();
    std::vector<uint32_t> count(map.size(), 0);
    for (const FilmBox& box : lists.boxes) {
        for_each_pixel(box, width, height,
                       [&](size_t i) { count[i] = std::min(count[i] + 1, LampLists::most + 1); });
    }
    lists.first.assign(map.size() + 1, 0);
    for (size_t i = 0; i < map.size(); ++i) {
        if (count[i] > LampLists::most) {
            map.data()[i] = crowded;
            count[i] = 0;
        }
        lists.first[i + 1] = lists.first[i] + count[i];
    }
    lists.lamps.resize(lists.first.back());
    std::vector<uint32_t> end(lists.first.begin(), lists.first.end() - 1);
    for (size_t light = 0; light < lists.boxes.size(); ++light) {
        for_each_pixel(lists.boxes[light], width, height, [&](size_t i) {
            if (lists.first[i] < lists.first[i + 1]) {
                lists.lamps[end[i]++] = static_cast<uint32_t>(light);
            }
        });
    }
    return lists;
}

}  // namespace mote
