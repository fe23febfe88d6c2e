#include "restir/local_light.h"

#include <cmath>

namespace mote {
namespace {

bool is_usable(const LocalLight& light)
{
    return light.power > 0.0f && std::isfinite(light.power) && is_finite(light.position) &&
           std::isfinite(light.spread2);
}

void place(const PointLight& lamp, LocalLight& out)
{
    out.position = lamp.position;
}

/// Choosing takes what faces x to be three times as bright as its power over the sphere.
void place(const SpotLight& lamp, LocalLight& out)
{
    out.position = lamp.position;
    const bool has_side = lamp.cos_outer >= 0.0f;
    if (has_side) out.facing = lamp.direction;
    out.power = 4.0f * pi * luminance(lamp.intensity) / (has_side ? 3.0f : 1.0f);
}

void place(const SphereLight& lamp, LocalLight& out)
{
    out.position = lamp.position;
    out.spread2 = sqr(lamp.radius);
}

void place(const QuadLight& lamp, LocalLight& out)
{
    out.position = lamp.corner + 0.5f * (lamp.edge_u + lamp.edge_v);
    out.spread2 = (glm::dot(lamp.edge_u, lamp.edge_u) + glm::dot(lamp.edge_v, lamp.edge_v)) / 12.0f;
    if (!lamp.two_sided) out.facing = glm::normalize(glm::cross(lamp.edge_u, lamp.edge_v));
}

void place(const TriangleLight& lamp, LocalLight& out)
{
    const Vec3 u = lamp.edge_u;
    const Vec3 v = lamp.edge_v;
    out.position = lamp.corner + (u + v) / 3.0f;
    out.spread2 = (glm::dot(u, u) + glm::dot(v, v) - glm::dot(u, v)) / 18.0f;
    if (!lamp.two_sided) out.facing = glm::normalize(glm::cross(u, v));
}

void place(const DistantLight& /*lamp*/, LocalLight& out)
{
    out.power = 0.0f;
}

}  // namespace

std::vector<LocalLight> local_lights(std::span<const Light> lamps)
{
    std::vector<LocalLight> out;
    for (size_t i = 0; i < lamps.size(); ++i) {
        LocalLight light;
        light.id = static_cast<int>(i);
        light.power = light_power(lamps[i], 0.0f);
        std::visit([&](const auto& lamp) { place(lamp, light); }, lamps[i]);
        if (is_usable(light)) out.push_back(light);
    }
    return out;
}

void add_emissive_volume(const Volume& volume, const EmissiveBricks& bricks, int id,
                         std::vector<LocalLight>& lights)
{
    if (bricks.empty()) return;
    const Mat4d world_from_object = matrix(volume.world_from_object.at(0.5f));
    Vec3d sum(0.0);
    double sum2 = 0.0;
    for (const EmissiveBricks::Brick& brick : bricks.bricks) {
        const BrickGrid& grid = *bricks.parts[brick.part].grid;
        const Vec3 middle = Vec3(grid.lo) + 8.0f * (Vec3(brick.position) + 0.5f);
        const Vec3d p_object = glm::inverse(glm::dmat3(grid.index_from_object.linear)) *
                               Vec3d(middle - grid.index_from_object.offset);
        const Vec3d p(world_from_object * glm::dvec4(p_object, 1.0));
        sum += static_cast<double>(brick.power) * p;
        sum2 += static_cast<double>(brick.power) * glm::dot(p, p);
    }
    const Vec3d centre = sum / bricks.total_power;
    LocalLight light;
    light.id = id;
    light.position = Vec3(centre);
    light.spread2 =
        static_cast<float>(std::max(0.0, sum2 / bricks.total_power - glm::dot(centre, centre)));
    const double scale = std::abs(glm::determinant(glm::dmat3(world_from_object)));
    light.power = static_cast<float>(bricks.total_power * scale);
    if (is_usable(light)) lights.push_back(light);
}

}  // namespace mote
