// Lamps that touch surfaces, lie in them or are half sunk: on planes, edges and corners of
// triangles.
#include <gtest/gtest.h>

#include "stress/play.h"
#include "stress/stress_scenes.h"
#include "support/surface_scene.h"

namespace mote {
namespace {

constexpr float floor_height = -0.75f;
const Vec3 wall_corner(-1.3f, -0.9f, -1.1f);
const Vec3 wall_u(2.7f, 0.13f, -0.4f);
const Vec3 wall_v(0.17f, 2.1f, 0.31f);

/// On the slanted wall as well as floats can be: at shares of its edges.
Vec3 on_wall(float u, float v)
{
    return wall_corner + u * wall_u + v * wall_v;
}

/// Thin smoke over a floor at a round height, before a wall that no plane of floats holds.
Scene room_lit_by(const std::vector<Light>& lights)
{
    Scene scene = test::lit_clumps(1.5f);
    scene.lights = lights;
    test::add_surfaces(
        scene,
        {{test::quad_mesh({-4.0f, floor_height, -4.0f}, {0.0f, 0.0f, 8.0f}, {8.0f, 0.0f, 0.0f}),
          test::diffuse({0.6f, 0.5f, 0.4f})},
         {test::quad_mesh(wall_corner, wall_u, wall_v), test::diffuse({0.3f, 0.5f, 0.7f})}});
    return scene;
}

Light quad_on_floor(float height, bool two_sided = false)
{
    return QuadLight{{-0.6f, floor_height + height, 0.1f},
                     {0.0f, 0.0f, 0.7f},
                     {0.8f, 0.0f, 0.0f},
                     Spectrum(2.0f, 1.5f, 1.0f),
                     two_sided};
}

Light quad_on_wall(float height)
{
    const Vec3 front = glm::normalize(glm::cross(wall_u, wall_v));
    return QuadLight{on_wall(0.3f, 0.35f) + height * front, 0.3f * wall_u, 0.4f * wall_v,
                     Spectrum(1.0f, 1.5f, 2.0f), false};
}

Light sphere_over_floor(float height)
{
    return SphereLight{{0.3f, floor_height + height, 0.4f}, 0.2f, Spectrum(3.0f)};
}

struct Placed {
    const char* name;
    Light light;
};

std::vector<Placed> placed_lights()
{
    const Vec3 up(0.0f, 1.0f, 0.0f);
    const Spectrum one(1.0f);
    return {{"point on the floor", PointLight{{0.2f, floor_height, 0.3f}, one}},
            {"point on the diagonal of the floor", PointLight{{0.5f, floor_height, 0.5f}, one}},
            {"point on the wall", PointLight{on_wall(0.4f, 0.3f), one}},
            {"point on a corner of the wall", PointLight{wall_corner + wall_u, one}},
            {"spot on the floor", SpotLight{{0.2f, floor_height, 0.3f}, up, one, 0.9f, 0.5f}},
            {"sphere that touches the floor", sphere_over_floor(0.2f)},
            {"sphere half sunk in the floor", sphere_over_floor(0.0f)},
            {"sphere half sunk in the wall", SphereLight{on_wall(0.5f, 0.5f), 0.25f, one}},
            {"tiny sphere in the wall", SphereLight{on_wall(0.5f, 0.5f), 1e-6f, Spectrum(1e10f)}},
            {"quad in the floor", quad_on_floor(0.0f)},
            {"quad in the floor, two-sided", quad_on_floor(0.0f, true)},
            {"quad in the wall", quad_on_wall(0.0f)}};
}

TEST(StressLightsOnSurfaces, StaySound)
{
    for (const auto& [name, light] : placed_lights()) {
        test::expect_sound_in_every_way(room_lit_by({light}), name, 2);
    }
}

/// False once in 2,000 sets of seeds (36 comparisons, see expect_looks_like).
TEST(StressLightsOnSurfacesStat, LookAsThePathTracerSeesThem)
{
    for (const auto& [name, light] : placed_lights()) {
        test::expect_agreement(room_lit_by({light}), name);
    }
}

/// What lies in a surface is seen, and lights, as if it lay just above it.
TEST(StressLightsOnSurfacesStat, LampsInASurfaceAreNotHiddenByIt)
{
    test::expect_looks_like(room_lit_by({quad_on_floor(0.0f)}), room_lit_by({quad_on_floor(1e-4f)}),
                            "quad in the floor");
    test::expect_looks_like(room_lit_by({quad_on_wall(0.0f)}), room_lit_by({quad_on_wall(1e-4f)}),
                            "quad in the wall");
    test::expect_looks_like(room_lit_by({sphere_over_floor(0.2f)}),
                            room_lit_by({sphere_over_floor(0.2f + 1e-4f)}), "touching sphere");
}

}  // namespace
}  // namespace mote
