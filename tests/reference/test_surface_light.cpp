#include <gtest/gtest.h>

#include "reference/render.h"
#include "support/surface_scene.h"

namespace mote {
namespace {

// Light on surfaces against closed forms. The floor is the plane y = 0, seen at the origin.

const Ray at_floor{Vec3(0.8f, 0.7f, 0.4f), glm::normalize(Vec3(-0.8f, -0.7f, -0.4f)), 0.0f};
constexpr float floor_albedo = 0.7f;

test::Thing floor_thing()
{
    return {test::quad_mesh(Vec3(-9.0f, 0.0f, -10.0f), Vec3(0.0f, 0.0f, 20.0f),
                            Vec3(20.0f, 0.0f, 0.0f)),
            test::diffuse(Spectrum(floor_albedo))};
}

PathTracerParams once(LightStrategy strategy = LightStrategy::Mis)
{
    PathTracerParams params;
    params.max_bounces = 1;
    params.light_strategy = strategy;
    return params;
}

constexpr LightStrategy strategies[] = {LightStrategy::Auto, LightStrategy::Mis,
                                        LightStrategy::NextEvent, LightStrategy::Phase};

/// Radiance of a diffuse surface under this irradiance.
double radiance(double irradiance)
{
    return static_cast<double>(floor_albedo) / std::numbers::pi * irradiance;
}

TEST(SurfaceLightStat, LampsOverADiffuseFloor)
{
    // Irradiance: point I cos / d^2; distant E cos; sphere pi L (r / d)^2 cos; 5 standard errors.
    const double d2 = 0.25 + 4.0 + 1.0;
    const Vec3 p(0.5f, 2.0f, -1.0f);
    const double cosine = 2.0 / std::sqrt(d2);
    const Vec3 axis = glm::normalize(Vec3(-0.3f, -1.0f, -0.1f));
    const float to_floor = glm::dot(axis, glm::normalize(-p));
    const struct {
        Light light;
        double irradiance;
    } cases[] = {
        {PointLight{p, Spectrum(3.0f)}, 3.0 * cosine / d2},
        {DistantLight{glm::normalize(p), Spectrum(3.0f)}, 3.0 * cosine},
        // Half way between the cones: a half.
        {SpotLight{p, axis, Spectrum(3.0f), to_floor + 0.1f, to_floor - 0.1f},
         0.5 * 3.0 * cosine / d2},
        {SphereLight{p, 0.5f, Spectrum(2.0f)}, std::numbers::pi * 2.0 * 0.25 / d2 * cosine},
    };
    for (const auto& c : cases) {
        Scene scene;
        scene.lights = {c.light};
        test::add_surfaces(scene, {floor_thing()});
        for (const LightStrategy strategy : strategies) {
            const RunningStats stats = test::trace(scene, once(strategy), at_floor, 20'000, 1);
            EXPECT_LT(std::abs(stats.mean - radiance(c.irradiance)),
                      5.0 * stats.standard_error() + 1e-5)
                << c.light.index() << " " << stats.mean << " " << radiance(c.irradiance);
        }
    }
}

/// Form factor from a point to a parallel rectangle a x b at distance c, a corner right above it.
double corner_form_factor(double a, double b, double c)
{
    const double x = a / c;
    const double y = b / c;
    const double rx = std::sqrt(1.0 + x * x);
    const double ry = std::sqrt(1.0 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2.0 * std::numbers::pi);
}

/// A ceiling panel that shines down, as a mesh of 2 n^2 triangles.
test::Thing panel(float radiance_of_it)
{
    Material material = test::diffuse(Spectrum(0.0f), Spectrum(radiance_of_it));
    material.two_sided = false;
    return {test::quad_mesh(Vec3(0.0f, 1.5f, 0.0f), Vec3(2.0f, 0.0f, 0.0f), Vec3(0.0f, 0.0f, 1.0f)),
            material};
}

TEST(SurfaceLightStat, AnEmissivePanelHasItsFormFactor)
{
    Scene scene;
    test::add_surfaces(scene, {floor_thing(), panel(5.0f)});
    const double exact = radiance(std::numbers::pi * 5.0 * corner_form_factor(2.0, 1.0, 1.5));
    for (const LightStrategy strategy : strategies) {
        for (const LightSamplerKind kind : {LightSamplerKind::Power, LightSamplerKind::Tree}) {
            PathTracerParams params = once(strategy);
            params.light_sampler = kind;
            const RunningStats stats = test::trace(scene, params, at_floor, 20'000, 2);
            EXPECT_LT(test::z_score(stats, exact), 5.0) << stats.mean << " " << exact;
            EXPECT_LT(stats.standard_error(), 0.03 * exact);
        }
    }
    // Its dark side lights nothing, and covers the floor from lamps above it.
    scene = {};
    test::Thing upwards = panel(5.0f);
    upwards.trs.scale.y = -1.0;
    upwards.trs.translate.y = 3.0;
    scene.lights = {PointLight{Vec3(0.5f, 3.0f, 0.3f), Spectrum(1.0f)}};
    test::add_surfaces(scene, {floor_thing(), upwards});
    EXPECT_EQ(test::trace(scene, once(), at_floor, 2'000, 3).mean, 0.0);
}

TEST(SurfaceLightStat, EmissiveTrianglesAreCountedOnce)
{
    // Negative control: shadow rays and scattered rays without weights bring it twice.
    Scene scene;
    test::add_surfaces(scene, {floor_thing(), panel(5.0f)});
    const double exact = radiance(std::numbers::pi * 5.0 * corner_form_factor(2.0, 1.0, 1.5));
    const RunningStats a = test::trace(scene, once(LightStrategy::NextEvent), at_floor, 5'000, 4);
    const RunningStats b = test::trace(scene, once(LightStrategy::Phase), at_floor, 5'000, 5);
    EXPECT_GT(std::abs(a.mean + b.mean - exact), 5.0 * (a.standard_error() + b.standard_error()));
}

TEST(SurfaceLightStat, FloorsLitThroughSmokeFollowBeerAndLambert)
{
    // Smoke that only absorbs, 2 m thick above the floor: light and camera ray cross it slanted.
    Scene scene;
    Volume volume = test::constant_cube(40, 4.0f);
    volume.density_scale = 0.3f;
    volume.albedo = Spectrum(0.0f);
    volume.world_from_object.keys[0].translate = Vec3d(0.0, 1.0, 0.0);
    scene.media.volumes.push_back(volume);
    const Vec3 p(0.3f, 5.0f, -0.4f);
    scene.lights = {PointLight{p, Spectrum(30.0f)}};
    test::add_surfaces(scene, {floor_thing()});
    const auto shifted = [&](Vec3 a, Vec3 b) {  // depth with the volume moved back to the origin
        return test::marched_depth(volume, a - Vec3(0.0f, 1.0f, 0.0f), b - Vec3(0.0f, 1.0f, 0.0f),
                                   4000);
    };
    const double d2 = static_cast<double>(glm::dot(p, p));
    const double tau = shifted(Vec3(0.0f), p) + shifted(Vec3(0.0f), at_floor.o);
    const double exact = radiance(30.0 * 5.0 / std::sqrt(d2) / d2) * std::exp(-tau);
    for (const TransmittanceKind kind :
         {TransmittanceKind::Exact, TransmittanceKind::ResidualRatio}) {
        PathTracerParams params = once();
        params.transmittance = kind;
        const RunningStats stats = test::trace(scene, params, at_floor, 40'000, 6);
        EXPECT_LT(test::z_score(stats, exact), 5.0) << stats.mean << " " << exact;
    }
    const PathTracerParams params = once();
    const LightSampler lights = build_light_sampler(scene, params);
    for (uint32_t i = 0; i < 200; ++i) {
        Rng rng(7, 0, Stream::Test, i, 0);
        const PathResult path = trace_path(scene, lights, params, at_floor, rng);
        EXPECT_EQ(path.direct + path.indirect, Spectrum(0.0f));
        if (path.object == 0) {
            EXPECT_NEAR(path.depth, glm::length(at_floor.o), 1e-5f);
            EXPECT_EQ(path.albedo, Spectrum(floor_albedo));
        }
    }
}

TEST(SurfaceLight, SurfacesShadowSmoke)
{
    // A roof between the lamp and the smoke: the smoke scatters nothing, with and without
    // equiangular sampling; without the roof it does.
    Scene scene;
    Volume volume = test::constant_cube();
    volume.density_scale = 0.5f;
    scene.media.volumes.push_back(volume);
    scene.lights = {PointLight{Vec3(0.0f, 3.0f, 0.0f), Spectrum(1.0f)}};
    const Ray ray{Vec3(-3.0f, 0.0f, 0.0f), Vec3(1.0f, 0.0f, 0.0f), 0.0f};
    for (const bool is_equiangular : {false, true}) {
        PathTracerParams params = once();
        params.equiangular = is_equiangular;
        scene.surfaces = nullptr;
        EXPECT_GT(test::trace(scene, params, ray, 500, 8).mean, 0.0);
        test::Thing roof = floor_thing();
        roof.trs.translate.y = 2.0;
        test::add_surfaces(scene, {roof});
        EXPECT_EQ(test::trace(scene, params, ray, 500, 8).mean, 0.0);
        // Nor is smoke seen behind a wall.
        test::Thing wall = {test::quad_mesh(Vec3(-2.0f, -5.0f, -5.0f), Vec3(0.0f, 10.0f, 0.0f),
                                            Vec3(0.0f, 0.0f, 10.0f)),
                            test::diffuse(Spectrum(0.0f))};
        test::add_surfaces(scene, {wall});
        EXPECT_EQ(test::trace(scene, params, ray, 500, 8).mean, 0.0);
    }
}

/// A room with smoke, a glowing panel, lamps and things of every material, and an opening to a sky.
Scene room()
{
    Scene scene;
    Volume volume = test::clumpy_cube();
    volume.density_scale = 2.0f;
    volume.albedo = Spectrum(0.9f);
    volume.phase.g = 0.3f;
    scene.media.volumes.push_back(volume);
    scene.environment = EnvironmentLight{};
    scene.lights = {PointLight{Vec3(-1.0f, 0.9f, 0.8f), Spectrum(0.3f)},
                    SphereLight{Vec3(1.2f, -0.9f, -1.0f), 0.2f, Spectrum(2.0f)}};
    Mesh walls = test::box_mesh(Vec3(-2.0f), Vec3(2.0f), true);
    walls.triangles.erase(walls.triangles.begin());  // half a wall is open
    Material plastic;
    plastic.kind = MaterialKind::MetallicRoughness;
    plastic.roughness = 0.5f;
    plastic.base_color = Spectrum(0.8f, 0.3f, 0.2f);
    Material metal = plastic;
    metal.metallic = 1.0f;
    Material glass;
    glass.kind = MaterialKind::Dielectric;
    glass.roughness = 0.5f;
    glass.base_color = Spectrum(0.9f);
    const auto at = [](double x, double y, double z, double size) {
        Trs trs;
        trs.translate = Vec3d(x, y, z);
        trs.scale = Vec3d(size);
        return trs;
    };
    Trs ceiling = at(-0.5, 1.9, -0.5, 1.0);
    test::add_surfaces(
        scene, {{walls, test::diffuse(Spectrum(0.6f, 0.5f, 0.7f))},
                {test::sphere_mesh(1.0f, 10), plastic, at(0.8, -1.2, 0.6, 0.5)},
                {test::sphere_mesh(1.0f, 10), metal, at(-0.9, -1.0, -0.5, 0.6)},
                {test::box_mesh(Vec3(-1.0f), Vec3(1.0f)), glass, at(0.2, 0.1, 0.3, 0.4)},
                {test::quad_mesh(Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f), Vec3(0.0f, 0.0f, 1.0f)),
                 test::diffuse(Spectrum(0.5f), Spectrum(3.0f, 2.0f, 1.0f)), ceiling}});
    return scene;
}

const Ray into_room{Vec3(-1.7f, -0.2f, 1.5f), glm::normalize(Vec3(1.7f, -0.1f, -1.3f)), 0.0f};

TEST(SurfaceLightStat, EveryVariantHasTheSameMean)
{
    // 5 combined standard errors for 10 comparisons: a false alarm in 170,000 seeds.
    const Scene scene = room();
    PathTracerParams base;
    base.max_bounces = 4;
    base.roulette_start = 3;
    const RunningStats expected = test::trace(scene, base, into_room, 40'000, 9);
    EXPECT_LT(expected.standard_error(), 0.03 * expected.mean);
    std::vector<PathTracerParams> variants(10, base);
    variants[0].light_strategy = LightStrategy::Mis;
    variants[1].light_strategy = LightStrategy::NextEvent;
    variants[2].light_strategy = LightStrategy::Phase;
    variants[3].light_sampler = LightSamplerKind::Power;
    variants[4].light_sampler = LightSamplerKind::Tree;
    variants[5].mis = MisHeuristic::Balance;
    variants[6].equiangular = true;
    variants[7].roulette_start = 0;
    variants[8].transmittance = TransmittanceKind::Exact;
    variants[9].transmittance = TransmittanceKind::Ratio;
    for (size_t i = 0; i < variants.size(); ++i) {
        const RunningStats stats = test::trace(scene, variants[i], into_room, 20'000, 10);
        EXPECT_LT(test::z_score(stats, expected), 5.0)
            << "variant " << i << ": " << stats.mean << " +- " << stats.standard_error()
            << " against " << expected.mean << " +- " << expected.standard_error();
    }
}

TEST(SurfaceLight, PartsAreToldApart)
{
    const Scene scene = room();
    PathTracerParams params;
    params.max_bounces = 3;
    const LightSampler lights = build_light_sampler(scene, params);
    PathResult sum;
    for (uint32_t i = 0; i < 3'000; ++i) {
        Rng rng(11, 0, Stream::Test, i, 0);
        Ray ray = into_room;
        ray.d = glm::normalize(ray.d + 0.9f * (rng.uniform3() - 0.5f));
        const PathResult path = trace_path(scene, lights, params, ray, rng);
        sum.direct += path.direct;
        sum.indirect += path.indirect;
        sum.surface_direct += path.surface_direct;
        sum.surface_indirect += path.surface_indirect;
        sum.surface_emission += path.surface_emission;
        if (path.object >= 0) {
            EXPECT_EQ(path.direct + path.indirect, Spectrum(0.0f));
        } else {
            EXPECT_EQ(path.surface_direct + path.surface_indirect, Spectrum(0.0f));
        }
    }
    for (const Spectrum& part :
         {sum.direct, sum.indirect, sum.surface_direct, sum.surface_indirect}) {
        EXPECT_GT(part.y, 0.0f);
    }
}

}  // namespace
}  // namespace mote
