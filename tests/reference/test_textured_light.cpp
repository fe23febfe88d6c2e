#include <gtest/gtest.h>

#include "core/sampling.h"
#include "reference/render.h"
#include "scene/triangle_emission.h"
#include "support/surface_scene.h"

// Emissive surfaces with pictures and cuts, against quadrature.
namespace mote {
namespace {

constexpr float albedo = 0.7f;
const Ray at_floor{Vec3(0.8f, 0.7f, 0.4f), glm::normalize(Vec3(-0.8f, -0.7f, -0.4f)), 0.0f};
const Vec3 corner(-0.8f, 1.0f, -0.4f);
const Vec3 edge_u(1.5f, 0.0f, 0.0f);
const Vec3 edge_v(0.0f, 0.2f, 1.3f);

test::Thing floor_thing()
{
    return {test::quad_mesh(Vec3(-9.0f, 0.0f, -10.0f), Vec3(0.0f, 0.0f, 20.0f),
                            Vec3(20.0f, 0.0f, 0.0f)),
            test::diffuse(Spectrum(albedo))};
}

/// A panel above the floor whose picture is dark but for a few texels, and cut out in places.
test::Thing panel(bool is_cut, double mirror = 1.0)
{
    constexpr int size = 8;
    std::vector<float> texels;
    for (int i = 0; i < size * size; ++i) {
        const bool is_bright = i % 7 == 3;
        const float value = is_bright ? 40.0f : 0.1f;
        texels.insert(texels.end(), {value, 0.5f * value, 0.25f * value, i % 5 < 3 ? 1.0f : 0.0f});
    }
    test::Thing thing{test::quad_mesh(corner, edge_u, edge_v),
                      test::diffuse(Spectrum(0.0f), Spectrum(0.3f, 0.5f, 1.0f))};
    thing.textures.emission = std::make_shared<const Texture>(size, size, texels);
    if (is_cut) {
        thing.textures.color = thing.textures.emission;
        thing.textures.alpha_cutoff = 0.4f;
    }
    thing.trs.scale.x = mirror;
    return thing;
}

/// Luminance of the floor at the origin under the panel: midpoint rule over its area.
double quadrature(const test::Thing& thing)
{
    constexpr int n = 1200;
    const Vec3d u = Vec3d(edge_u) * thing.trs.scale;
    const Vec3d v = Vec3d(edge_v) * thing.trs.scale;
    const Vec3d normal = glm::cross(u, v);
    glm::dvec3 sum(0.0);
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const Vec2 uv((static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n);
            const Vec3d p = Vec3d(corner) * thing.trs.scale + static_cast<double>(uv.x) * u +
                            static_cast<double>(uv.y) * v;
            const double d2 = glm::dot(p, p);
            const double form = p.y * std::abs(glm::dot(normal, p)) / (d2 * d2);
            sum +=
                glm::dvec3(textured_emission(thing.material.emission, thing.textures, uv)) * form;
        }
    }
    const glm::dvec3 out = sum * (static_cast<double>(albedo) / std::numbers::pi / (n * n));
    return static_cast<double>(luminance(Spectrum(out)));
}

TEST(TexturedLightStat, PanelsLightTheFloorAsQuadratureSays)
{
    // 5 standard errors for 32 comparisons: a false alarm in 50,000 seeds.
    for (const bool is_cut : {false, true}) {
        for (const double mirror : {1.0, -1.0}) {
            const test::Thing thing = panel(is_cut, mirror);
            const double exact = quadrature(thing);
            Scene scene;
            test::add_surfaces(scene, {floor_thing(), thing});
            for (const LightStrategy strategy : {LightStrategy::Mis, LightStrategy::NextEvent,
                                                 LightStrategy::Phase, LightStrategy::Auto}) {
                for (const auto sampler : {LightSamplerKind::Power, LightSamplerKind::Tree}) {
                    PathTracerParams params;
                    params.max_bounces = 1;
                    params.light_strategy = strategy;
                    params.light_sampler = sampler;
                    const RunningStats stats = test::trace(scene, params, at_floor, 10'000, 1);
                    EXPECT_LT(test::z_score(stats, exact), 5.0)
                        << is_cut << " " << mirror << ": " << stats.mean << " " << exact;
                    EXPECT_LT(stats.standard_error(), 0.04 * exact);
                }
            }
        }
    }
}

TEST(TexturedLightStat, TheMeanInPlaceOfThePictureIsNoticed)
{
    // Negative control: the triangles' power is right, but not where on them it comes from.
    const test::Thing thing = panel(true);
    Scene scene;
    test::add_surfaces(scene, {floor_thing(), thing});
    for (Light& light : scene.lights) std::get<TriangleLight>(light).texture = nullptr;
    PathTracerParams params;
    params.max_bounces = 1;
    params.light_strategy = LightStrategy::NextEvent;
    const RunningStats stats = test::trace(scene, params, at_floor, 40'000, 1);
    EXPECT_GT(test::z_score(stats, quadrature(thing)), 5.0);
}

TEST(TexturedLight, PowerIsTheMeanOverTheTriangle)
{
    Scene scene;
    test::add_surfaces(scene, {panel(true)});
    ASSERT_EQ(scene.lights.size(), 2u);
    for (const Light& light : scene.lights) {
        const auto& triangle = std::get<TriangleLight>(light);
        constexpr int n = 700;
        glm::dvec3 sum(0.0);
        int count = 0;
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i + j < n; ++i, ++count) {
                sum += glm::dvec3(triangle.texture->at((Vec2(i, j) + Vec2(1.0f / 3.0f)) / Vec2(n)));
            }
        }
        const double exact =
            static_cast<double>(luminance(Spectrum(sum / static_cast<double>(count))));
        // Steps of a quarter of a texel: the edges of cuts may be off by half of one.
        EXPECT_NEAR(luminance(triangle.radiance), exact, 0.05 * exact);
    }
    // Costly means are sampled, but never 0 where something may shine.
    const auto& first = std::get<TriangleLight>(scene.lights[0]);
    EXPECT_GT(luminance(mean_emission(*first.texture, 1, Spectrum(1.0f))), 0.0009f);
}

}  // namespace
}  // namespace mote
