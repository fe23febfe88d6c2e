#include <gtest/gtest.h>

#include "volumes.h"
#include "volumes/collisions.h"

namespace mote {
namespace {

using test::along_x;
using test::bumpy_bricks;
using test::everything;
using test::marched_depth;
using test::slab;
using test::volume_of;

TEST(OpticalDepth, SlabIsExactFromThinToOpaque)
{
    for (const float tau : {1e-3f, 0.1f, 1.0f, 8.0f, 100.0f}) {
        EXPECT_NEAR(optical_depth(slab(tau), along_x, everything), tau, 2e-6f * tau);
    }
}

TEST(OpticalDepth, AgreesWithABruteForceMarchUnderAnyTransform)
{
    for (const MovingTransform& transform :
         {MovingTransform{}, test::tilted(), test::tilted(100)}) {
        const float size = static_cast<float>(transform.keys[0].scale.x);
        const Volume volume = volume_of(bumpy_bricks(), 8.0f / size, transform);
        const Bounds3 bounds = world_bounds(volume);
        double total = 0.0;
        for (uint32_t i = 0; i < 60; ++i) {
            const Ray ray = test::test_ray(bounds, i);
            const Interval range{0.0f, 6.0f * size};
            const double exact = marched_depth(volume, ray, range, 20000);
            // The march has 20000 steps of 0.02 voxels: error 1e-4 of the gradient per step,
            // averaging out; its float positions are good to 1e-5 voxels.
            EXPECT_NEAR(static_cast<double>(optical_depth(volume, ray, range)), exact,
                        2e-4 * exact + 2e-5);
            total += exact;
        }
        EXPECT_GT(total, 10.0);
    }
}

TEST(OpticalDepth, PiecesAddUp)
{
    const Volume volume = volume_of(bumpy_bricks(), 20.0f, test::tilted());
    for (uint32_t i = 0; i < 200; ++i) {
        const Ray ray = test::test_ray(world_bounds(volume), i);
        double sum = 0.0;
        for (int piece = 0; piece < 7; ++piece) {
            const Interval range{0.5f * static_cast<float>(piece),
                                 0.5f * static_cast<float>(piece + 1)};
            sum += static_cast<double>(optical_depth(volume, ray, range));
        }
        const double whole = static_cast<double>(optical_depth(volume, ray, {0.0f, 3.5f}));
        EXPECT_NEAR(sum, whole, 1e-5 * whole + 1e-6);
    }
}

TEST(OpticalDepth, FarOriginsLoseNothingButTheRaysOwnRounding)
{
    const Volume volume = slab(8.0f);
    for (const float far : {1e3f, 1e6f}) {
        // Along an axis the ray's own floats are exact, so the answer must be too.
        const Ray ray{{-far, 0.51f, 0.47f}, {1.0f, 0.0f, 0.0f}};
        EXPECT_NEAR(optical_depth(volume, ray, everything), 8.0f, 2e-5f);
    }
    // A grid far from the origin, seen from nearby: world floats resolve 0.06 m there.
    Trs away;
    away.translate = Vec3d(1'000'000.0, 0.0, 0.0);
    away.scale = Vec3d(100.0);
    const Volume distant = volume_of(slab(1.0f).density, 0.08f, {{away}});
    const Ray near{{1'000'000.0f - 50.0f, 51.0f, 47.0f}, {1.0f, 0.0f, 0.0f}};
    EXPECT_NEAR(optical_depth(distant, near, everything), 8.0f, 2e-5f);
}

TEST(OpticalDepth, ConstantGridIsAHomogeneousMedium)
{
    const Volume volume = slab(5.0f);
    Rng rng(3, 0, Stream::Test, 0, 0);
    for (int i = 0; i < 200; ++i) {
        // Between points well inside the box the medium is homogeneous.
        const Vec3 a = Vec3(0.1f) + 0.75f * rng.uniform3();
        const Vec3 b = Vec3(0.1f) + 0.75f * rng.uniform3();
        const float length = glm::length(b - a);
        const Ray ray{a, (b - a) / length};
        const Interval range{0.0f, length};
        EXPECT_NEAR(optical_depth(volume, ray, range), 5.0f * length, 1e-5f);
        Media media{{volume}};
        for (const auto kind : {TransmittanceKind::Ratio, TransmittanceKind::ResidualRatio,
                                TransmittanceKind::Exact}) {
            // No variance either: bricks of one value are taken in closed form.
            EXPECT_NEAR(estimate_transmittance(media, ray, range, kind, rng),
                        std::exp(-5.0f * length), 1e-5f);
        }
    }
}

TEST(OpticalDepth, InversionFindsTheDistance)
{
    const Volume volume = volume_of(bumpy_bricks(), 20.0f, test::tilted());
    int found = 0;
    for (uint32_t i = 0; i < 500; ++i) {
        const Ray ray = test::test_ray(world_bounds(volume), i);
        Rng rng(11, 0, Stream::Test, i, 0);
        const Interval range{0.2f, 6.0f};
        const float whole = optical_depth(volume, ray, range);
        const float tau = whole * rng.uniform() * 1.2f;
        const auto hit = invert_optical_depth(volume, ray, range, tau);
        if (tau >= whole * 1.00001f) {
            EXPECT_FALSE(hit);
        }
        if (tau >= whole * 0.99999f) continue;
        ASSERT_TRUE(hit) << tau << " of " << whole;
        ++found;
        EXPECT_NEAR(optical_depth(volume, ray, {range.t0, hit->t}), tau, 1e-5f * whole + 2e-5f);
        // The object-space point is the same place as the world distance.
        const Vec3d p = Vec3d(ray.at(hit->t));
        const Vec3 expected(glm::inverse(matrix(volume.world_from_object.at(0.0f))) *
                            glm::dvec4(p, 1.0));
        EXPECT_LT(glm::length(hit->p_object - expected), 3e-6f);
    }
    EXPECT_GT(found, 200);
}

}  // namespace
}  // namespace mote
