// Normals and lobes at the edge of what floats can tell: every guard has a case that needs it.
#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"
#include "surfaces/bsdf.h"
#include "surfaces/meshes.h"
#include "surfaces/surfaces.h"

namespace mote {
namespace {

/// A quad with u along x, v along z and the front along -y.
Mesh quad()
{
    return test::quad_mesh(Vec3(0.0f), Vec3(2.0f, 0.0f, 0.0f), Vec3(0.0f, 0.0f, 3.0f));
}

/// Its shading normal amid the first triangle, with a normal map of one texel.
Vec3 shading_normal(Mesh mesh, Vec3 stored)
{
    Surfaces surfaces;
    surfaces.objects = {{"thing", 0}};
    surfaces.materials = {Material{}};
    MaterialTextures textures;
    textures.normal = std::make_shared<const Texture>(
        1, 1, std::vector<float>{stored.x, stored.y, stored.z, 1.0f});
    set_textures(surfaces, {textures});
    MeshInstance instance{std::make_shared<const MeshBvh>(std::move(mesh)), {}};
    surfaces.bvh = std::make_shared<const InstanceBvh>(std::vector<MeshInstance>{instance});
    return make_vertex(surfaces, {1.0f, 0, 0, 0.5f, 0.25f}, 0.0f).ns;
}

const Vec3 front(0.0f, -1.0f, 0.0f);
const Vec3 flat_map(0.5f, 0.5f, 1.0f);

TEST(NormalGuards, NormalsThatCancelOutLeaveTheFace)
{
    Mesh mesh = quad();
    const Vec3 n = glm::normalize(Vec3(0.3f, -0.8f, 0.1f));
    // Weights 1/4, 1/2, 1/4 at the place that is looked at.
    mesh.normals = {-n, n, -n, n};
    EXPECT_EQ(shading_normal(mesh, flat_map), front);
}

TEST(NormalGuards, NormalMapsWithoutAxesChangeNothing)
{
    // No area in the texture; a normal along the texture's own axis.
    Mesh mesh = quad();
    for (Vec2& uv : mesh.uvs) uv = Vec2(0.5f);
    EXPECT_EQ(shading_normal(mesh, Vec3(0.8f, 0.5f, 0.9f)), front);
    for (Vec2& uv : mesh.uvs) uv = Vec2(0.0f);
    mesh.uvs[1] = Vec2(1e-38f, 0.0f);
    mesh.uvs[2] = mesh.uvs[3] = Vec2(0.0f, 1e-38f);
    EXPECT_LT(glm::length(shading_normal(mesh, flat_map) - front), 1e-5f);
    // The smallest floats span 2e-90, one over which is finite in double.
    mesh.uvs[1] = Vec2(0x1p-149f, 0.0f);
    mesh.uvs[2] = mesh.uvs[3] = Vec2(0.0f, 0x1p-149f);
    EXPECT_LT(glm::length(shading_normal(mesh, flat_map) - front), 1e-5f);
    mesh = quad();
    const Vec3 along(1.0f, 0.0f, 0.0f);
    mesh.normals = {along, along, along, along};
    const Vec3 n = shading_normal(mesh, Vec3(0.8f, 0.5f, 0.9f));
    EXPECT_NEAR(glm::length(n), 1.0f, 1e-6f) << n.x;
}

/// Grey is no direction; what points inwards is none of this side.
TEST(NormalGuards, NormalMapsWithoutADirectionChangeNothing)
{
    EXPECT_EQ(shading_normal(quad(), Vec3(0.5f)), front);
    for (const Vec3& stored : {Vec3(0.0f), Vec3(1.0f, 0.5f, 0.0f), Vec3(0.5f, 0.5f, 0.0f)}) {
        EXPECT_EQ(shading_normal(quad(), stored), front);
    }
}

TEST(MeshGuards, TrianglesWithoutAreaAreLeftOut)
{
    for (const float size : {0.0f, 1e-12f, 1.0f}) {
        Mesh mesh;
        mesh.positions = {Vec3(0.0f), Vec3(size, 0.0f, 0.0f), Vec3(0.0f, size, 0.0f)};
        mesh.triangles = {{0, 1, 2}};
        repair_mesh(mesh, "mesh");
        EXPECT_EQ(mesh.triangles.size(), size == 1.0f ? 1u : 0u) << size;
    }
}

Material material_of(MaterialKind kind, float roughness, float metallic = 0.0f)
{
    Material material;
    material.kind = kind;
    material.roughness = roughness;
    material.metallic = metallic;
    return material;
}

/// Flat views and flat directions, sharp and rough, numbers at their ends.
TEST(BsdfGuards, SamplesAreFiniteUpToTheHorizon)
{
    const float numbers[] = {0.0f, 0x1p-24f, 0.25f, 0.5f, 1.0f - 0x1p-10f, one_minus_epsilon};
    Material materials[] = {
        material_of(MaterialKind::Diffuse, 1.0f),
        material_of(MaterialKind::MetallicRoughness, 0.0f),
        material_of(MaterialKind::MetallicRoughness, 1.0f),
        material_of(MaterialKind::MetallicRoughness, 0.5f, 1.0f),
        material_of(MaterialKind::Dielectric, 0.0f),
        material_of(MaterialKind::Dielectric, 1.0f),
        material_of(MaterialKind::Dielectric, 0.3f),
    };
    materials[6].ior = 1.0f + 0x1p-23f;
    int found = 0;
    for (const Material& material : materials) {
        SurfaceVertex v;
        v.material = material;
        v.material.two_sided = true;
        for (const float z : {1e-38f, 1e-20f, 1e-9f, 1e-4f, 0.5f, 1.0f, -1e-20f, -1e-4f, -0.7f}) {
            const Vec3 wo(std::sqrt(1.0f - sqr(z)), 0.0f, z);
            for (const float a : numbers) {
                for (const float b : numbers) {
                    for (const float c : numbers) {
                        const auto sample = sample_bsdf(v, wo, {a, b, c});
                        if (!sample) continue;
                        ++found;
                        ASSERT_TRUE(is_finite(sample->wi));
                        ASSERT_NEAR(glm::length(sample->wi), 1.0f, 1e-5f);
                        ASSERT_TRUE(sample->value.pdf_dir > 0.0f &&
                                    sample->value.pdf_dir < infinity);
                        ASSERT_FALSE(std::isnan(sample->value.f.x)) << z;
                    }
                }
            }
        }
    }
    EXPECT_GT(found, 5000);
}

/// However bright one lobe looks, the other one gets a tenth of the samples.
TEST(BsdfGuards, NeitherLobeStarves)
{
    SurfaceVertex v;
    const Vec3 wo(0.0f, 0.0f, 1.0f);
    const Vec3 aside = glm::normalize(Vec3(1.0f, 0.0f, 1.0f));
    v.material = material_of(MaterialKind::MetallicRoughness, 0.1f, 0.999f);
    v.material.base_color = Spectrum(0.9f);
    EXPECT_GE(bsdf_pdf(v, wo, aside), 0.0999f * inv_pi * aside.z);
    v.material.metallic = 1.0f;
    v.material.base_color = Spectrum(0.04f);
    const float mirror_alone = bsdf_pdf(v, wo, wo);
    v.material.metallic = 0.0f;
    v.material.base_color = Spectrum(1.0f);
    EXPECT_GE(bsdf_pdf(v, wo, wo), 0.0999f * mirror_alone);
}

}  // namespace
}  // namespace mote
