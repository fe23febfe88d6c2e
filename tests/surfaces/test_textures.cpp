#include <gtest/gtest.h>

#include "image/color.h"
#include "surfaces/meshes.h"
#include "surfaces/surfaces.h"

// Look-ups of pictures, what they do to materials, and normal maps against their definition.
namespace mote {
namespace {

/// 2 x 2 texels: red, green over blue, white of half opacity.
std::shared_ptr<const Texture> four_texels(bool is_srgb)
{
    return std::make_shared<const Texture>(
        2, 2,
        std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 51},
        is_srgb);
}

TEST(Texture, CentresOfTexelsBilinearBetweenAndRepeated)
{
    const auto texture = four_texels(false);
    // u to the right, v upwards: the first row of the file is the upper one.
    EXPECT_EQ(texture->at({0.25f, 0.75f}), Rgba(1.0f, 0.0f, 0.0f, 1.0f));
    EXPECT_EQ(texture->at({0.75f, 0.75f}), Rgba(0.0f, 1.0f, 0.0f, 1.0f));
    EXPECT_EQ(texture->at({0.25f, 0.25f}), Rgba(0.0f, 0.0f, 1.0f, 1.0f));
    EXPECT_EQ(texture->at({0.75f, 0.25f}), Rgba(1.0f, 1.0f, 1.0f, 0.2f));
    EXPECT_EQ(texture->at({0.5f, 0.5f}), Rgba(0.5f, 0.5f, 0.5f, 0.8f));
    EXPECT_EQ(texture->at({0.5f, 0.75f}), Rgba(0.5f, 0.5f, 0.0f, 1.0f));
    // Past an edge lies the other one; whole numbers make no difference.
    EXPECT_EQ(texture->at({0.0f, 0.75f}), Rgba(0.5f, 0.5f, 0.0f, 1.0f));
    EXPECT_EQ(texture->at({1.0f, 0.75f}), texture->at({0.0f, 0.75f}));
    for (const Vec2& shift : {Vec2(3.0f, -2.0f), Vec2(-64.0f, 64.0f)}) {
        EXPECT_EQ(texture->at(Vec2(0.375f, 0.625f) + shift), texture->at({0.375f, 0.625f}));
    }
    for (const float far : {1e30f, -1e30f, 1e-38f, -1e-38f, 0x1p24f}) {
        const Rgba value = texture->at({far, -far});
        for (int c = 0; c < 4; ++c) EXPECT_TRUE(value[c] >= 0.0f && value[c] <= 1.0f) << far;
    }
}

/// A row of three texels, 0, 1 and 4, along u or v: what lies beyond its edges.
TEST(Texture, ClampsMirrorsAndTakesTheNearest)
{
    const std::vector<float> row{0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f,
                                 1.0f, 1.0f, 4.0f, 4.0f, 4.0f, 1.0f};
    for (const bool is_v : {false, true}) {
        const auto at = [&](TextureWrap wrap, bool is_nearest, float coordinate) {
            const TextureSampler sampler =
                is_v ? TextureSampler{TextureWrap::Repeat, wrap, is_nearest}
                     : TextureSampler{wrap, TextureWrap::Repeat, is_nearest};
            const Texture texture(is_v ? 1 : 3, is_v ? 3 : 1, row, sampler);
            // Rows come from the top, v runs upwards.
            return texture.at(is_v ? Vec2(0.3f, 1.0f - coordinate) : Vec2(coordinate, 0.3f)).x;
        };
        const auto repeated = [&](float x) { return at(TextureWrap::Repeat, false, x); };
        const auto clamped = [&](float x) { return at(TextureWrap::Clamp, false, x); };
        const auto mirrored = [&](float x) { return at(TextureWrap::Mirror, false, x); };
        EXPECT_NEAR(repeated(1.0f), 2.0f, 1e-5f);
        EXPECT_NEAR(clamped(1.0f), 4.0f, 1e-5f);
        EXPECT_NEAR(clamped(1.4f), 4.0f, 1e-5f);
        EXPECT_NEAR(clamped(-7.0f), 0.0f, 1e-5f);
        EXPECT_NEAR(clamped(2.0f / 3.0f), 2.5f, 1e-5f);
        EXPECT_NEAR(mirrored(1.0f), 4.0f, 1e-5f);
        for (const float x : {0.1f, 0.4f, 0.55f, 0.9f}) {
            EXPECT_NEAR(clamped(x), mirrored(x), 1e-5f) << x;
            EXPECT_NEAR(mirrored(-x), mirrored(x), 1e-5f) << x;
            EXPECT_NEAR(mirrored(2.0f - x), mirrored(x), 1e-5f) << x;
            EXPECT_NEAR(mirrored(x + 6.0f), mirrored(x), 1e-5f) << x;
        }
        EXPECT_EQ(at(TextureWrap::Repeat, true, 0.3f), 0.0f);
        EXPECT_EQ(at(TextureWrap::Repeat, true, 0.4f), 1.0f);
        EXPECT_EQ(at(TextureWrap::Repeat, true, 1.1f), 0.0f);
        EXPECT_EQ(at(TextureWrap::Clamp, true, 1.1f), 4.0f);
        EXPECT_EQ(at(TextureWrap::Mirror, true, 1.1f), 4.0f);
        for (const TextureWrap wrap : {TextureWrap::Clamp, TextureWrap::Mirror}) {
            for (const float far : {1e30f, -1e30f, 1e-38f, -1e-38f, 0x1p24f}) {
                const float value = at(wrap, far > 0.0f, far);
                EXPECT_TRUE(value >= 0.0f && value <= 4.0f) << far;
            }
        }
    }
}

TEST(Texture, SrgbIsDecodedBeforeItIsMixedAndAlphaNever)
{
    const Texture grey(2, 1, std::vector<uint8_t>{0, 0, 0, 102, 188, 188, 188, 102}, true);
    EXPECT_FLOAT_EQ(grey.at({0.75f, 0.5f}).x, decode_srgb(188.0f / 255.0f));
    EXPECT_FLOAT_EQ(grey.at({0.5f, 0.5f}).x, 0.5f * decode_srgb(188.0f / 255.0f));
    EXPECT_FLOAT_EQ(grey.at({0.5f, 0.5f}).w, 0.4f);
    const Texture floats(1, 1, std::vector<float>{3.0f, 0.25f, 0.5f, 1.0f});
    EXPECT_EQ(floats.at({7.7f, -3.3f}), Rgba(3.0f, 0.25f, 0.5f, 1.0f));
}

TEST(MaterialTextures, ChannelsMultiplyTheirFactors)
{
    Material material;
    material.base_color = Spectrum(0.5f, 1.0f, 1.0f);
    material.roughness = 0.8f;
    material.metallic = 0.5f;
    material.emission = Spectrum(2.0f);
    MaterialTextures textures;
    textures.color = textures.roughness = textures.metallic = textures.emission =
        std::make_shared<const Texture>(1, 1, std::vector<float>{4.0f, 0.5f, 0.25f, 0.6f});
    const Material at = material_at(material, textures, {0.1f, 0.2f});
    EXPECT_EQ(at.base_color, Spectrum(1.0f, 0.5f, 0.25f));  // never more than comes in
    EXPECT_FLOAT_EQ(at.roughness, 0.4f);
    EXPECT_FLOAT_EQ(at.metallic, 0.125f);
    EXPECT_EQ(at.emission, Spectrum(8.0f, 1.0f, 0.5f));
    EXPECT_TRUE(is_present(textures, Vec2(0.0f)));
    textures.alpha_cutoff = 0.5f;
    EXPECT_TRUE(is_present(textures, Vec2(0.0f)));
    textures.opacity = 0.5f;
    EXPECT_FALSE(is_present(textures, Vec2(0.0f)));
    EXPECT_EQ(textured_emission(material.emission, textures, Vec2(0.0f)), Spectrum(0.0f));
}

/// A quad with a normal map of one texel, seen at its middle.
Vec3 mapped(Mesh mesh, const Trs& trs, Vec3 map, float strength = 1.0f)
{
    Surfaces surfaces;
    surfaces.objects = {{"thing", 0}};
    surfaces.materials = {Material{}};
    MaterialTextures textures;
    const Vec3 stored = 0.5f * (map + Vec3(1.0f));
    textures.normal = std::make_shared<const Texture>(
        1, 1, std::vector<float>{stored.x, stored.y, stored.z, 1.0f});
    textures.normal_strength = strength;
    set_textures(surfaces, {textures});
    MeshInstance instance{std::make_shared<const MeshBvh>(std::move(mesh)), {}};
    instance.world_from_object.keys = {trs};
    surfaces.bvh = std::make_shared<const InstanceBvh>(std::vector<MeshInstance>{instance});
    return make_vertex(surfaces, {1.0f, 0, 0, 0.4f, 0.3f}, 0.0f).ns;
}

void expect_near(Vec3 a, Vec3 b)
{
    EXPECT_LT(glm::length(a - b), 1e-5f)
        << a.x << " " << a.y << " " << a.z << " for " << b.x << " " << b.y << " " << b.z;
}

TEST(NormalMap, TurnsTheNormalAlongTheAxesOfTheTexture)
{
    // u along x, v along z, so the front is -y.
    const Mesh quad = test::quad_mesh(Vec3(0.0f), Vec3(2.0f, 0.0f, 0.0f), Vec3(0.0f, 0.0f, 3.0f));
    expect_near(mapped(quad, {}, Vec3(0.0f, 0.0f, 1.0f)), Vec3(0.0f, -1.0f, 0.0f));
    expect_near(mapped(quad, {}, Vec3(0.6f, 0.0f, 0.8f)), Vec3(0.6f, -0.8f, 0.0f));
    expect_near(mapped(quad, {}, Vec3(0.0f, 0.6f, 0.8f)), Vec3(0.0f, -0.8f, 0.6f));
    expect_near(mapped(quad, {}, Vec3(0.6f, 0.0f, 0.8f), 0.0f), Vec3(0.0f, -1.0f, 0.0f));
    const float slope = 2.0f * 0.75f;
    expect_near(mapped(quad, {}, Vec3(0.6f, 0.0f, 0.8f), 2.0f),
                Vec3(slope, -1.0f, 0.0f) / std::sqrt(1.0f + slope * slope));
    // Mirrored coordinates: u runs backwards, v does not.
    Mesh mirrored = quad;
    for (Vec2& uv : mirrored.uvs) uv.x = -uv.x;
    expect_near(mapped(mirrored, {}, Vec3(0.6f, 0.0f, 0.8f)), Vec3(-0.6f, -0.8f, 0.0f));
    expect_near(mapped(mirrored, {}, Vec3(0.0f, 0.6f, 0.8f)), Vec3(0.0f, -0.8f, 0.6f));
    // A quarter turn about y takes x to -z and z to x.
    Trs turned;
    turned.rotate = glm::angleAxis(glm::radians(90.0), Vec3d(0.0, 1.0, 0.0));
    turned.scale = Vec3d(2.0, 2.0, 2.0);
    expect_near(mapped(quad, turned, Vec3(0.6f, 0.0f, 0.8f)), Vec3(0.0f, -0.8f, -0.6f));
    // Coordinates without area, and maps that point inwards, change nothing.
    Mesh flat = quad;
    for (Vec2& uv : flat.uvs) uv = Vec2(0.5f);
    expect_near(mapped(flat, {}, Vec3(0.6f, 0.0f, 0.8f)), Vec3(0.0f, -1.0f, 0.0f));
    expect_near(mapped(quad, {}, Vec3(0.6f, 0.0f, -0.8f)), Vec3(0.0f, -1.0f, 0.0f));
}

}  // namespace
}  // namespace mote
