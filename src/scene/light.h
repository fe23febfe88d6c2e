#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "core/math.h"

namespace mote {

struct EnvironmentMap;
struct TriangleEmission;

/// Point light. intensity [W/sr].
struct PointLight {
    Vec3 position{0.0f};
    Spectrum intensity{1.0f};
};

/// Light from a point into a cone. It fades between the inner and the outer angle by a smoothstep
/// of the cosine.
struct SpotLight {
    Vec3 position{0.0f};
    Vec3 direction{0.0f, -1.0f, 0.0f};  ///< axis, away from the light [unit]
    Spectrum intensity{1.0f};           ///< within the inner cone [W/sr]
    float cos_inner = 0.9f;             ///< at least cos_outer
    float cos_outer = 0.8f;
};

/// Parallel light from infinity. `direction` points from the scene towards the light [unit];
/// irradiance [W/m^2] on a plane facing it.
struct DistantLight {
    Vec3 direction{0.0f, 1.0f, 0.0f};
    Spectrum irradiance{1.0f};
};

/// Sphere emitting `radiance` [W/(m^2 sr)] outwards: dark from inside. Not an obstacle to other
/// light.
struct SphereLight {
    Vec3 position{0.0f};
    float radius = 0.1f;
    Spectrum radiance{1.0f};
};

/// Parallelogram corner + [0,1] edge_u + [0,1] edge_v, emitting `radiance` on the side that
/// cross(edge_u, edge_v) points to (both sides if two_sided). Not an obstacle to other light.
struct QuadLight {
    Vec3 corner{0.0f};
    Vec3 edge_u{1.0f, 0.0f, 0.0f};
    Vec3 edge_v{0.0f, 0.0f, 1.0f};
    Spectrum radiance{1.0f};
    bool two_sided = false;
};

/// Triangle of an emissive mesh: corner + u edge_u + v edge_v, u + v <= 1, emitting on the side
/// that cross(edge_u, edge_v) points to (both sides if two_sided). Unlike lamps it is an obstacle,
/// and rays find it by its mesh.
struct TriangleLight {
    Vec3 corner{0.0f};
    Vec3 edge_u{1.0f, 0.0f, 0.0f};
    Vec3 edge_v{0.0f, 0.0f, 1.0f};
    Spectrum radiance{1.0f};  ///< textured: its mean over the triangle
    bool two_sided = false;
    float offset = 0.0f;  ///< shadow rays end this far in front of it, clear of its mesh [m]
    /// Null: the same radiance everywhere.
    std::shared_ptr<const TriangleEmission> texture = nullptr;
};

/// Light from all directions: a constant, or radiance times a latitude-longitude image.
struct EnvironmentLight {
    Spectrum radiance{1.0f};
    std::shared_ptr<const EnvironmentMap> map;  ///< null: constant
    glm::mat3 map_from_world{1.0f};             ///< a rotation
};

/// To add a light: write its struct, list it here, then fix the compile errors in light.cpp.
using Light =
    std::variant<PointLight, DistantLight, SphereLight, QuadLight, TriangleLight, SpotLight>;

/// Share of a spot's intensity at this cosine to its axis.
[[nodiscard]] float cone_falloff(float cosine, float cos_inner, float cos_outer);

/// Light arriving at a point along one sampled direction.
struct LightSample {
    Vec3 wi{0.0f};          ///< towards the light [unit]
    float distance = 0.0f;  ///< infinity for distant lights and environments [m]
    Spectrum Li{0.0f};      ///< unoccluded radiance (delta lights: irradiance at x facing wi)
    float pdf_dir = 0.0f;   ///< [1/sr]; 1 for delta lights
    bool is_delta = false;  ///< phase sampling can never hit it
};

/// Samples a direction from world point x towards the light, u in [0,1)^2. Empty if no light
/// reaches x.
[[nodiscard]] std::optional<LightSample> sample_light(const Light& light, Vec3 x, Vec2 u);

/// The inverse: u in [0,1)^2 for which sample_light goes from x to the point that hit_light meets
/// along wi. Empty where that meets nothing.
[[nodiscard]] std::optional<Vec2> light_numbers(const Light& light, Vec3 x, Vec3 wi);

/// Density [1/sr] with which sample_light picks wi from x; 0 for delta lights and misses. Whether a
/// ray meets the triangle of a mesh is the caller's to know.
[[nodiscard]] float light_pdf(const Light& light, Vec3 x, Vec3 wi);

/// Where a ray from x along wi first meets an area light's emitting side. Not for the triangles of
/// meshes, which rays meet otherwise: none there.
struct LightHit {
    float distance = infinity;
    Spectrum Le{0.0f};
};
[[nodiscard]] std::optional<LightHit> hit_light(const Light& light, Vec3 x, Vec3 wi);

/// Total emitted power [W] (distant lights: through a disk of the scene's radius).
[[nodiscard]] float light_power(const Light& light, float scene_radius);

/// Power [W] of a light that is as bright everywhere as this one is at its brightest: what choosing
/// among lights goes by. More than light_power for spots alone: within a narrow cone they are
/// bright whatever their power.
[[nodiscard]] float brightest_power(const Light& light, float scene_radius);

/// Box around a light; empty for distant lights.
[[nodiscard]] Bounds3 light_bounds(const Light& light);

}  // namespace mote
