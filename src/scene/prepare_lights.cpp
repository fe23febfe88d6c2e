#include "scene/prepare_lights.h"

#include "core/rng.h"
#include "scene/evaluate_key.h"

namespace mote {
namespace {

/// Place of one copy of a light, in the light's object space.
Vec3 scattered_position(const LightDescription& light, int copy)
{
    if (light.count == 1) return light.position;
    Rng rng(light.seed, 0, Stream::Emitter, static_cast<uint32_t>(copy), 0);
    return light.position + light.spread * (rng.uniform3() - Vec3(0.5f));
}

Light make_light(const LightDescription& light, const Trs& trs, Spectrum strength, int copy)
{
    const Affine world_from_object = to_affine(matrix(trs));
    const Vec3 position = world_from_object.point(scattered_position(light, copy));
    switch (light.kind) {
        case LightKind::Distant: {
            const Vec3d direction = trs.rotate * glm::normalize(Vec3d(light.direction));
            return DistantLight{Vec3(direction), strength};
        }
        case LightKind::Spot: {
            const Vec3d direction = trs.rotate * glm::normalize(Vec3d(light.direction));
            const float outer = glm::radians(0.5f * light.cone_angle);
            return SpotLight{position, Vec3(direction), strength,
                             std::cos(outer * (1.0f - light.blend)), std::cos(outer)};
        }
        case LightKind::Sphere: {
            const Vec3 scale = glm::abs(Vec3(trs.scale));
            return SphereLight{position, light.radius * (scale.x + scale.y + scale.z) / 3.0f,
                               strength};
        }
        case LightKind::Quad:
            return QuadLight{position, world_from_object.vector(light.edge_u),
                             world_from_object.vector(light.edge_v), strength, light.two_sided};
        case LightKind::Point:
        case LightKind::Environment:
            break;
    }
    return PointLight{position, strength};
}

}  // namespace

Spectrum brightness_at(const LightDescription& light, double frame)
{
    const double strength =
        evaluate_key(light.keys, &LightKey::strength, static_cast<double>(light.strength), frame);
    const Vec3d color = evaluate_key(light.keys, &LightKey::color, Vec3d(light.color), frame);
    return static_cast<float>(strength) * Spectrum(color);
}

void scale_brightness(LightDescription& light, float factor)
{
    light.strength *= factor;
    for (LightKey& key : light.keys) {
        if (key.strength) *key.strength *= static_cast<double>(factor);
    }
}

std::vector<Light> make_lights(const std::vector<LightDescription>& descriptions, double frame)
{
    std::vector<Light> lights;
    for (const LightDescription& light : descriptions) {
        if (light.kind == LightKind::Environment || !light.particles.empty()) continue;
        const Spectrum strength = brightness_at(light, frame);
        const bool keeps_place = light.kind != LightKind::Distant && !light.keys.empty();
        if (!(max_component(strength) > 0.0f) && !keeps_place) continue;
        const Trs trs = evaluate(light.transform, frame);
        const bool is_swarm = light.kind == LightKind::Point || light.kind == LightKind::Spot ||
                              light.kind == LightKind::Sphere;
        const int copies = is_swarm ? light.count : 1;
        for (int i = 0; i < copies; ++i) lights.push_back(make_light(light, trs, strength, i));
    }
    return lights;
}

Mat3 map_from_world(const LightDescription& environment, double frame)
{
    const Trs trs = evaluate(environment.transform, frame);
    return Mat3(glm::mat3_cast(glm::conjugate(trs.rotate)));
}

}  // namespace mote
