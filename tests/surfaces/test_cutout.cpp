#include <gtest/gtest.h>

#include "core/rng.h"
#include "surfaces/meshes.h"
#include "surfaces/surfaces.h"

// Surfaces that are cut out by the alpha of a picture.
namespace mote {
namespace {

/// Opaque for u < 1/2, else not there.
std::shared_ptr<const Texture> left_half()
{
    return std::make_shared<const Texture>(
        2, 1, std::vector<uint8_t>{255, 255, 255, 255, 255, 255, 255, 0}, true);
}

/// A leaf of which the right half is cut out, twice (one instance mirrored), before a whole wall.
/// All share a mesh.
Surfaces leaves()
{
    const auto mesh = std::make_shared<const MeshBvh>(
        test::quad_mesh(Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f), Vec3(0.0f, 1.0f, 0.0f)));
    std::vector<MeshInstance> instances(3, {mesh, {}});
    instances[1].world_from_object.keys[0].scale.x = -1.0;
    instances[1].world_from_object.keys[0].translate = Vec3d(1.0, 0.0, 0.5);
    instances[2].world_from_object.keys[0].translate.z = -1.0;
    Surfaces surfaces;
    surfaces.objects = {{"leaf", 0}, {"mirrored leaf", 0}, {"wall", 1}};
    surfaces.materials = {Material{}, Material{}};
    MaterialTextures cut;
    cut.color = left_half();
    cut.alpha_cutoff = 0.5f;
    set_textures(surfaces, {cut, MaterialTextures{}});
    surfaces.bvh = std::make_shared<const InstanceBvh>(instances);
    return surfaces;
}

TEST(Cutout, RaysPassWhereNothingIs)
{
    const Surfaces surfaces = leaves();
    EXPECT_TRUE(surfaces.has_cuts);
    Rng rng(1, 0, Stream::Test, 0, 0);
    for (int i = 0; i < 2'000; ++i) {
        const Vec3 p(rng.uniform(), rng.uniform(), 2.0f);
        // Half a texel into the edges of the picture, alpha mixes with that of the other side.
        const float u = p.x;
        const float alpha =
            std::clamp(u < 0.25f ? 0.5f + 2.0f * u : 0.5f - 2.0f * (u - 0.5f), 0.0f, 1.0f);
        const bool is_near_edge = std::abs(alpha - 0.5f) < 1e-3f || u > 0.74f;
        if (is_near_edge) continue;
        const bool first = u < 0.5f;  // the leaf is there
        const Ray ray{p, Vec3(0.0f, 0.0f, -1.0f), 0.0f};
        const auto hit = intersect(surfaces, ray, {0.0f, infinity});
        ASSERT_TRUE(hit);
        // The mirrored leaf is nearer, and there where the other is not.
        EXPECT_EQ(hit->object, first ? 0 : 1) << u;
        EXPECT_EQ(is_occluded(surfaces, ray, {0.0f, 1.9f}), !first);
        EXPECT_EQ(is_occluded(surfaces, ray, {1.6f, 2.5f}), first);
        EXPECT_TRUE(is_occluded(surfaces, ray, {2.5f, 3.5f}));
    }
}

TEST(Cutout, AThousandLayersOfNothingHideNothing)
{
    // Every hit of a ray is rejected until the wall behind them.
    Surfaces surfaces;
    const auto mesh = std::make_shared<const MeshBvh>(
        test::quad_mesh(Vec3(-1.0f, -1.0f, 0.0f), Vec3(2.0f, 0.0f, 0.0f), Vec3(0.0f, 2.0f, 0.0f)));
    std::vector<MeshInstance> instances(1001, {mesh, {}});
    for (size_t i = 0; i < instances.size(); ++i) {
        instances[i].world_from_object.keys[0].translate.z = -0.01 * static_cast<double>(i);
        surfaces.objects.push_back({"layer", i < 1000 ? 0 : 1});
    }
    surfaces.materials = {Material{}, Material{}};
    MaterialTextures cut;
    cut.color = std::make_shared<const Texture>(1, 1, std::vector<float>{1.0f, 1.0f, 1.0f, 0.2f});
    cut.alpha_cutoff = 0.5f;
    set_textures(surfaces, {cut, MaterialTextures{}});
    surfaces.bvh = std::make_shared<const InstanceBvh>(instances);
    const Ray ray{Vec3(0.1f, 0.2f, 1.0f), Vec3(0.0f, 0.0f, -1.0f), 0.0f};
    const auto hit = intersect(surfaces, ray, {0.0f, infinity});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->object, 1000);
    EXPECT_FALSE(is_occluded(surfaces, ray, {0.0f, 10.9f}));
    EXPECT_TRUE(is_occluded(surfaces, ray, {0.0f, 11.1f}));
}

}  // namespace
}  // namespace mote
