#include <gtest/gtest.h>

#include "support/trials.h"
#include "volumes.h"
#include "volumes/ray_table.h"

namespace mote {
namespace {

using test::bumpy_bricks;
using test::everything;
using test::expect_mean;
using test::run_trials;
using test::volume_of;

TEST(RayTable, TabulatesTheOpticalDepthExactly)
{
    const Volume volume = volume_of(bumpy_bricks(), 20.0f, test::tilted());
    int found = 0;
    for (uint32_t i = 0; i < 300; ++i) {
        const Ray ray = test::test_ray(world_bounds(volume), i);
        const Interval range{0.3f, 5.0f};
        const RayTable table(volume, ray, range);
        const double whole = static_cast<double>(optical_depth(volume, ray, range));
        EXPECT_NEAR(table.depth(), whole, 1e-5 * whole + 1e-9);
        EXPECT_FALSE(table.distance_at(whole * 1.001 + 1e-9));
        Rng rng(19, 0, Stream::Test, i, 0);
        for (int k = 0; k < 10; ++k) {
            const float t = 0.3f + 4.7f * rng.uniform();
            EXPECT_NEAR(table.depth_to(t),
                        static_cast<double>(optical_depth(volume, ray, {range.t0, t})),
                        1e-5 * whole + 1e-9);
            const auto hit = table.sample_collision(rng.uniform());
            if (!(whole > 0.0)) {
                EXPECT_FALSE(hit);
                continue;
            }
            ASSERT_TRUE(hit);
            ++found;
            // The density is the derivative of the distribution function: central differences,
            // whose error is a kink of the slope (up to 20 * 64 * 2 per metre) times the step.
            const float h = 1e-4f;
            const double difference =
                std::exp(-table.depth_to(*hit - h)) - std::exp(-table.depth_to(*hit + h));
            EXPECT_NEAR(static_cast<double>(table.pdf(*hit)), difference / (2.0 * 1e-4), 0.2);
        }
    }
    EXPECT_GT(found, 500);
}

TEST(RayTableStat, SamplesFollowTheirDensity)
{
    const Volume volume = volume_of(bumpy_bricks(), 5.0f, test::tilted());
    const Vec3 middle = world_bounds(volume).centre();
    const Vec3 d = glm::normalize(Vec3(0.15f, 1.0f, 0.1f));
    const Ray ray{middle - 2.0f * d, d};
    const RayTable table(volume, ray, everything);
    ASSERT_GT(table.depth(), 0.5);
    // tau of a free flight cut at the whole depth, as for the trackers; and given a collision.
    expect_mean(run_trials(60'000, 33,
                           [&](Rng& rng) {
                               const auto t = table.sample(rng.uniform());
                               return t ? table.depth_to(*t) : table.depth();
                           }),
                1.0 - std::exp(-table.depth()), "sample");
    const double T = std::exp(-table.depth());
    expect_mean(run_trials(60'000, 34,
                           [&](Rng& rng) {
                               return table.depth_to(*table.sample_collision(rng.uniform()));
                           }),
                1.0 - table.depth() * T / (1.0 - T), "sample_collision");
}

}  // namespace
}  // namespace mote
