// Where lights, events and surfaces coincide, or are as far apart or as bright as floats go: light
// is found or not, but never something that is no number.
#include <gtest/gtest.h>

#include "reference/direct_light.h"
#include "reference/light_sampler.h"
#include "reference/mis.h"
#include "reference/visibility.h"
#include "support/media.h"
#include "support/surface_scene.h"

namespace mote {
namespace {

const Phase even;
const Vec3 up(0.0f, 1.0f, 0.0f);

/// A scene, and what the path tracer needs of it.
struct Tracing {
    Scene scene;
    PathTracerParams params;
    LightSampler lights;
    TraceContext context{scene, lights, params};

    explicit Tracing(Scene s, PathTracerParams p = {})
        : scene(std::move(s)), params(p), lights(scene, params)
    {
    }
    Tracing(const Tracing&) = delete;
    Tracing& operator=(const Tracing&) = delete;
};

Scene scene_with(std::vector<Light> lights)
{
    Scene scene;
    scene.media.volumes.push_back(test::constant_cube());
    scene.lights = std::move(lights);
    return scene;
}

Rng rng_of(uint32_t i)
{
    return {1, 0, Stream::Test, i, 0};
}

TEST(MisGuards, DensitiesOfZeroWeighNothing)
{
    for (const MisHeuristic mis : {MisHeuristic::Balance, MisHeuristic::Power}) {
        for (const float other : {0.0f, 1e-30f, 1.0f}) {
            EXPECT_EQ(mis_weight(mis, 0.0f, other), 0.0f);
            EXPECT_EQ(mis_weight(mis, 0.0f, other, 0.0f), 0.0f);
        }
    }
}

/// Their power is beyond floats: as rays meet them anyway, no shadow ray has to look for them.
TEST(LightSamplerGuards, LampsTooBrightForNumbersAreLeftToScatteredRays)
{
    const SphereLight dazzling{Vec3(0.0f, 0.0f, 5e6f), 1e6f, Spectrum(1e30f)};
    for (const LightSamplerKind kind :
         {LightSamplerKind::Power, LightSamplerKind::PowerDistance, LightSamplerKind::Tree}) {
        PathTracerParams params;
        params.light_sampler = kind;
        params.light_strategy = LightStrategy::NextEvent;
        const Tracing t(
            scene_with({PointLight{up, Spectrum(1.0f)}, dazzling, PointLight{-up, Spectrum(1.0f)}}),
            params);
        EXPECT_EQ(t.lights.pmf(LightSource::Lamp, 1, Vec3(0.0f)), 0.0f);
        EXPECT_FLOAT_EQ(t.lights.pmf(LightSource::Lamp, 0, Vec3(0.0f)), 0.5f);
        EXPECT_FLOAT_EQ(t.lights.pmf(LightSource::Lamp, 2, Vec3(0.0f)), 0.5f);
        const LightRay ray{{Vec3(0.0f), Vec3(0.0f, 0.0f, 1.0f)}, 0.1f, false};
        Rng rng = rng_of(0);
        EXPECT_EQ(seen_light(t.context, ray, infinity, rng).lamps, dazzling.radiance);
    }
}

TEST(LightSamplerGuards, DistantLightsReachScenesWithoutEnd)
{
    for (const double scale : {1e-20, 1e20, 1e37}) {
        Scene scene = scene_with({DistantLight{up, Spectrum(1.0f)}});
        scene.media.volumes[0].world_from_object.keys[0].scale = Vec3d(scale);
        const Tracing t(std::move(scene));
        EXPECT_EQ(t.lights.pmf(LightSource::Lamp, 0, Vec3(0.0f)), 1.0f) << scale;
    }
}

TEST(LightSamplerGuards, GuidesMayKnowOfNoLamp)
{
    class Clueless final : public LightGuide {
      public:
        [[nodiscard]] Choice choose(Vec3, double) const override { return {}; }
        [[nodiscard]] float pmf(int, Vec3) const override { return 0.0f; }
    };
    PathTracerParams params;
    params.light_sampler = LightSamplerKind::Tree;
    const PointLight lamp{up, Spectrum(1.0f)};
    const Tracing t(scene_with({lamp, lamp}), params);
    Rng rng = rng_of(0);
    const Clueless guide;
    EXPECT_TRUE(t.lights.choose(Vec3(0.0f), rng));
    EXPECT_FALSE(t.lights.choose(Vec3(0.0f), rng, &guide));
}

/// Of no measurable size: densities overflow.
TEST(DirectLightGuards, LampsOfNextToNoSizeBringNoNumbersThatAreNone)
{
    PathTracerParams params;
    params.light_strategy = LightStrategy::Mis;
    params.equiangular = true;
    const Vec3 place(0.0f, 0.0f, 0.5f);
    const Tracing t(scene_with({SphereLight{place, 1e-20f, Spectrum(1.0f)}}), params);
    const Media& media = t.scene.media;
    const Ray camera{Vec3(0.1f, 0.0f, -3.0f), Vec3(0.0f, 0.0f, 1.0f)};
    const std::optional<CameraSegment> segment = make_camera_segment(media, camera, infinity);
    ASSERT_TRUE(segment);
    for (uint32_t i = 0; i < 100; ++i) {
        Rng rng = rng_of(i);
        const float z = 0.8f * rng.uniform();
        const FirstEvent first = make_first_event(media, *segment, 3.0f + z);
        const ScatterEvent event{camera.at(first.t), -camera.d, 0.0f, &even, &first};
        EXPECT_TRUE(is_finite(estimate_direct_light(t.context, event, rng)));
        EXPECT_TRUE(is_finite(estimate_equiangular(t.context, *segment, rng)));
        const LightRay right_at_it{
            {place - Vec3(0.0f, 0.0f, z), Vec3(0.0f, 0.0f, 1.0f)}, 0.1f, false};
        EXPECT_TRUE(is_finite(seen_light(t.context, right_at_it, infinity, rng).lamps));
    }
}

/// The event is where the emission is looked for, or nothing glows there.
TEST(DirectLightGuards, ShadowRaysToEmissionHaveALengthAndBringLight)
{
    Scene scene;
    // Glows in one half of its bricks alone.
    Volume volume = test::cube_volume(16, 2.0f, [](Vec3 p) { return p.x > 0.3f ? 1.0f : 0.0f; });
    volume.emission = volume.density;
    volume.emission_params.emission_scale = 2.0f;
    scene.media.volumes.push_back(volume);
    const Tracing t(std::move(scene));
    ASSERT_EQ(t.lights.emissive_volumes().size(), 1u);
    const EmissiveVolume& emissive = t.lights.emissive_volumes()[0];
    int dark = 0;
    for (uint32_t i = 0; i < 200; ++i) {
        Rng rng = rng_of(i);
        const EmissionSample sample =
            sample_emission(t.scene.media.volumes[0], emissive.bricks, 0.0f, rng);
        for (const bool is_here : {true, false}) {
            const Vec3 x = is_here ? sample.p : Vec3(-3.0f, 0.1f, 0.2f);
            Rng same = rng_of(i);
            const auto ray = sample_shadow_ray(t.context, {x, up, 0.0f, &even}, same);
            EXPECT_GT(ray ? max_component(ray->light) : 1.0f, 0.0f);
            EXPECT_EQ(ray.has_value(), !is_here && max_component(sample.j) > 0.0f);
        }
        dark += max_component(sample.j) > 0.0f ? 0 : 1;
    }
    EXPECT_GT(dark, 20);
}

/// Nothing is between a point and itself, be it on a surface.
TEST(VisibilityGuards, PointsSeeThemselves)
{
    Scene scene = scene_with({});
    test::add_surfaces(
        scene, {{test::quad_mesh({-1.0f, 0.0f, -1.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f}),
                 test::diffuse(Spectrum(0.5f))}});
    const Tracing t(std::move(scene));
    for (const float y : {0.0f, 0.3f}) {
        const ScatterEvent event{Vec3(0.1f, y, 0.2f), up, 0.0f, &even};
        for (const Vec3& wi : {up, -up}) {
            Rng rng = rng_of(0);
            EXPECT_EQ(estimate_visibility(t.context, event, wi, 0.0f, rng), 1.0f);
        }
    }
}

/// On the wall itself: distances to both are rounded.
TEST(DirectLightGuards, LampsOnWallsAreSeenWhole)
{
    const Vec3 corner(-1.3f, -0.9f, 2.7f);
    const Vec3 u(2.1f, 0.3f, 0.4f);
    const Vec3 v(0.2f, 1.9f, -0.6f);
    Scene scene = scene_with({QuadLight{corner, u, v, Spectrum(1.0f), true}});
    test::add_surfaces(
        scene, {{test::quad_mesh(corner - u - v, 3.0f * u, 3.0f * v), test::diffuse(Spectrum())}});
    const Tracing t(std::move(scene));
    for (uint32_t i = 0; i < 2000; ++i) {
        Rng rng = rng_of(i);
        const Vec3 o = 4.0f * rng.uniform3() - Vec3(2.0f, 2.0f, 5.0f);
        const Vec3 to =
            corner + (0.01f + 0.98f * rng.uniform()) * u + (0.01f + 0.98f * rng.uniform()) * v - o;
        LightRay ray{{o, glm::normalize(to)}};
        const auto hit = intersect(*t.scene.surfaces, ray.ray, {0.0f, infinity});
        ASSERT_TRUE(hit);
        ray.t_surface = hit->t;
        EXPECT_EQ(seen_light(t.context, ray, hit->t, rng).lamps, Spectrum(1.0f)) << i;
    }
}

/// Shares add up to 1 but for rounding, here a coarse one: what is left of it is nobody's, least of
/// all that of a way from which nothing scatters.
TEST(ScatterEventGuards, WaysWithoutAShareAreNotTaken)
{
    SurfaceVertex floor;
    floor.ng = floor.ns = up;
    const Vec3 wo[] = {up, -up};
    const float share[] = {0.75f, 0.0f};
    const WayMixture mixture{wo, share};
    ScatterEvent event{Vec3(0.0f), up, 0.0f};
    event.surface = &floor;
    event.mixture = &mixture;
    for (uint32_t i = 0; i < 100; ++i) {
        Rng rng = rng_of(i);
        const auto s = sample_scattering(event, rng);
        ASSERT_TRUE(s) << i;
        EXPECT_GT(s->scattering.pdf_dir, 0.0f);
        EXPECT_GT(s->wi.y, 0.0f);
    }
}

}  // namespace
}  // namespace mote
