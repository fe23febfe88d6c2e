#include <gtest/gtest.h>

#include <limits>

#include "restir/domains.h"
#include "support/trials.h"

namespace mote {
namespace {

using test::TestScene;

std::vector<TestScene> scenes()
{
    return {test::sun_and_sky(0.1f), test::sun_and_sky(6.0f),      test::sun_and_sky(100.0f),
            test::camera_inside(),   test::overlapping(),          test::spheres_in_smoke(),
            test::flame_in_smoke(),  test::moving_through_a_lens()};
}

/// Calls f(frame, domain, rng) for weighted domains of rays of every scene.
template <class F>
void for_each_domain(uint32_t rays, F&& f)
{
    for (const TestScene& test : scenes()) {
        SCOPED_TRACE(test.name);
        const FrameDomain frame = test::candidates_domain(test.scene);
        int met = 0;
        for (uint32_t i = 0; i < rays; ++i) {
            Rng rng(11, 0, Stream::Test, i, 0);
            PixelDomain domain;
            BinCounts counts;
            make_pixel_domain(frame, test::random_ray(test.scene.camera, rng), domain, counts);
            if (domain.bins.empty()) continue;
            weigh_bins(frame, domain);
            ++met;
            f(frame, domain, rng);
            if (testing::Test::HasFailure()) return;
        }
        EXPECT_GT(met, static_cast<int>(rays / 4));
    }
}

double extinction(const FrameDomain& frame, const PixelDomain& domain, float s)
{
    return static_cast<double>(
        sigma_t_at(frame.scene->media, domain.ray.at(domain.bins.world_t(s)), domain.ray.time));
}

double transmittance(const FrameDomain& frame, const PixelDomain& domain, float s)
{
    return std::exp(-static_cast<double>(depth_to(frame.scene->media, domain.ray, domain.bins, s)));
}

TEST(PixelDomain, NumbersAndPointsAreInverse)
{
    for_each_domain(60, [](const FrameDomain& frame, const PixelDomain& domain, Rng& rng) {
        for (int i = 0; i < 20; ++i) {
            const float u = rng.uniform();
            const RayPoint point = point_at(frame, domain, u);
            ASSERT_GT(point.weight, 0.0f);
            ASSERT_TRUE(is_finite(point.x));
            ASSERT_GE(point.s, domain.bins.s[point.bin]);
            ASSERT_LE(point.s, domain.bins.s[point.bin + 1]);
            EXPECT_EQ(point.x, domain.ray.at(domain.bins.world_t(point.s)));
            const std::optional<RayNumber> number = number_at(frame, domain, point.s);
            if (!number) {  // s rounded to where nothing scatters
                EXPECT_LT(extinction(frame, domain, point.s), 1e-3);
                continue;
            }
            // s is rounded; a step of it moves u by the density.
            const double step = static_cast<double>(number->density) * 1e-6;
            EXPECT_NEAR(number->u, u, 1e-5 + step) << "s = " << point.s;
            const double expected =
                extinction(frame, domain, point.s) * transmittance(frame, domain, point.s);
            const double weight = static_cast<double>(point.weight);
            EXPECT_NEAR(weight * static_cast<double>(number->density), expected,
                        1e-3 * expected + 1e-12);
        }
    });
}

TEST(PixelDomain, DensityIsTheDerivativeOfTheNumber)
{
    int compared = 0;
    for_each_domain(60, [&](const FrameDomain& frame, const PixelDomain& domain, Rng& rng) {
        const RayBins& bins = domain.bins;
        for (int i = 0; i < 20; ++i) {
            const float s = bins.s[0] + rng.uniform() * (bins.s[bins.count] - bins.s[0]);
            const int k = bin_of(bins, s);
            constexpr float h = 2e-3f;
            if (s - h < bins.s[k] || s + h > bins.s[k + 1]) continue;
            const auto middle = number_at(frame, domain, s);
            const auto before = number_at(frame, domain, s - h);
            const auto after = number_at(frame, domain, s + h);
            if (!middle || !before || !after) continue;
            const float difference = (after->u - before->u) / (2.0f * h);
            // Rounding of depths, 1e-6, over the step; and curvature: the density may bend by a few
            // per cent over 4 mm in the thickest scene.
            EXPECT_NEAR(difference, middle->density, 1e-6f / h + 0.05f * middle->density)
                << "s = " << s;
            ++compared;
        }
    });
    EXPECT_GT(compared, 500);
}

TEST(PixelDomain, WeightsIntegrateToWhatCollides)
{
    // weight is sigma_t T over the density: its mean over u is 1 - T of the whole ray. Midpoints
    // of u: each bin's share is off by one step at the most.
    constexpr int steps = 4000;
    for_each_domain(12, [&](const FrameDomain& frame, const PixelDomain& domain, Rng&) {
        double sum = 0.0;
        double most = 0.0;
        for (int i = 0; i < steps; ++i) {
            const float u = (static_cast<float>(i) + 0.5f) / steps;
            const auto weight = static_cast<double>(point_at(frame, domain, u).weight);
            sum += weight;
            most = std::max(most, weight);
        }
        const double exact = -std::expm1(-static_cast<double>(domain.bins.depth()));
        EXPECT_NEAR(sum / steps, exact, 2.0 * most * domain.bins.count / steps + 1e-6);
        EXPECT_NEAR(sum / steps, exact, 0.02 * exact);
    });
}

TEST(PixelDomain, PlacesWithoutMediumHaveNoNumber)
{
    const TestScene test = test::spheres_in_smoke();
    const FrameDomain frame = test::candidates_domain(test.scene);
    Rng rng(1, 0, Stream::Test, 0, 0);
    PixelDomain domain;
    BinCounts counts;
    make_pixel_domain(frame, generate_ray(test.scene.camera, {4.0f, 3.0f}, Vec2(0.5f), 0.0f),
                      domain, counts);
    ASSERT_FALSE(domain.bins.empty());
    weigh_bins(frame, domain);
    const float bad = std::numeric_limits<float>::quiet_NaN();
    const float end = domain.bins.s[domain.bins.count];
    for (const float s : {domain.bins.s[0] - 0.1f, end + 0.1f, infinity, -infinity, bad}) {
        EXPECT_FALSE(number_at(frame, domain, s)) << s;
    }
    make_pixel_domain(frame, Ray{{0.0f, 5.0f, 5.0f}, {1.0f, 0.0f, 0.0f}, 0.0f}, domain, counts);
    EXPECT_EQ(domain.Z(), 0.0f);
    EXPECT_EQ(point_at(frame, domain, 0.5f).weight, 0.0f);
    EXPECT_FALSE(number_at(frame, domain, 0.0f));
}

TEST(PixelDomain, EveryBinWithDepthKeepsAShareWhateverTheCachesSay)
{
    // Zeros, spikes and noise of 60 decades instead of the lights' importance, in smoke of any
    // thickness: no bin is lost, and no weight above 1,000 times the mean arises.
    using Value = float (*)(size_t);
    const Value garbage[] = {
        [](size_t) { return 0.0f; },
        [](size_t i) { return i % 97 == 0 ? 1e20f : 0.0f; },
        [](size_t i) {
            Rng rng(5, 0, Stream::Test, static_cast<uint32_t>(i), 0);
            return std::pow(10.0f, 60.0f * rng.uniform() - 30.0f);
        },
    };
    for (const float density : {0.01f, 4.0f, 300.0f}) {
        TestScene test = test::spheres_in_smoke();
        test.scene.media.volumes = {test::clumps(density)};
        for (const Value value : garbage) {
            LightCaches caches = *make_light_caches(test.scene, {}, nullptr);
            caches.cells->overwrite(value, Vec3(0.0f));
            const FrameDomain frame = make_frame_domain(
                test::borrow(test.scene), std::make_shared<const LightCaches>(caches), {});
            for (uint32_t i = 0; i < 20; ++i) {
                Rng rng(13, 0, Stream::Test, i, 0);
                PixelDomain domain;
                BinCounts counts;
                make_pixel_domain(frame, test::random_ray(test.scene.camera, rng), domain, counts);
                if (domain.bins.empty()) continue;
                weigh_bins(frame, domain);
                ASSERT_GT(domain.Z(), 0.0f);
                ASSERT_TRUE(std::isfinite(domain.Z()));
                for (int k = 0; k < domain.bins.count; ++k) {
                    const float width = domain.cdf[k + 1] - domain.cdf[k];
                    ASSERT_GE(width, 0.0f);
                    if (!(domain.bins.depth_of_bin(k) > 0.0f)) continue;
                    ASSERT_GT(width, 0.0f) << "bin " << k << " at depth " << domain.bins.tau[k];
                    // The middle of the bin's numbers leads back into it.
                    const float u = (domain.cdf[k] + 0.5f * width) / domain.Z();
                    const RayPoint point = point_at(frame, domain, u);
                    ASSERT_EQ(point.bin, k);
                    ASSERT_GT(point.weight, 0.0f);
                    ASSERT_LT(point.weight, 1000.0f);
                }
            }
        }
    }
}

TEST(LinearWeights, AgreeWithQuadrature)
{
    // Integrals over [0, D] of exp(-tau) (1 - tau/D) and exp(-tau) tau/D by Simpson's rule in
    // double: exact to 1e-10. The closed form cancels most at D = 0.1: 2e-6 there.
    for (double D = 1e-6; D < 50.0; D *= 1.3) {
        constexpr int pieces = 2000;
        double a = 0.0;
        double b = 0.0;
        for (int i = 0; i <= pieces; ++i) {
            const double share = static_cast<double>(i) / pieces;
            const double weight = (i == 0 || i == pieces ? 1.0 : i % 2 ? 4.0 : 2.0) / 3.0;
            const double density = weight * std::exp(-D * share) * D / pieces;
            a += density * (1.0 - share);
            b += density * share;
        }
        const Vec2 weights = linear_weights(static_cast<float>(D));
        EXPECT_NEAR(weights.x, a, 3e-6 * a) << D;
        EXPECT_NEAR(weights.y, b, 3e-6 * b) << D;
    }
    EXPECT_EQ(linear_weights(0.0f), Vec2(0.0f));
    for (const float D : {100.0f, 1e4f, 1e8f, 1e30f}) {
        EXPECT_NEAR(linear_weights(D).x, 1.0f, 1.1f / D) << D;
        EXPECT_NEAR(linear_weights(D).y, 1.0f / D, 1e-6f / D) << D;
    }
}

}  // namespace
}  // namespace mote
