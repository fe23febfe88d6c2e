#include "scene/light.h"

#include "core/sampling.h"
#include "scene/triangle_emission.h"

namespace mote {
namespace {

std::optional<LightSample> sample(const PointLight& light, Vec3 x, Vec2 /*u*/)
{
    const Vec3 to_light = light.position - x;
    const float distance2 = glm::dot(to_light, to_light);
    if (!(distance2 > 0.0f)) return std::nullopt;
    const float distance = std::sqrt(distance2);
    return LightSample{to_light / distance, distance, light.intensity / distance2, 1.0f, true};
}

std::optional<LightSample> sample(const SpotLight& light, Vec3 x, Vec2 u)
{
    std::optional<LightSample> out = sample(PointLight{light.position, light.intensity}, x, u);
    if (!out) return out;
    const float falloff =
        cone_falloff(-glm::dot(light.direction, out->wi), light.cos_inner, light.cos_outer);
    if (!(falloff > 0.0f)) return std::nullopt;
    out->Li *= falloff;
    return out;
}

std::optional<LightSample> sample(const DistantLight& light, Vec3 /*x*/, Vec2 /*u*/)
{
    return LightSample{light.direction, infinity, light.irradiance, 1.0f, true};
}

/// 1 - cosine of the half angle under which the sphere is seen from outside; no cancellation for
/// small and distant spheres.
float one_minus_cos(const SphereLight& light, float distance2)
{
    const float sin2 = sqr(light.radius) / distance2;
    return sin2 / (1.0f + std::sqrt(1.0f - sin2));
}

/// Uniform over the cone of directions that meet the sphere.
std::optional<LightSample> sample(const SphereLight& light, Vec3 x, Vec2 u)
{
    const Vec3 to_centre = light.position - x;
    const float distance2 = glm::dot(to_centre, to_centre);
    const float radius2 = sqr(light.radius);
    if (!(distance2 > radius2) || !(radius2 > 0.0f)) return std::nullopt;
    const float cone = one_minus_cos(light, distance2);
    const float one_minus_cos_theta = u.x * cone;
    const float cos_theta = 1.0f - one_minus_cos_theta;
    const float sin2 = one_minus_cos_theta * (2.0f - one_minus_cos_theta);
    const float sin_theta = std::sqrt(sin2);
    const float phi = 2.0f * pi * u.y;
    const float distance = std::sqrt(distance2);
    const Vec3 wi = make_frame(to_centre / distance) *
                    Vec3(sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta);
    const float half_chord = std::sqrt(std::max(0.0f, radius2 - distance2 * sin2));
    return LightSample{wi, std::max(0.0f, distance * cos_theta - half_chord), light.radiance,
                       1.0f / (2.0f * pi * cone), false};
}

/// Uniform over the area.
std::optional<LightSample> sample(const QuadLight& light, Vec3 x, Vec2 u)
{
    const Vec3 normal_area = glm::cross(light.edge_u, light.edge_v);
    const Vec3 to_point = light.corner + u.x * light.edge_u + u.y * light.edge_v - x;
    const float distance2 = glm::dot(to_point, to_point);
    const float distance = std::sqrt(distance2);
    const Vec3 wi = to_point / distance;
    const float facing = -glm::dot(normal_area, wi);  // area times cosine
    const float cos_area = light.two_sided ? std::abs(facing) : facing;
    if (!(cos_area > 0.0f)) return std::nullopt;  // nor from the point itself
    return LightSample{wi, distance, light.radiance, distance2 / cos_area, false};
}

/// Uniform over the area.
std::optional<LightSample> sample(const TriangleLight& light, Vec3 x, Vec2 u)
{
    const Vec3 normal_area = 0.5f * glm::cross(light.edge_u, light.edge_v);
    const float root = std::sqrt(u.x);
    const Vec2 place(root * (1.0f - u.y), root * u.y);
    Vec3 to_point = light.corner + place.x * light.edge_u + place.y * light.edge_v - x;
    const float distance2 = glm::dot(to_point, to_point);
    const float distance = std::sqrt(distance2);
    const Vec3 wi = to_point / distance;
    const float facing = -glm::dot(normal_area, wi);  // area times cosine
    const float cos_area = light.two_sided ? std::abs(facing) : facing;
    if (!(cos_area > 0.0f)) return std::nullopt;  // nor from the point itself
    // The rounding of a long shadow ray's direction may carry its end through the triangle, too.
    const float margin = light.offset + 0x1p-22f * distance;
    to_point += std::copysign(margin, facing) * glm::normalize(normal_area);
    const float end = glm::length(to_point);
    if (!(glm::dot(to_point, wi) > 0.0f)) return std::nullopt;  // x is closer than the margin
    const Spectrum Le = light.texture ? light.texture->at(place) : light.radiance;
    return LightSample{to_point / end, end, Le, distance2 / cos_area, false};
}

std::optional<LightHit> hit(const PointLight& /*light*/, Vec3 /*x*/, Vec3 /*wi*/)
{
    return std::nullopt;
}

std::optional<LightHit> hit(const SpotLight& /*light*/, Vec3 /*x*/, Vec3 /*wi*/)
{
    return std::nullopt;
}

std::optional<LightHit> hit(const DistantLight& /*light*/, Vec3 /*x*/, Vec3 /*wi*/)
{
    return std::nullopt;
}

std::optional<LightHit> hit(const TriangleLight& /*light*/, Vec3 /*x*/, Vec3 /*wi*/)
{
    return std::nullopt;
}

std::optional<LightHit> hit(const SphereLight& light, Vec3 x, Vec3 wi)
{
    const Vec3 to_centre = light.position - x;
    const float along = glm::dot(to_centre, wi);
    const float radius2 = sqr(light.radius);
    if (!(along > 0.0f) || !(glm::dot(to_centre, to_centre) > radius2)) return std::nullopt;
    const Vec3 miss = to_centre - along * wi;
    const float half_chord2 = radius2 - glm::dot(miss, miss);
    if (!(half_chord2 >= 0.0f) || radius2 == 0.0f) return std::nullopt;
    return LightHit{std::max(0.0f, along - std::sqrt(half_chord2)), light.radiance};
}

/// Shares of the quad's edges at which a point of its plane lies.
Vec2 place_on(const QuadLight& light, Vec3 p)
{
    const Vec3 normal = glm::cross(light.edge_u, light.edge_v);
    const Vec3 q = p - light.corner;
    const float inv_area2 = 1.0f / glm::dot(normal, normal);
    return {glm::dot(glm::cross(q, light.edge_v), normal) * inv_area2,
            glm::dot(glm::cross(light.edge_u, q), normal) * inv_area2};
}

std::optional<LightHit> hit(const QuadLight& light, Vec3 x, Vec3 wi)
{
    const Vec3 normal = glm::cross(light.edge_u, light.edge_v);
    const float slope = glm::dot(normal, wi);
    if (!(light.two_sided ? slope != 0.0f : slope < 0.0f)) return std::nullopt;
    const float distance = glm::dot(light.corner - x, normal) / slope;
    if (!(distance > 0.0f)) return std::nullopt;
    const Vec2 u = place_on(light, x + distance * wi);
    if (!(u.x >= 0.0f && u.x <= 1.0f && u.y >= 0.0f && u.y <= 1.0f)) return std::nullopt;
    return LightHit{distance, light.radiance};
}

/// Of lights that rays do not meet.
template <class L>
std::optional<Vec2> numbers(const L& /*light*/, Vec3 /*x*/, Vec3 /*wi*/)
{
    return std::nullopt;
}

std::optional<Vec2> numbers(const SphereLight& light, Vec3 x, Vec3 wi)
{
    if (!hit(light, x, wi)) return std::nullopt;
    const Vec3 to_centre = light.position - x;
    const float distance2 = glm::dot(to_centre, to_centre);
    const Vec3 local = wi * make_frame(to_centre / std::sqrt(distance2));  // by its transpose
    const float sin2 = sqr(local.x) + sqr(local.y);
    const float one_minus_cos_theta = sin2 / (1.0f + std::sqrt(std::max(0.0f, 1.0f - sin2)));
    const float turn = std::atan2(local.y, local.x) / (2.0f * pi);
    return Vec2(one_minus_cos_theta / one_minus_cos(light, distance2),
                turn < 0.0f ? turn + 1.0f : turn);
}

std::optional<Vec2> numbers(const QuadLight& light, Vec3 x, Vec3 wi)
{
    const std::optional<LightHit> found = hit(light, x, wi);
    if (!found) return std::nullopt;
    return place_on(light, x + found->distance * wi);
}

float pdf(const PointLight& /*light*/, Vec3 /*x*/, Vec3 /*wi*/)
{
    return 0.0f;
}

float pdf(const SpotLight& /*light*/, Vec3 /*x*/, Vec3 /*wi*/)
{
    return 0.0f;
}

float pdf(const DistantLight& /*light*/, Vec3 /*x*/, Vec3 /*wi*/)
{
    return 0.0f;
}

float pdf(const SphereLight& light, Vec3 x, Vec3 wi)
{
    if (!hit(light, x, wi)) return 0.0f;
    const Vec3 to_centre = light.position - x;
    return 1.0f / (2.0f * pi * one_minus_cos(light, glm::dot(to_centre, to_centre)));
}

float pdf(const QuadLight& light, Vec3 x, Vec3 wi)
{
    const std::optional<LightHit> found = hit(light, x, wi);
    if (!found) return 0.0f;
    const float cos_area = std::abs(glm::dot(glm::cross(light.edge_u, light.edge_v), wi));
    return sqr(found->distance) / cos_area;
}

float pdf(const TriangleLight& light, Vec3 x, Vec3 wi)
{
    // Of the plane: the caller knows that the ray meets the triangle.
    const Vec3 normal_area = 0.5f * glm::cross(light.edge_u, light.edge_v);
    const float facing = -glm::dot(normal_area, wi);
    if (!(light.two_sided ? facing != 0.0f : facing > 0.0f)) return 0.0f;
    const float distance = glm::dot(light.corner - x, normal_area) / -facing;
    return sqr(distance) / std::abs(facing);
}

float power(const PointLight& light, float /*scene_radius*/)
{
    return 4.0f * pi * luminance(light.intensity);
}

float power(const SpotLight& light, float /*scene_radius*/)
{
    // The mean of a smoothstep is 1/2, and cosines are uniform over the sphere.
    const float solid_angle = 2.0f * pi * (1.0f - 0.5f * (light.cos_inner + light.cos_outer));
    return solid_angle * luminance(light.intensity);
}

float power(const DistantLight& light, float scene_radius)
{
    return pi * sqr(scene_radius) * luminance(light.irradiance);
}

float power(const SphereLight& light, float /*scene_radius*/)
{
    return 4.0f * sqr(pi * light.radius) * luminance(light.radiance);
}

float power(const QuadLight& light, float /*scene_radius*/)
{
    const float area = glm::length(glm::cross(light.edge_u, light.edge_v));
    return (light.two_sided ? 2.0f : 1.0f) * pi * area * luminance(light.radiance);
}

float power(const TriangleLight& light, float /*scene_radius*/)
{
    const float area = 0.5f * glm::length(glm::cross(light.edge_u, light.edge_v));
    return (light.two_sided ? 2.0f : 1.0f) * pi * area * luminance(light.radiance);
}

Bounds3 bounds(const PointLight& light)
{
    return {light.position, light.position};
}

Bounds3 bounds(const SpotLight& light)
{
    return {light.position, light.position};
}

Bounds3 bounds(const DistantLight& /*light*/)
{
    return {};
}

Bounds3 bounds(const SphereLight& light)
{
    return {light.position - light.radius, light.position + light.radius};
}

Bounds3 bounds(const QuadLight& light)
{
    Bounds3 box;
    box.extend(light.corner);
    box.extend(light.corner + light.edge_u);
    box.extend(light.corner + light.edge_v);
    box.extend(light.corner + light.edge_u + light.edge_v);
    return box;
}

Bounds3 bounds(const TriangleLight& light)
{
    Bounds3 box;
    box.extend(light.corner);
    box.extend(light.corner + light.edge_u);
    box.extend(light.corner + light.edge_v);
    return box;
}

}  // namespace

float cone_falloff(float cosine, float cos_inner, float cos_outer)
{
    if (cosine >= cos_inner) return 1.0f;
    if (!(cosine > cos_outer)) return 0.0f;
    const float t = (cosine - cos_outer) / (cos_inner - cos_outer);
    return sqr(t) * (3.0f - 2.0f * t);
}

std::optional<LightSample> sample_light(const Light& light, Vec3 x, Vec2 u)
{
    return std::visit([&](const auto& l) { return sample(l, x, u); }, light);
}

std::optional<Vec2> light_numbers(const Light& light, Vec3 x, Vec3 wi)
{
    const std::optional<Vec2> u =
        std::visit([&](const auto& l) { return numbers(l, x, wi); }, light);
    if (!u) return u;
    return glm::clamp(*u, Vec2(0.0f), Vec2(one_minus_epsilon));
}

float light_pdf(const Light& light, Vec3 x, Vec3 wi)
{
    return std::visit([&](const auto& l) { return pdf(l, x, wi); }, light);
}

std::optional<LightHit> hit_light(const Light& light, Vec3 x, Vec3 wi)
{
    return std::visit([&](const auto& l) { return hit(l, x, wi); }, light);
}

float light_power(const Light& light, float scene_radius)
{
    return std::visit([&](const auto& l) { return power(l, scene_radius); }, light);
}

float brightest_power(const Light& light, float scene_radius)
{
    if (const auto* spot = std::get_if<SpotLight>(&light)) {
        return 4.0f * pi * luminance(spot->intensity);
    }
    return light_power(light, scene_radius);
}

Bounds3 light_bounds(const Light& light)
{
    return std::visit([](const auto& l) { return bounds(l); }, light);
}

}  // namespace mote
