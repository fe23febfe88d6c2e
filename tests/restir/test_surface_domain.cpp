#include <gtest/gtest.h>

#include "restir/domains.h"
#include "restir/in_view.h"
#include "restir/room_scenes.h"
#include "restir/surface_reuse.h"

namespace mote {
namespace {

using test::RoomState;

/// A cube of smoke around the origin, and a sheet of 4 m across it at height y.
Scene sheet_in_smoke(float y)
{
    Scene scene;
    scene.camera = test::small_camera({0.5f, 0.4f, 3.2f});
    Volume smoke = test::constant_cube(20, 1.0f);
    smoke.density_scale = 0.5f;
    finalize(smoke);
    scene.media.volumes = {smoke};
    scene.lights = {DistantLight{glm::normalize(Vec3(0.3f, 1.0f, 0.2f)), Spectrum(1.0f)}};
    scene.environment = test::even_sky();
    test::add_surfaces(scene,
                       {{test::quad_mesh({-2.0f, y, -2.0f}, {0.0f, 0.0f, 4.0f}, {4.0f, 0.0f, 0.0f}),
                         test::diffuse(Spectrum(0.5f))}});
    return scene;
}

TEST(ShadowedCaches, MapsAreDarkBehindTheFirstSurface)
{
    const Scene scene = sheet_in_smoke(0.1f);
    const Vec3 wi = std::get<DistantLight>(scene.lights[0]).direction;
    const TransmittanceMap open(scene.media, wi);
    const TransmittanceMap map(scene.media, wi, {}, scene.surfaces.get());
    const float margin = 2.0f * map.spacing();
    for (uint32_t i = 0; i < 500; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        const Vec3 x = rng.uniform3() - 0.5f;
        if (x.y > 0.1f + margin) {
            EXPECT_EQ(map.transmittance(x), open.transmittance(x));
        } else if (x.y < 0.1f - margin) {
            EXPECT_LT(map.transmittance(x), 1e-6f);
            EXPECT_GT(open.transmittance(x), 0.3f);
        }
    }
    // A sheet between the smoke and the light shades it all, one on the other side none.
    const TransmittanceMap above(scene.media, wi, {}, sheet_in_smoke(1.5f).surfaces.get());
    const TransmittanceMap below(scene.media, wi, {}, sheet_in_smoke(-1.5f).surfaces.get());
    EXPECT_LT(above.transmittance(Vec3(0.0f)), 1e-6f);
    EXPECT_EQ(below.transmittance(Vec3(0.0f)), open.transmittance(Vec3(0.0f)));
}

TEST(ShadowedCaches, DirectionSetsAreDarkTowardsSurfaces)
{
    const Scene scene = sheet_in_smoke(0.3f);
    const DirectionTransmittance open(scene.media);
    const DirectionTransmittance set(scene.media, {}, scene.surfaces.get());
    const Vec3 x(0.0f, -0.3f, 0.0f);
    const Vec3 up(0.0f, 1.0f, 0.0f);
    EXPECT_GT(open.transmittance(x, up), 0.3f);
    EXPECT_LT(set.transmittance(x, up), 1e-6f);
    EXPECT_NEAR(set.transmittance(x, -up), open.transmittance(x, -up), 1e-6f);
}

TEST(ShadowedCaches, AreMadeAgainWhereSurfacesMoveAndOnlyThen)
{
    const Scene scene = sheet_in_smoke(0.1f);
    const auto first = make_light_caches(scene, {}, nullptr);
    const auto again = make_light_caches(scene, {}, first);
    EXPECT_EQ(again->built, 0);
    EXPECT_EQ(again->distant[0].map, first->distant[0].map);
    const auto moved = make_light_caches(sheet_in_smoke(0.2f), {}, first);
    EXPECT_NE(moved->distant[0].map, first->distant[0].map);
    EXPECT_NE(moved->directions, first->directions);
}

TEST(LampIndex, StaysWhileLampsDo)
{
    Scene scene = test::room();
    const auto caches = make_light_caches(scene, {}, nullptr);
    const FrameDomain first = make_frame_domain(test::borrow(scene), caches, {});
    const FrameDomain empty;
    EXPECT_NE(make_frame_domain(test::borrow(scene), caches, {}, &empty).lamp_surfaces, nullptr);
    Scene next = scene;
    EXPECT_EQ(make_frame_domain(test::borrow(next), caches, {}, &first).lamp_surfaces,
              first.lamp_surfaces);
    std::get<SphereLight>(next.lights[0]).position.x += 0.1f;
    EXPECT_NE(make_frame_domain(test::borrow(next), caches, {}, &first).lamp_surfaces,
              first.lamp_surfaces);
}

/// A room's domain that owns its scene, and the surface in the middle of a pixel.
FrameDomain room_domain(const RoomState& state)
{
    const auto scene = std::make_shared<const Scene>(test::room(state));
    return make_frame_domain(scene, make_light_caches(*scene, {100'000}, nullptr), {});
}
SurfaceDomain surface_at(const FrameDomain& frame, Vec2 film)
{
    PixelDomain domain;
    BinCounts counts;
    make_pixel_domain(frame, generate_ray(frame.scene->camera, film, Vec2(0.5f), 0.0f), domain,
                      counts);
    return make_surface_domain(frame, domain, 0.0f);
}

TEST(SurfaceReprojection, FollowsCameraAndObjects)
{
    RoomState then;
    RoomState now;
    now.camera = {0.3f, 0.5f, 3.1f};
    now.block = then.block + Vec3(0.2f, 0.05f, 0.1f);
    now.block_angle = then.block_angle + 0.2;
    const FrameDomain before = room_domain(then);
    const FrameDomain frame = room_domain(now);
    int on_block = 0;
    int elsewhere = 0;
    for (int i = 0; i < 48; ++i) {
        const SurfaceDomain own = surface_at(frame, Vec2(i % 8, i / 8) + 0.5f);
        const auto from = previous_surface(before, frame, own);
        if (!from) continue;
        // Looking there, the earlier camera sees the same point of the object, unless another
        // object hides it.
        const InstanceFrame here =
            frame.scene->surfaces->bvh->frame_at(static_cast<size_t>(own.v.object), 0.0f);
        const InstanceFrame there =
            before.scene->surfaces->bvh->frame_at(static_cast<size_t>(own.v.object), 0.0f);
        const Vec3 p(there.point(here.inverse * (Vec3d(own.v.p) - here.offset)));
        const auto film = project(before.scene->camera, p, 0.0f);
        ASSERT_TRUE(film);
        EXPECT_EQ(static_cast<int>(film->x), from->x);
        EXPECT_EQ(static_cast<int>(film->y), from->y);
        const SurfaceDomain seen = surface_at(before, *film);
        if (seen.v.object != own.v.object) continue;
        EXPECT_LT(glm::length(seen.v.p - p), 1e-3f);
        EXPECT_NEAR(seen.distance, from->distance, 1e-3f);
        EXPECT_TRUE(is_similar(own, seen, from->distance));
        (own.v.object == 2 ? on_block : elsewhere) += 1;
    }
    EXPECT_GT(on_block, 1);
    EXPECT_GT(elsewhere, 10);
}

TEST(SurfaceReprojection, SimilarityLooksAtNormalDistanceAndMaterial)
{
    const FrameDomain frame = room_domain({});
    const SurfaceDomain own = surface_at(frame, {4.0f, 3.0f});
    EXPECT_TRUE(is_similar(own, own, own.distance));
    EXPECT_FALSE(is_similar(own, own, 1.2f * own.distance));
    SurfaceDomain other = own;
    other.v.ns = glm::normalize(own.v.ns + 0.7f * make_frame(own.v.ns)[0]);
    EXPECT_FALSE(is_similar(own, other, own.distance));
    other = own;
    other.v.material.kind = MaterialKind::Dielectric;
    EXPECT_FALSE(is_similar(own, other, own.distance));
    other = own;
    other.share = 0.0f;
    EXPECT_FALSE(is_similar(own, other, own.distance));
}

TEST(SurfacesInView, AreThoseWhoseBoxATileMayMeet)
{
    Scene scene;
    scene.camera = test::small_camera({0.0f, 0.0f, 10.0f});
    scene.camera.width = 160;
    scene.camera.height = 120;
    EXPECT_FALSE(surfaces_in_view(scene, {0, 0, 160, 120}));
    test::add_surfaces(scene, {{test::sphere_mesh(0.5f, 6), test::diffuse(Spectrum(0.5f))}});
    EXPECT_TRUE(surfaces_in_view(scene, {72, 52, 88, 68}));
    EXPECT_FALSE(surfaces_in_view(scene, {0, 0, 16, 16}));
    EXPECT_FALSE(surfaces_in_view(scene, {144, 104, 160, 120}));
}

}  // namespace
}  // namespace mote
