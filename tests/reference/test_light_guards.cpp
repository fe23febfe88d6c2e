// Where lights and points coincide, or nearly so: no direction, no infinite radiance, no distance
// below 0.
#include <gtest/gtest.h>

#include "core/rng.h"
#include "core/sampling.h"
#include "scene/light.h"
#include "scene/light_tree.h"

namespace mote {
namespace {

const Vec3 here(0.3f, -1.7f, 2.9f);

TEST(LightGuards, NothingShinesOnItself)
{
    const Vec3 u(0.5f, 0.25f, 0.0f);
    const Vec3 v(0.0f, 0.5f, 1.0f);
    const Light lights[] = {
        PointLight{here, Spectrum(1.0f)},
        SpotLight{here, Vec3(0.0f, -1.0f, 0.0f), Spectrum(1.0f), 0.0f, -1.0f},
        QuadLight{here, u, v, Spectrum(1.0f), true},
        TriangleLight{here, u, v, Spectrum(1.0f), true},
        SphereLight{here, 0.0f, Spectrum(1.0f)},
        SphereLight{here, 0.1f, Spectrum(1.0f)},
    };
    for (const Light& light : lights) {
        EXPECT_FALSE(sample_light(light, here, Vec2(0.0f))) << light.index();
    }
}

TEST(LightGuards, ASphereOfNoSizeIsNeitherSampledNorMet)
{
    const Light light = SphereLight{here, 0.0f, Spectrum(1.0f)};
    const Vec3 x = here - Vec3(0.0f, 0.0f, 2.0f);
    const Vec3 wi(0.0f, 0.0f, 1.0f);
    EXPECT_FALSE(sample_light(light, x, Vec2(0.5f)));
    EXPECT_FALSE(hit_light(light, x, wi));
    EXPECT_EQ(light_pdf(light, x, wi), 0.0f);
}

/// From points that rounding may put inside: all numbers and distances are sound, at the rim too.
TEST(LightGuards, ASphereIsSoundRightAtItsSurface)
{
    const SphereLight sphere{here, 0.7f, Spectrum(1.0f)};
    for (uint32_t i = 0; i < 20'000; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        const Vec3 n = sample_sphere(rng.uniform2());
        const float margin = i % 2 == 0 ? 0.0f : 1e-7f * rng.uniform();
        const Vec3 x = here + (sphere.radius * (1.0f + margin)) * n;
        Vec2 u = rng.uniform2();
        if (i % 3 == 0) u.x = i % 2 == 0 ? 0.0f : one_minus_epsilon;
        if (const auto sample = sample_light(sphere, x, u)) {
            ASSERT_TRUE(is_finite(sample->wi) && std::isfinite(sample->pdf_dir)) << i;
            ASSERT_NEAR(glm::length(sample->wi), 1.0f, 1e-5f) << i;
            ASSERT_TRUE(sample->distance >= 0.0f && std::isfinite(sample->distance)) << i;
            if (const auto numbers = light_numbers(sphere, x, sample->wi)) {
                ASSERT_TRUE(numbers->x >= 0.0f && numbers->x < 1.0f) << i;
                ASSERT_TRUE(numbers->y >= 0.0f && numbers->y < 1.0f) << i;
            }
        }
        const auto hit = hit_light(sphere, x, -n);
        ASSERT_TRUE(!hit || hit->distance >= 0.0f) << i;
    }
}

/// The rim is met where it is, not at the point itself.
TEST(LightGuards, SamplesLieOnTheSphereUpToItsRim)
{
    for (uint32_t i = 0; i < 20'000; ++i) {
        Rng rng(3, 0, Stream::Test, i, 0);
        const SphereLight sphere{here, 0.01f + 3.0f * rng.uniform(), Spectrum(1.0f)};
        const Vec3 n = sample_sphere(rng.uniform2());
        const Vec3 x = here + (sphere.radius * (1.05f + 30.0f * rng.uniform())) * n;
        const auto sample = sample_light(sphere, x, Vec2(one_minus_epsilon, rng.uniform()));
        ASSERT_TRUE(sample);
        const float to_centre = glm::length(x + sample->distance * sample->wi - here);
        ASSERT_NEAR(to_centre, sphere.radius, 0.01f * sphere.radius) << i;
    }
}

/// Shadow rays end before the triangle; what is closer than that has none.
TEST(LightGuards, ATriangleDoesNotLightWhatTouchesIt)
{
    const float offset = 1e-3f;
    const TriangleLight triangle{
        here, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, Spectrum(1.0f), true, offset};
    const Vec2 u(0.25f, 0.5f);  // the point right below
    const Vec3 below = here + Vec3(0.25f, 0.0f, 0.25f);
    for (const float side : {-1.0f, 1.0f}) {
        EXPECT_FALSE(sample_light(triangle, below + Vec3(0.0f, 0.5f * side * offset, 0.0f), u));
        const auto sample =
            sample_light(triangle, below + Vec3(0.0f, 3.0f * side * offset, 0.0f), u);
        ASSERT_TRUE(sample);
        EXPECT_NEAR(sample->wi.y, -side, 1e-3f);
        EXPECT_NEAR(sample->distance, 2.0f * offset, 1e-5f);
    }
}

/// The rounding of a long way is larger than any offset.
TEST(LightGuards, LongWaysEndClearOfTheTriangle)
{
    const TriangleLight triangle{
        Vec3(0.0f), {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, Spectrum(1.0f), true};
    for (const float height : {1.0f, 1e3f, 1e6f}) {
        const auto sample = sample_light(triangle, Vec3(0.2f, height, 0.1f), Vec2(0.3f));
        ASSERT_TRUE(sample);
        EXPECT_LT(-sample->wi.y * sample->distance, height * (1.0f - 0x1p-23f));
    }
}

TEST(LightGuards, FlatLightsShineToTheirFrontAlone)
{
    const Vec3 u(1.0f, 0.0f, 0.0f);
    const Vec3 v(0.0f, 0.0f, 1.0f);  // the front is below
    const Vec3 edge_on = here + Vec3(5.0f, 0.0f, 0.3f);
    const Vec3 above = here + Vec3(0.2f, 2.0f, 0.2f);
    for (const bool two_sided : {false, true}) {
        const Light lights[] = {TriangleLight{here, u, v, Spectrum(1.0f), two_sided},
                                QuadLight{here, u, v, Spectrum(1.0f), two_sided}};
        for (const Light& light : lights) {
            EXPECT_FALSE(sample_light(light, edge_on, Vec2(0.3f)));
            EXPECT_EQ(sample_light(light, above, Vec2(0.3f)).has_value(), two_sided);
            // What is behind a ray is not on it.
            EXPECT_FALSE(hit_light(light, above, Vec3(0.0f, 1.0f, 0.0f)));
            EXPECT_EQ(light_pdf(lights[1], above, Vec3(0.0f, 1.0f, 0.0f)), 0.0f);
        }
    }
}

/// Lights in one place, chosen from there, and ones that hardly matter.
TEST(LightTreeGuards, ChoicesAreADistribution)
{
    const Bounds3 at{here, here};
    const Bounds3 there{here + 1.0f, here + 1.0f};
    const std::vector<LightTree::Item> all[] = {{{0, at, 1.0f}, {1, at, 2.0f}},
                                                {{0, at, 1.0f}, {1, there, 1e-20f}},
                                                {{0, at, 1e-30f}, {1, there, 1e30f}}};
    for (const std::vector<LightTree::Item>& items : all) {
        const LightTree tree(items);
        for (const Vec3& x : {here, here + 1.0f, here + 10.0f}) {
            EXPECT_GE(tree.pmf(0, x), 0.99e-5f);
            EXPECT_GE(tree.pmf(1, x), 0.99e-5f);
            EXPECT_NEAR(tree.pmf(0, x) + tree.pmf(1, x), 1.0f, 1e-6f);
            EXPECT_TRUE(std::isfinite(tree.importance(x))) << tree.importance(x);
        }
    }
    EXPECT_TRUE(std::isfinite(LightTree({{0, at, 1.0f}}).importance(here)));
}

}  // namespace
}  // namespace mote
