#include "march/march_lights.h"

#include "scene/environment.h"

namespace mote {
namespace {

/// Looks into each area of the sky this many times along each axis.
constexpr int sky_looks = 16;

MarchLight point_light(Vec3 position, Spectrum intensity)
{
    MarchLight light;
    light.place = position;
    light.power = intensity;
    return light;
}

MarchLight distant_light(Vec3 direction, Spectrum irradiance)
{
    MarchLight light = point_light(direction, irradiance);
    light.is_distant = true;
    return light;
}

MarchLight spot_light(const SpotLight& spot)
{
    MarchLight light = point_light(spot.position, spot.intensity);
    light.axis = spot.direction;
    light.cos_inner = spot.cos_inner;
    light.cos_outer = spot.cos_outer;
    return light;
}

/// Light of a flat lamp, by its area and normal.
MarchLight flat_light(Vec3 centre, Vec3 area, Spectrum radiance, bool two_sided)
{
    const float size = glm::length(area);
    if (!(size > 0.0f)) return point_light(centre, Spectrum(0.0f));
    MarchLight light = point_light(centre, size * radiance);
    light.facing = area / size;
    light.two_sided = two_sided;
    return light;
}

MarchLight reduce(const Light& light)
{
    return std::visit(
        [](const auto& lamp) -> MarchLight {
            using Lamp = std::decay_t<decltype(lamp)>;
            if constexpr (std::is_same_v<Lamp, PointLight>) {
                return point_light(lamp.position, lamp.intensity);
            } else if constexpr (std::is_same_v<Lamp, DistantLight>) {
                return distant_light(lamp.direction, lamp.irradiance);
            } else if constexpr (std::is_same_v<Lamp, SpotLight>) {
                return spot_light(lamp);
            } else if constexpr (std::is_same_v<Lamp, SphereLight>) {
                return point_light(lamp.position, pi * sqr(lamp.radius) * lamp.radiance);
            } else if constexpr (std::is_same_v<Lamp, QuadLight>) {
                return flat_light(lamp.corner + 0.5f * (lamp.edge_u + lamp.edge_v),
                                  glm::cross(lamp.edge_u, lamp.edge_v), lamp.radiance,
                                  lamp.two_sided);
            } else {
                return flat_light(lamp.corner + (lamp.edge_u + lamp.edge_v) / 3.0f,
                                  0.5f * glm::cross(lamp.edge_u, lamp.edge_v), lamp.radiance,
                                  lamp.two_sided);
            }
        },
        light);
}

Vec3 sky_direction(float band, float turn)
{
    const float y = 1.0f - 2.0f * band;
    const float r = std::sqrt(std::max(0.0f, 1.0f - y * y));
    return {r * std::cos(2.0f * pi * turn), y, r * std::sin(2.0f * pi * turn)};
}

void add_sky(const EnvironmentLight& sky, int bands, std::vector<MarchLight>& lights)
{
    const int turns = 2 * bands;
    const float solid_angle = 4.0f * pi / static_cast<float>(bands * turns);
    for (int i = 0; i < bands * turns; ++i) {
        const int band = i / turns;
        const int turn = i % turns;
        const auto place = [&](float u, float v) {
            return sky_direction((static_cast<float>(band) + u) / static_cast<float>(bands),
                                 (static_cast<float>(turn) + v) / static_cast<float>(turns));
        };
        Spectrum sum(0.0f);
        for (int k = 0; k < sky_looks * sky_looks; ++k) {
            const int row = k / sky_looks;
            const int column = k % sky_looks;
            const float u = (static_cast<float>(row) + 0.5f) / sky_looks;
            const float v = (static_cast<float>(column) + 0.5f) / sky_looks;
            sum += environment_radiance(sky, place(u, v));
        }
        const Spectrum mean = sum / static_cast<float>(sky_looks * sky_looks);
        lights.push_back(distant_light(place(0.5f, 0.5f), solid_angle * mean));
    }
}

}  // namespace

std::vector<MarchLight> march_lights(const Scene& scene, int sky_bands)
{
    std::vector<MarchLight> lights;
    const auto add = [&](const MarchLight& light) {
        if (max_component(light.power) > 0.0f) lights.push_back(light);
    };
    for (const Light& light : scene.lights) add(reduce(light));
    if (scene.environment) add_sky(*scene.environment, sky_bands, lights);
    return lights;
}

MarchArrival arrival(const MarchLight& light, Vec3 x)
{
    if (light.is_distant) return {light.place, infinity, light.power};
    const Vec3 to_light = light.place - x;
    const float distance = glm::length(to_light);
    if (!(distance > 0.0f)) return {};
    const Vec3 wi = to_light / distance;
    float cosine = 1.0f;
    if (light.facing != Vec3(0.0f)) {
        cosine = -glm::dot(light.facing, wi);
        cosine = light.two_sided ? std::abs(cosine) : std::max(0.0f, cosine);
    }
    if (light.axis != Vec3(0.0f)) {
        cosine = cone_falloff(glm::dot(light.axis, -wi), light.cos_inner, light.cos_outer);
    }
    return {wi, distance, light.power * (cosine / sqr(distance))};
}

}  // namespace mote
