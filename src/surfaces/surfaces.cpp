#include "surfaces/surfaces.h"

#include <embree3/rtcore.h>

#include "surfaces/cutout.h"

namespace mote {
namespace {

RTCRay make_ray(const Ray& ray, Interval range)
{
    return {ray.o.x, ray.o.y,  ray.o.z,  range.t0, ray.d.x, ray.d.y,
            ray.d.z, ray.time, range.t1, ~0u,      0,       0};
}

/// A triangle in object space. In double: floats' products are exact there.
struct ObjectTriangle {
    Vec3d a, e1, e2;

    ObjectTriangle(const Mesh& mesh, size_t triangle)
    {
        const glm::uvec3 t = mesh.triangles[triangle];
        a = Vec3d(mesh.positions[t.x]);
        e1 = Vec3d(mesh.positions[t.y]) - a;
        e2 = Vec3d(mesh.positions[t.z]) - a;
    }

    /// The point of which the corners have these weights, which sum to 1.
    [[nodiscard]] Vec3d at(Vec3d corners) const { return a + corners.y * e1 + corners.z * e2; }
};

constexpr double ulp = 0x1p-23;  // of a float in [1, 2)

/// Bound [m] on how far off its plane a point of the triangle may look to a ray that starts there:
/// the point is rounded to floats, Embree takes it to object space in floats, by an inverse in
/// floats, and there finds its distance from the plane in floats, with a normal in floats, which is
/// rough for slivers. `n` is the world normal, unit; a plane shifted by 1 in object space is
/// shifted by `world_shift` in the world. After Chiang 2023 (NVIDIA, Self-Intersection Avoidance).
float offset_bound(const InstanceFrame& frame, const ObjectTriangle& triangle, Vec3d p,
                   Vec3d n_object, Vec3d n, double world_shift)
{
    const Vec3d size = glm::abs(triangle.e1) + glm::abs(triangle.e2);
    const double extent = std::max(size.x, std::max(size.y, size.z));
    const double area = glm::length(glm::cross(triangle.e1, triangle.e2));
    const double sliver = extent * extent / area;
    glm::dmat3 spread;  // of the inverse, entry by entry
    for (int c = 0; c < 3; ++c) spread[c] = glm::abs(frame.inverse[c]);
    const Vec3d moved = spread * (glm::abs(p) + glm::abs(frame.offset));
    const double in_object =
        4.0 * ulp * glm::dot(moved, glm::abs(n_object)) + 2.0 * ulp * extent * (1.0 + sliver);
    const double in_world = 2.0 * ulp * glm::dot(glm::abs(p), glm::abs(n));
    return static_cast<float>(in_object * world_shift + in_world);
}

/// Distance from the triangle's edges [offsets] that its points keep. Where two walls meet, a point
/// nearer to the edge than rounding errors may lie behind the other wall, and see out of a closed
/// room from there.
constexpr double edge_distance = 1.0;
/// But no weight of a corner grows to more than this.
constexpr double most_inset = 0.1;

/// A hit's place in the triangle (weights of its corners), kept `distance` [m] from its edges.
Vec3d inset(const ObjectTriangle& triangle, const InstanceFrame& frame, Vec3d corners,
            double distance)
{
    const Vec3d e1 = frame.linear * triangle.e1;
    const Vec3d e2 = frame.linear * triangle.e2;
    const double area = glm::length(glm::cross(e1, e2));
    // A weight is the distance from the opposite edge over the height above that edge.
    const Vec3d edges(glm::length(e2 - e1), glm::length(e2), glm::length(e1));
    const Vec3d least = glm::min(distance / area * edges, Vec3d(most_inset));
    const Vec3d kept = glm::max(corners, least);
    return kept / (kept.x + kept.y + kept.z);
}

Vec3 shading_normal(const Mesh& mesh, const InstanceFrame& frame, const SurfaceHit& hit, Vec3 ng)
{
    if (mesh.normals.empty()) return ng;
    const glm::uvec3 t = mesh.triangles[static_cast<size_t>(hit.triangle)];
    const Vec3 mixed = (1.0f - hit.u - hit.v) * mesh.normals[t.x] + hit.u * mesh.normals[t.y] +
                       hit.v * mesh.normals[t.z];
    const Vec3d n = Vec3d(mixed) * frame.inverse;  // by the inverse's transpose
    const double length = glm::length(n);
    if (!(length > 1e-12)) return ng;
    const Vec3 ns(n / length);
    // Files disagree about which side normals are on; faces decide.
    return glm::dot(ns, ng) < 0.0f ? -ns : ns;
}

/// Directions on the surface along which u and v of the texture grow, in object space [m]; no
/// numbers where the coordinates span no area.
std::pair<Vec3d, Vec3d> texture_axes(const Mesh& mesh, size_t index, const ObjectTriangle& triangle)
{
    const glm::uvec3 t = mesh.triangles[index];
    const glm::dvec2 d1(mesh.uvs[t.y] - mesh.uvs[t.x]);
    const glm::dvec2 d2(mesh.uvs[t.z] - mesh.uvs[t.x]);
    const double determinant = d1.x * d2.y - d1.y * d2.x;
    return {(d2.y * triangle.e1 - d1.y * triangle.e2) / determinant,
            (d1.x * triangle.e2 - d2.x * triangle.e1) / determinant};
}

/// The shading normal turned as a normal map says; `ns` where that would leave the side of ng.
Vec3 mapped_normal(Vec3 ns, Vec3 ng, const std::pair<Vec3d, Vec3d>& axes,
                   const InstanceFrame& frame, Vec3 picture, float strength)
{
    const Vec3d n(ns);
    const Vec3d along_u = frame.linear * axes.first;
    const Vec3d tangent = along_u - n * glm::dot(n, along_u);
    const double length = glm::length(tangent);
    Vec3d other = glm::cross(n, tangent / length);
    if (glm::dot(other, frame.linear * axes.second) < 0.0) other = -other;  // mirrored coordinates
    const Vec3d map = 2.0 * Vec3d(picture) - 1.0;
    const Vec3d turned =
        static_cast<double>(strength) * (map.x * tangent / length + map.y * other) + map.z * n;
    const Vec3 out(turned / glm::length(turned));
    // Axes or pictures without a direction end in no number here.
    return glm::dot(out, ng) > 0.0f ? out : ns;
}

}  // namespace

void set_textures(Surfaces& surfaces, std::vector<MaterialTextures> textures)
{
    surfaces.textures = std::move(textures);
    surfaces.has_cuts = std::any_of(surfaces.textures.begin(), surfaces.textures.end(),
                                    [](const MaterialTextures& t) { return t.is_cut(); });
}

std::optional<SurfaceHit> intersect(const Surfaces& surfaces, const Ray& ray, Interval range)
{
    RTCRayHit query;
    query.ray = make_ray(ray, range);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    SurfaceQuery context(surfaces);
    rtcIntersect1(surfaces.bvh->embree(), &context.embree, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return SurfaceHit{query.ray.tfar, static_cast<int>(query.hit.instID[0]),
                      static_cast<int>(query.hit.primID), query.hit.u, query.hit.v};
}

bool is_occluded(const Surfaces& surfaces, const Ray& ray, Interval range)
{
    RTCRay query = make_ray(ray, range);
    SurfaceQuery context(surfaces);
    rtcOccluded1(surfaces.bvh->embree(), &context.embree, &query);
    return query.tfar < 0.0f;
}

SurfaceVertex make_vertex(const Surfaces& surfaces, const SurfaceHit& hit, float time)
{
    const Mesh& mesh = surfaces.mesh(hit.object);
    const InstanceFrame frame = surfaces.bvh->frame_at(static_cast<size_t>(hit.object), time);
    const ObjectTriangle triangle(mesh, static_cast<size_t>(hit.triangle));
    const Vec3d n_object = glm::normalize(glm::cross(triangle.e1, triangle.e2));
    const Vec3d scaled = n_object * frame.inverse;  // by the inverse's transpose
    const double stretch = glm::length(scaled);
    const Vec3d n = scaled / stretch;
    const Vec3d corners(1.0 - static_cast<double>(hit.u) - static_cast<double>(hit.v), hit.u,
                        hit.v);
    SurfaceVertex vertex;
    vertex.offset = offset_bound(frame, triangle, frame.point(triangle.at(corners)), n_object, n,
                                 1.0 / stretch);
    const double distance = edge_distance * static_cast<double>(vertex.offset);
    vertex.p = Vec3(frame.point(triangle.at(inset(triangle, frame, corners, distance))));
    vertex.ng = Vec3(n);
    vertex.ns = shading_normal(mesh, frame, hit, vertex.ng);
    vertex.material = surfaces.material(hit.object);
    const MaterialTextures* textures = surfaces.textures_of(hit.object);
    if (textures && !mesh.uvs.empty()) {
        const auto index = static_cast<size_t>(hit.triangle);
        const Vec2 uv = uv_at(mesh, index, hit.u, hit.v);
        vertex.material = material_at(vertex.material, *textures, uv);
        if (textures->normal) {
            vertex.ns =
                mapped_normal(vertex.ns, vertex.ng, texture_axes(mesh, index, triangle), frame,
                              Vec3(textures->normal->at(uv)), textures->normal_strength);
        }
    }
    vertex.object = hit.object;
    vertex.triangle = hit.triangle;
    return vertex;
}

WorldTriangle world_triangle(const InstanceFrame& frame, const Mesh& mesh, size_t index)
{
    const ObjectTriangle triangle(mesh, index);
    const Vec3d n_object = glm::normalize(glm::cross(triangle.e1, triangle.e2));
    const Vec3d scaled = n_object * frame.inverse;
    const double stretch = glm::length(scaled);
    const Vec3d n = scaled / stretch;
    const Vec3d a = frame.point(triangle.a);
    Vec3d edge_u = frame.linear * triangle.e1;
    Vec3d edge_v = frame.linear * triangle.e2;
    const bool is_mirrored = glm::dot(glm::cross(edge_u, edge_v), n) < 0.0;
    if (is_mirrored) std::swap(edge_u, edge_v);
    const Vec3d farthest =
        glm::max(glm::abs(a), glm::max(glm::abs(a + edge_u), glm::abs(a + edge_v)));
    WorldTriangle out{Vec3(a), Vec3(edge_u), Vec3(edge_v), 0.0f, is_mirrored};
    out.offset = offset_bound(frame, triangle, farthest, n_object, n, 1.0 / stretch);
    return out;
}

}  // namespace mote
