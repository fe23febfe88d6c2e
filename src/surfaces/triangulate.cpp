#include "surfaces/triangulate.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace mote {
namespace {

using Point = glm::dvec2;

/// A corner, seen along the polygon's normal.
struct Corner {
    Point p;
    uint32_t vertex;
};
using Corners = std::vector<Corner>;

/// Twice the area of a triangle, > 0 if it runs counterclockwise. Products of floats' differences:
/// exact in double but for coordinates of very different size.
double turn(Point a, Point b, Point c)
{
    const Point ab = b - a;
    const Point ac = c - a;
    return ab.x * ac.y - ab.y * ac.x;
}

/// Drops the axis along which the polygon's mean normal (Newell's) is longest, so that it runs
/// counterclockwise. Empty if it has no area or no finite one.
Corners project(std::span<const Vec3> positions, std::span<const uint32_t> corners)
{
    Vec3d normal(0.0);
    const Vec3d origin(positions[corners[0]]);
    for (size_t i = 1; i + 1 < corners.size(); ++i) {
        normal += glm::cross(Vec3d(positions[corners[i]]) - origin,
                             Vec3d(positions[corners[i + 1]]) - origin);
    }
    const Vec3d size = glm::abs(normal);
    const double largest = std::max({size.x, size.y, size.z});
    if (!(largest > 0.0 && std::isfinite(largest))) return {};
    const int axis = size.x == largest ? 0 : size.y == largest ? 1 : 2;
    const bool is_mirrored = normal[axis] < 0.0;
    Corners out;
    out.reserve(corners.size());
    for (const uint32_t corner : corners) {
        const Vec3 p = positions[corner];
        Point q(p[(axis + 1) % 3], p[(axis + 2) % 3]);
        if (is_mirrored) std::swap(q.x, q.y);
        out.push_back({q, corner});
    }
    return out;
}

bool is_convex(const Corners& polygon)
{
    const size_t n = polygon.size();
    for (size_t i = 0; i < n; ++i) {
        const Point next = polygon[(i + 1) % n].p;
        if (turn(polygon[i].p, next, polygon[(i + 2) % n].p) < 0.0) return false;
    }
    return true;
}

/// Whether a line from corner i towards q starts inside of the polygon.
bool leads_inside(const Corners& polygon, size_t i, Point q)
{
    const size_t n = polygon.size();
    const Point before = polygon[(i + n - 1) % n].p;
    const Point p = polygon[i].p;
    const Point after = polygon[(i + 1) % n].p;
    const bool left_of_after = turn(p, after, q) >= 0.0;
    const bool right_of_before = turn(p, before, q) <= 0.0;
    return turn(before, p, after) >= 0.0 ? left_of_after && right_of_before
                                         : left_of_after || right_of_before;
}

/// The corner farthest to the left, lowest of several: the polygon is convex there.
size_t outermost(const Corners& polygon)
{
    const auto is_less = [](const Corner& a, const Corner& b) {
        return a.p.x != b.p.x ? a.p.x < b.p.x : a.p.y < b.p.y;
    };
    return static_cast<size_t>(std::min_element(polygon.begin(), polygon.end(), is_less) -
                               polygon.begin());
}

/// Of the corners in the triangle before, tip, after, the one farthest from the line between the
/// tip's neighbours: a diagonal leads there. The tip itself if there is none.
size_t blocking_corner(const Corners& polygon, size_t tip)
{
    const size_t n = polygon.size();
    const Point a = polygon[(tip + n - 1) % n].p;
    const Point v = polygon[tip].p;
    const Point b = polygon[(tip + 1) % n].p;
    size_t found = tip;
    double farthest = 0.0;
    for (size_t k = 2; k + 1 < n; ++k) {
        const size_t i = (tip + k) % n;
        const Point p = polygon[i].p;
        const double depth = turn(b, a, p);
        const bool is_within = turn(a, v, p) >= 0.0 && turn(v, b, p) >= 0.0;
        if (!(depth > 0.0) || !is_within || p == v || depth < farthest) continue;
        // Of corners at one place, the one from whose side the tip is seen.
        if (depth == farthest && !leads_inside(polygon, i, v)) continue;
        farthest = depth;
        found = i;
    }
    return found;
}

/// The corners from `first` to `last`, both included, around the end if need be.
Corners between(const Corners& polygon, size_t first, size_t last)
{
    Corners out;
    for (size_t i = first;; i = (i + 1) % polygon.size()) {
        out.push_back(polygon[i]);
        if (i == last) return out;
    }
}

/// Cuts off the triangle at the outermost corner or, if another corner lies in it, cuts the polygon
/// in two along a diagonal to that: each step one triangle or one diagonal.
void cut_up(Corners whole, Mesh& mesh)
{
    std::vector<Corners> rest{std::move(whole)};
    while (!rest.empty()) {
        Corners polygon = std::move(rest.back());
        rest.pop_back();
        while (polygon.size() > 3) {
            const size_t n = polygon.size();
            const size_t tip = outermost(polygon);
            const size_t other = blocking_corner(polygon, tip);
            if (other == tip) {
                mesh.triangles.emplace_back(polygon[(tip + n - 1) % n].vertex, polygon[tip].vertex,
                                            polygon[(tip + 1) % n].vertex);
                polygon.erase(polygon.begin() + static_cast<ptrdiff_t>(tip));
                continue;
            }
            rest.push_back(between(polygon, other, tip));
            polygon = between(polygon, tip, other);
        }
        mesh.triangles.emplace_back(polygon[0].vertex, polygon[1].vertex, polygon[2].vertex);
    }
}

}  // namespace

void add_face(Mesh& mesh, std::span<const uint32_t> corners, const std::string& place)
{
    const bool is_complete = std::all_of(corners.begin(), corners.end(), [&](uint32_t corner) {
        return corner < mesh.positions.size();  // else: finish_mesh throws
    });
    Corners polygon;
    if (corners.size() > 3 && is_complete) polygon = project(mesh.positions, corners);
    if (polygon.empty() || is_convex(polygon)) {
        add_polygon(mesh, corners);
        return;
    }
    if (polygon.size() > max_concave_corners) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: a face of {} corners is not convex; such have at most {}: "
                                "triangulate it where it was made",
                                place, polygon.size(), max_concave_corners));
    }
    cut_up(std::move(polygon), mesh);
}

}  // namespace mote
