#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/math.h"

namespace mote {

/// Triangles in object space. The front of a triangle is the side from which its vertices run
/// counterclockwise.
struct Mesh {
    std::vector<Vec3> positions;  ///< [m]
    std::vector<Vec3> normals;  ///< for shading, one per vertex [unit; 0: flat there]; empty: flat
    std::vector<Vec2> uvs;      ///< texture coordinates, one per vertex, v upwards; empty: none
    std::vector<glm::uvec3> triangles;  ///< indices into positions
    Bounds3 bounds;                     ///< of the triangles; filled by finish_mesh
};

/// What finish_mesh left out or mended.
struct MeshRepairs {
    size_t non_finite = 0;   ///< triangles dropped: a vertex was no finite number
    size_t degenerate = 0;   ///< triangles dropped: no area, or 1e12 times as long as wide
    size_t bad_normals = 0;  ///< vertices shaded flat: their normal had no finite length
    size_t bad_uvs = 0;      ///< texture coordinates that were not finite, now 0
};

/// Adds a polygon as a fan of triangles around its first corner, exact for convex ones (of others:
/// add_face). Fewer than three corners (lines, points) add nothing.
void add_polygon(Mesh& mesh, std::span<const uint32_t> corners);

/// Makes a mesh that was read safe to render: drops triangles without area or with vertices that
/// are not finite, makes normals unit length (0 where they have no direction), texture coordinates
/// finite, fills the bounds. `file` is for messages. Throws Error(Input) if an index is out of
/// range, a triangle has a vertex beyond max_file_coordinate, or nothing is left.
MeshRepairs finish_mesh(Mesh& mesh, const std::string& file);

/// The same, but a mesh of which nothing is left is no error.
MeshRepairs repair_mesh(Mesh& mesh, const std::string& file);

/// Normal of a triangle, twice its area long, towards its front.
[[nodiscard]] inline Vec3 area_normal(const Mesh& mesh, size_t triangle)
{
    const glm::uvec3 t = mesh.triangles[triangle];
    const Vec3 a = mesh.positions[t.x];
    return glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
}

/// Texture coordinates of a point of a triangle; u, v barycentric. Precondition: the mesh has them.
[[nodiscard]] inline Vec2 uv_at(const Mesh& mesh, size_t triangle, float u, float v)
{
    const glm::uvec3 t = mesh.triangles[triangle];
    return (1.0f - u - v) * mesh.uvs[t.x] + u * mesh.uvs[t.y] + v * mesh.uvs[t.z];
}

}  // namespace mote
