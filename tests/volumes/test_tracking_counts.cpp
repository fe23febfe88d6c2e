#include <gtest/gtest.h>

#include "core/rng.h"
#include "volumes.h"
#include "volumes/tracking_counts.h"

namespace mote {
namespace {

using test::bumpy_bricks;
using test::everything;
using test::volume_of;

constexpr int ray_count = 400;

/// Work of free flights and transmittances through a volume.
TrackingCounts count(const Volume& volume, TransmittanceKind kind)
{
    const Media media{{volume}};
    const Bounds3 bounds = world_bounds(volume);
    const TrackingCounts start = tracking_counts;
    for (uint32_t i = 0; i < ray_count; ++i) {
        const Ray ray = test::test_ray(bounds, i);
        Rng rng(7, 0, Stream::Test, i, 0);
        (void)sample_free_flight(media, ray, everything, rng);
        (void)estimate_transmittance(media, ray, everything, kind, rng);
    }
    return tracking_counts.since(start);
}

/// The same densities in bricks that understate their largest one.
std::shared_ptr<const BrickGrid> understated(float share)
{
    auto grid = std::make_shared<BrickGrid>(*bumpy_bricks());
    for (BrickRange& range : grid->ranges) {
        if (range.min < range.max) range.max *= share;
    }
    return grid;
}

}  // namespace

TEST(TrackingCounts, NoBoundIsBroken)
{
    for (const float scale : {1.0f, 6.0f, 40.0f, 3000.0f}) {
        for (const auto kind : {TransmittanceKind::Ratio, TransmittanceKind::ResidualRatio}) {
            const TrackingCounts counts = count(volume_of(bumpy_bricks(), scale), kind);
            EXPECT_EQ(counts.majorant_violations, 0) << scale;
            EXPECT_EQ(counts.shadow_rays, ray_count);
            EXPECT_GT(counts.lookups + counts.closed_bricks, 0) << scale;
        }
    }
}

TEST(TrackingCounts, BoundsThatAreTooLowAreFound)
{
    // A hundredth is enough: bumps reach their brick's maximum at a voxel, which lookups come near.
    for (const auto kind : {TransmittanceKind::Ratio, TransmittanceKind::ResidualRatio}) {
        EXPECT_GT(count(volume_of(understated(0.9f), 40.0f), kind).majorant_violations, 10);
        EXPECT_GT(count(volume_of(understated(0.99f), 40.0f), kind).majorant_violations, 0);
    }
}

TEST(TrackingCounts, ExactTransmittanceLooksNothingUp)
{
    const Media media{{volume_of(bumpy_bricks(), 6.0f)}};
    const Ray ray = test::test_ray(world_bounds(media.volumes[0]), 3);
    Rng rng(7, 0, Stream::Test, 0, 0);
    const TrackingCounts start = tracking_counts;
    (void)estimate_transmittance(media, ray, everything, TransmittanceKind::Exact, rng);
    const TrackingCounts counts = tracking_counts.since(start);
    EXPECT_EQ(counts.lookups, 0);
    EXPECT_EQ(counts.shadow_rays, 1);
}

}  // namespace mote
