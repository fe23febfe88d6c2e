// Media and lines at the edge of what floats can tell: every guard has a case that needs it.
#include <gtest/gtest.h>

#include <cmath>

#include "volumes.h"
#include "volumes/blackbody.h"
#include "volumes/depth_batch.h"
#include "volumes/emissive_line.h"
#include "volumes/ray_bins.h"
#include "volumes/ray_table.h"

namespace mote {
namespace {

using test::bricks_of;
using test::bumpy_bricks;
using test::test_ray;
using test::tilted;
using test::unit_cube;
using test::volume_of;

Media two_media()
{
    return {{volume_of(bumpy_bricks(), 9.0f, tilted()), volume_of(bumpy_bricks(), 3.0f)}};
}

TEST(RayBinGuards, EveryDistanceHasABin)
{
    RayBins bins;
    EXPECT_EQ(bin_of(bins, 0.0f), 0);  // without any
    const Media media{{test::slab(3.0f)}};
    BinCounts counts;
    make_ray_bins(media, test::along_x, 0.0f, bins, counts);
    ASSERT_GT(bins.count, 3);
    const float end = bins.s[bins.count];
    EXPECT_EQ(bin_of(bins, bins.s[0] - 1.0f), 0);
    EXPECT_EQ(bin_of(bins, -infinity), 0);
    for (const float beyond : {end, end + 1.0f, infinity, std::nanf("")}) {
        EXPECT_EQ(bin_of(bins, beyond), bins.count - 1);
    }
}

TEST(RayBinGuards, DepthsAreFoundInsideTheirBins)
{
    const Media media[] = {two_media(),
                           {{volume_of(bumpy_bricks(), 20.0f, tilted(1e-3))}},
                           {{volume_of(bumpy_bricks(), 1e4f)}}};
    for (const Media& m : media) {
        Bounds3 bounds = world_bounds(m.volumes[0]);
        for (uint32_t i = 0; i < 200; ++i) {
            const Ray ray = test_ray(bounds, i);
            RayBins bins;
            BinCounts counts;
            make_ray_bins(m, ray, 0.0f, bins, counts);
            for (int k = 0; k < bins.count; ++k) {
                const float whole = bins.depth_of_bin(k);
                for (const float share : {0.0f, 1e-30f, 0.5f, 0.999999f, one_minus_epsilon, 1.0f}) {
                    const float s = invert_bin(m, ray, bins, k, share * whole);
                    ASSERT_TRUE(s >= bins.s[k] && s <= std::nextafter(bins.s[k + 1], infinity))
                        << s << " in " << bins.s[k] << ", " << bins.s[k + 1];
                }
            }
        }
    }
}

/// Rays along axes, along brick borders, and from corners.
TEST(DepthBatchGuards, RaysWithoutAStepAlongAnAxisAreExact)
{
    const Volume volume = volume_of(bumpy_bricks(), 9.0f);
    const Media media{{volume}};
    std::vector<DepthQuery> queries;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {1.0f, -1.0f}) {
            for (const float u : {0.0f, 0.125f, 0.3f, 0.5f, 0.75f, 1.0f}) {
                for (const float v : {0.0f, 0.25f, 0.4f, 0.5f, 0.625f}) {
                    Vec3 o(u);
                    o[axis] = sign > 0.0f ? -1.0f : 2.0f;
                    o[(axis + 1) % 3] = v;
                    for (const float tiny : {0.0f, -0.0f, 1e-35f, -1e-42f}) {
                        Vec3 d(tiny);
                        d[axis] = sign;
                        queries.push_back({o, infinity, d, 0.5f, infinity});
                    }
                }
            }
        }
    }
    std::vector<float> depths(queries.size());
    WalkCounts counts;
    optical_depths(media, queries, depths, counts);
    for (size_t i = 0; i < queries.size(); ++i) {
        const Ray ray{queries[i].o, queries[i].d, 0.5f};
        const float exact = optical_depth(media, ray, test::everything);
        ASSERT_NEAR(depths[i], exact, 1e-4f + 1e-4f * exact) << i;
    }
}

TEST(BlackbodyGuards, ColorsAreFiniteAtAnyTemperature)
{
    for (const float T : {-1.0f, 0.0f, 1e-30f, 499.0f, 500.0f, 500.1f, 1e4f, 1e7f, 1e30f, infinity,
                          std::nanf("")}) {
        const Spectrum color = blackbody_rgb(T);
        EXPECT_TRUE(is_finite(color)) << T;
        EXPECT_NEAR(luminance(color), 1.0f, 1e-3f) << T;
        if (std::isnan(T)) continue;
        const Spectrum exact = blackbody_rgb_exact(static_cast<double>(T));
        EXPECT_TRUE(is_finite(exact)) << T;
        EXPECT_NEAR(luminance(exact), 1.0f, 1e-3f) << T;
    }
    EXPECT_EQ(blackbody_rgb(0.0f), blackbody_rgb(500.0f));
    EXPECT_EQ(blackbody_rgb_exact(0.0), blackbody_rgb_exact(500.0));
}

