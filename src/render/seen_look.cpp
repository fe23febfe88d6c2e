#include "render/seen_look.h"

#include "surfaces/bsdf.h"

namespace mote {
namespace {

/// Emission that differs by less of the brighter one counts as one.
constexpr float like_emission = 0.25f;
/// Lobes wider than this reflect much the same wherever normals are about the same.
constexpr float rough_alpha = 0.2f;
/// Distance between parallel planes, in distances from the camera, from which they are two.
constexpr float apart = 0.02f;

Vec3 geometric_normal(const Surfaces& surfaces, const SurfaceHit& hit, float time)
{
    const auto object = static_cast<size_t>(hit.object);
    const WorldTriangle triangle =
        world_triangle(surfaces.bvh->frame_at(object, time), surfaces.mesh(hit.object),
                       static_cast<size_t>(hit.triangle));
    const Vec3 n = glm::cross(triangle.edge_u, triangle.edge_v);
    return n / glm::length(n);
}

/// Cosine between normals whose reflections, by lobes of GGX alpha, are about the same: mirrors
/// turn twice as far as their normals do.
float like_normals(float alpha)
{
    return 1.0f - 0.5f * sqr(0.5f * alpha);
}

/// Whether a surface mirrors little things: a normal map's own detail is beyond a few rays.
bool is_glossy(const Surfaces& surfaces, int object)
{
    const Material& material = surfaces.material(object);
    if (material.kind != MaterialKind::MetallicRoughness || material.metallic < 0.5f) return false;
    const MaterialTextures* textures = surfaces.textures_of(object);
    return sqr(material.roughness) < rough_alpha && !(textures && textures->normal);
}

}  // namespace

SeenLook look_along(const Surfaces& surfaces, const Ray& ray, const SeenLook* near)
{
    SeenLook look;
    const std::optional<SurfaceHit> hit = intersect(surfaces, ray, {0.0f, infinity});
    if (!hit) return look;
    look.object = hit->object;
    look.triangle = hit->triangle;
    look.t = hit->t;
    look.p = ray.at(hit->t);
    if (is_glossy(surfaces, hit->object)) {
        const SurfaceVertex v = make_vertex(surfaces, *hit, ray.time);
        look.n = v.ns;
        look.like_normals = like_normals(std::max(sqr(v.material.roughness), min_alpha));
        look.Le = surface_emission(v, -ray.d);
        return look;
    }
    // What turns while the shutter is open turns little: normals are compared roughly.
    const bool is_same = near && near->object == hit->object && near->triangle == hit->triangle;
    look.n = is_same ? near->n : geometric_normal(surfaces, *hit, ray.time);
    if (surfaces.material(hit->object).is_emissive()) {
        look.Le = surface_emission(make_vertex(surfaces, *hit, ray.time), -ray.d);
    }
    return look;
}

bool looks_alike(const SeenLook& a, const SeenLook& b)
{
    if (!emits_alike(a.Le, b.Le) || a.object != b.object) return false;
    if (a.object < 0) return true;
    if (std::abs(glm::dot(a.n, b.n)) < std::min(a.like_normals, one_minus_epsilon)) return false;
    if (a.triangle == b.triangle) return true;
    return std::abs(glm::dot(a.p - b.p, a.n)) <= apart * std::min(a.t, b.t);
}

Spectrum lamp_light(std::span<const Light> lamps, const LampSurfaces& index, const Ray& ray)
{
    Spectrum sum(0.0f);
    index.for_each_on_ray(ray, [&](int i) {
        const std::optional<LightHit> hit = hit_light(lamps[static_cast<size_t>(i)], ray.o, ray.d);
        if (hit) sum += hit->Le;
    });
    return sum;
}

bool emits_alike(Spectrum a, Spectrum b)
{
    const float brightest = std::max(max_component(a), max_component(b));
    return max_component(glm::abs(a - b)) <= like_emission * brightest;
}

}  // namespace mote
