#include "restir/same.h"

#include <algorithm>

#include "scene/triangle_emission.h"

namespace mote {

bool is_same(const MovingTransform& a, const MovingTransform& b)
{
    return a == b;
}

bool is_same(const Light& a, const Light& b)
{
    if (a.index() != b.index()) return false;
    if (const auto* p = std::get_if<PointLight>(&a)) {
        const auto& q = std::get<PointLight>(b);
        return p->position == q.position && p->intensity == q.intensity;
    }
    if (const auto* p = std::get_if<SpotLight>(&a)) {
        const auto& q = std::get<SpotLight>(b);
        return p->position == q.position && p->direction == q.direction &&
               p->intensity == q.intensity && p->cos_inner == q.cos_inner &&
               p->cos_outer == q.cos_outer;
    }
    if (const auto* p = std::get_if<DistantLight>(&a)) {
        const auto& q = std::get<DistantLight>(b);
        return p->direction == q.direction && p->irradiance == q.irradiance;
    }
    if (const auto* p = std::get_if<SphereLight>(&a)) {
        const auto& q = std::get<SphereLight>(b);
        return p->position == q.position && p->radius == q.radius && p->radiance == q.radiance;
    }
    const auto is_same_area = [](const auto& p, const auto& q) {
        return p.corner == q.corner && p.edge_u == q.edge_u && p.edge_v == q.edge_v &&
               p.radiance == q.radiance && p.two_sided == q.two_sided;
    };
    if (const auto* p = std::get_if<TriangleLight>(&a)) {
        const auto& q = std::get<TriangleLight>(b);
        const bool is_same_look =
            p->texture && q.texture ? p->texture->is_same(*q.texture) : p->texture == q.texture;
        return is_same_look && is_same_area(*p, q);
    }
    return is_same_area(std::get<QuadLight>(a), std::get<QuadLight>(b));
}

bool have_same_lamps(std::span<const Light> a, std::span<const Light> b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Light& p, const Light& q) { return is_same(p, q); });
}

bool is_same(const EnvironmentLight& a, const EnvironmentLight& b)
{
    return a.radiance == b.radiance && a.map == b.map && a.map_from_world == b.map_from_world;
}

bool is_same(const Surfaces* a, const Surfaces* b)
{
    if (a == b || !a || !b) return a == b;
    const auto& p = a->bvh->instances();
    const auto& q = b->bvh->instances();
    if (p.size() != q.size() || !(a->materials == b->materials) || !(a->textures == b->textures)) {
        return false;
    }
    for (size_t i = 0; i < p.size(); ++i) {
        if (p[i].mesh != q[i].mesh || !is_same(p[i].world_from_object, q[i].world_from_object) ||
            a->objects[i].material != b->objects[i].material) {
            return false;
        }
    }
    return true;
}

bool is_same_look(const Volume& a, const Volume& b)
{
    const Emission& e = a.emission_params;
    const Emission& f = b.emission_params;
    return a.temperature == b.temperature && a.emission == b.emission && a.color == b.color &&
           a.albedo == b.albedo && a.phase.g == b.phase.g && a.phase.g_b == b.phase.g_b &&
           a.phase.weight_b == b.phase.weight_b && e.emission_scale == f.emission_scale &&
           e.emission_color == f.emission_color && e.blackbody_scale == f.blackbody_scale &&
           e.temperature_scale == f.temperature_scale &&
           e.temperature_offset == f.temperature_offset;
}

}  // namespace mote