/// Smoke whose only hot voxel lies between all places that are looked at.
TEST(EmissiveBrickGuards, AHotSpotBetweenLookUpsIsReached)
{
    Volume volume;
    volume.density = bricks_of({16, 16, 16}, {Mat3(16.0f), Vec3(0.0f)}, [](Vec3i) { return 1.0f; });
    volume.temperature = bricks_of({16, 16, 16}, {Mat3(16.0f), Vec3(0.0f)},
                                   [](Vec3i p) { return p == Vec3i(4) ? 3000.0f : 0.0f; });
    volume.emission_params.blackbody_scale = 1.0f;
    finalize(volume);
    const EmissiveBricks bricks = make_emissive_bricks(volume);
    const Vec3 hot(4.0f / 16.0f);
    ASSERT_GT(emission_at(volume, hot).x, 0.0f);
    ASSERT_FALSE(bricks.empty());
    EXPECT_GT(emission_pdf(volume, bricks, 0.0f, hot), 0.0f);
}

/// A temperature grid that covers a corner of the smoke only, and one that lies beside it.
TEST(EmissiveBrickGuards, SmokeOutsideTheTemperatureGridIsDark)
{
    for (const float shift : {0.0f, -64.0f, 64.0f}) {
        Volume volume;
        volume.density =
            bricks_of({64, 64, 64}, {Mat3(64.0f), Vec3(0.0f)}, [](Vec3i) { return 1.0f; });
        volume.temperature =
            bricks_of({24, 24, 24}, {Mat3(64.0f), Vec3(shift)}, [](Vec3i) { return 3000.0f; });
        volume.emission_params.blackbody_scale = 1.0f;
        finalize(volume);
        const EmissiveBricks bricks = make_emissive_bricks(volume);
        for (int z = 0; z < 8; ++z) {
            for (int x = 0; x < 8; ++x) {
                const Vec3 p = (8.0f * Vec3(x, x, z) + 4.0f) / 64.0f;
                const float j = luminance(emission_at(volume, p));
                const float pdf = emission_pdf(volume, bricks, 0.0f, p);
                EXPECT_TRUE(j == 0.0f || pdf > 0.0f) << x << " " << z;
                EXPECT_TRUE(std::isfinite(pdf)) << x << " " << z;
            }
        }
    }
}

/// The last numbers stand for places within the last bricks, in thin and in thick smoke.
TEST(EmissiveLineGuards, TheLastNumberFindsAPlace)
{
    for (const float density_scale : {1e-3f, 1.0f, 1e3f}) {
        Volume volume = volume_of(bumpy_bricks(), density_scale);
        volume.emission_params.blackbody_scale = 1.0f;
        volume.emission_params.temperature_offset = 2000.0f;
        finalize(volume);
        const EmissiveBricks bricks = make_emissive_bricks(volume);
        int found = 0;
        int lost = 0;
        for (uint32_t i = 0; i < 3000; ++i) {
            const Ray ray = test_ray(world_bounds(volume), i);
            if (!sample_emissive_line(volume, bricks, ray, 0.5f)) continue;
            const auto last = sample_emissive_line(volume, bricks, ray, one_minus_epsilon);
            last ? ++found : ++lost;
        }
        EXPECT_GT(found, 1000);
        EXPECT_LT(lost, found / 20) << density_scale;  // to the rounding of distances
    }
}

TEST(RayTableGuards, EveryCollisionHasADistance)
{
    for (const float density_scale : {1e-6f, 1e-2f, 1.0f, 1e2f, 1e6f}) {
        const Volume volume = volume_of(bumpy_bricks(), density_scale);
        for (uint32_t i = 0; i < 200; ++i) {
            const RayTable table(volume, test_ray(world_bounds(volume), i), test::everything);
            const bool meets = table.sample_collision(0.5f).has_value();
            for (const float u : {0.0f, 0.999999f, one_minus_epsilon}) {
                EXPECT_EQ(table.sample_collision(u).has_value(), meets) << i;
            }
        }
    }
}

TEST(TrackingGuards, ColorsFromGridsAreAlbedos)
{
    Volume volume = test::slab(1.0f);
    auto color = std::make_shared<ColorGrid>();
    const float values[] = {0.0f, 0.5f, 7.0f};
    for (int c = 0; c < 3; ++c) {
        color->channel[c] =
            *bricks_of({16, 16, 16}, {Mat3(16.0f), Vec3(0.0f)}, [&](Vec3i) { return values[c]; });
    }
    volume.color = color;
    finalize(volume);
    const Spectrum albedo = albedo_at(volume, Vec3(0.5f));
    EXPECT_EQ(albedo, volume.albedo * Spectrum(0.0f, 0.5f, 1.0f));
    volume.albedo = Spectrum(1.0f);
    EXPECT_EQ(albedo_at(volume, Vec3(0.5f)), Spectrum(0.0f, 0.5f, 1.0f));
}

}  // namespace
}  // namespace mote
