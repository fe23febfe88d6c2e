#pragma once

#include <optional>
#include <string>
#include <vector>

#include "surfaces/instance_bvh.h"
#include "surfaces/material_textures.h"
#include "surfaces/surface_vertex.h"

namespace mote {

/// A thing made of triangles: instance i of Surfaces::bvh.
struct SurfaceObject {
    std::string name;
    int material = 0;  ///< into Surfaces::materials
};

/// All surfaces of a frame. A scene without meshes has none of it.
struct Surfaces {
    std::vector<SurfaceObject> objects;
    std::vector<Material> materials;
    std::vector<MaterialTextures> textures;  ///< of each of materials; empty: none has any
    bool has_cuts = false;                   ///< any of textures is cut; see set_textures
    std::shared_ptr<const InstanceBvh> bvh;

    [[nodiscard]] const Mesh& mesh(int object) const
    {
        return bvh->instances()[static_cast<size_t>(object)].mesh->mesh();
    }
    [[nodiscard]] const Material& material(int object) const
    {
        return materials[static_cast<size_t>(material_index(object))];
    }
    [[nodiscard]] int material_index(int object) const
    {
        return objects[static_cast<size_t>(object)].material;
    }
    /// Null: the object's material is the same everywhere.
    [[nodiscard]] const MaterialTextures* textures_of(int object) const
    {
        if (textures.empty()) return nullptr;
        const MaterialTextures& found = textures[static_cast<size_t>(material_index(object))];
        return found.has_pictures() || found.is_cut() ? &found : nullptr;
    }
};

/// Gives the materials their pictures, one entry each.
void set_textures(Surfaces& surfaces, std::vector<MaterialTextures> textures);

/// Where a ray meets a triangle.
struct SurfaceHit {
    float t = 0.0f;  ///< [m]
    int object = -1;
    int triangle = -1;
    float u = 0.0f, v = 0.0f;  ///< barycentric, of the triangle's second and third corner
};

/// First triangle on the ray within the range, at the ray's time, where it is not cut out. Cost:
/// 0.1 to 0.5 us, and a texture look-up for every triangle that may be cut.
[[nodiscard]] std::optional<SurfaceHit> intersect(const Surfaces& surfaces, const Ray& ray,
                                                  Interval range);

/// Whether any triangle lies within the range, where it is not cut out.
[[nodiscard]] bool is_occluded(const Surfaces& surfaces, const Ray& ray, Interval range);

/// How far a light at this distance along a ray is from being hidden [m]: it may lie in a surface
/// itself, and distances to both are rounded, the more so the flatter the ray.
[[nodiscard]] inline float clear_distance(float distance)
{
    return distance * (1.0f - 0x1p-19f);
}

/// Whether a surface lies between the ray's origin and the light at `distance` along it (infinity:
/// all the way).
[[nodiscard]] inline bool is_shadowed(const Surfaces& surfaces, const Ray& ray, float distance)
{
    return is_occluded(surfaces, ray, {0.0f, clear_distance(distance)});
}

/// All about a hit at ray time `time`. The point comes from the triangle's corners rather than from
/// the ray, in double, so that it is as close to the surface as floats can be.
[[nodiscard]] SurfaceVertex make_vertex(const Surfaces& surfaces, const SurfaceHit& hit,
                                        float time);

/// A triangle in the world at ray time `time`, with the offset of rays that start anywhere on it.
struct WorldTriangle {
    Vec3 corner{0.0f}, edge_u{0.0f}, edge_v{0.0f};  ///< [m]; the front is along cross(u, v)
    float offset = 0.0f;                            ///< see SurfaceVertex
    bool is_mirrored = false;  ///< edge_u leads to the mesh triangle's third corner
};
[[nodiscard]] WorldTriangle world_triangle(const InstanceFrame& frame, const Mesh& mesh,
                                           size_t triangle);

}  // namespace mote
