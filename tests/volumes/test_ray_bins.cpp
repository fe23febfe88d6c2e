#include <gtest/gtest.h>

#include <functional>

#include "volumes.h"
#include "volumes/ray_bins.h"

namespace mote {
namespace {

using test::bricks_of;
using test::bumpy_bricks;
using test::unit_cube;
using test::volume_of;

/// A body of haze with holes and a constant core, as everywhere in these tests, turned over the
/// shutter.
Volume moving_volume()
{
    MovingTransform transform = test::tilted();
    Trs end = transform.keys.front();
    end.translate += Vec3d(0.3, -0.1, 0.2);
    end.rotate = glm::normalize(end.rotate * glm::angleAxis(0.5, Vec3d(0.0, 0.6, 0.8)));
    transform.keys.push_back(end);
    return volume_of(bumpy_bricks(), 8.0f, transform);
}

/// Clumps of one brick's size along x with empty bricks between them.
Volume beads()
{
    const auto grid = bricks_of({128, 8, 8}, {Mat3(32.0f), Vec3(0.0f)}, [](Vec3i p) {
        return p.x / 8 % 3 == 1 ? 0.2f + 0.1f * static_cast<float>(p.y & 1) : 0.0f;
    });
    return volume_of(grid, 10.0f);
}

Media media_of(std::vector<Volume> volumes)
{
    return {std::move(volumes)};
}

struct Case {
    const char* name;
    Media media;
    double tolerance = 2e-5;  ///< of depths, relative to the whole: float sums over up to 600 cells
};

std::vector<Case> cases()
{
    const Volume still = volume_of(bumpy_bricks(), 8.0f);
    const Volume turned = volume_of(bumpy_bricks(), 5.0f, test::tilted());
    const Volume large = volume_of(bumpy_bricks(), 0.01f, test::tilted(500.0));
    const Volume nothing;
    return {
        {"one", media_of({still})},
        {"turned and scaled", media_of({turned})},
        {"moving", media_of({moving_volume()})},
        {"large", media_of({large})},
        {"constant", media_of({test::slab(3.0f)})},
        {"gaps", media_of({beads()})},
        {"overlapping", media_of({still, turned})},
        {"overlapping, moving", media_of({moving_volume(), still, beads()})},
        {"twice the same", media_of({still, still})},
        {"one of them void", media_of({nothing, still})},
        {"void", media_of({nothing})},
        {"no medium", media_of({})},
        {"thick", media_of({volume_of(bumpy_bricks(), 1e4f)})},
        {"thin", media_of({volume_of(bumpy_bricks(), 1e-6f)})},
    };
}

/// World distances round to floats: depths may differ by as much as lies in between.
double rounding(const Media& media, const RayBins& bins)
{
    double sigma_max = 0.0;
    for (const Volume& volume : media.volumes) {
        if (!is_void(volume)) {
            sigma_max += static_cast<double>(volume.density_scale * volume.density->max_value);
        }
    }
    return bins.empty()
               ? 0.0
               : sigma_max * static_cast<double>(bins.world_t(bins.s[bins.count])) * 0x1p-23;
}

Bounds3 bounds_of(const Media& media)
{
    Bounds3 bounds;
    for (const Volume& volume : media.volumes) bounds.extend(world_bounds(volume));
    if (bounds.is_empty()) bounds = {Vec3(0.0f), Vec3(1.0f)};
    return bounds;
}

std::vector<BinQuery> queries_of(const std::vector<Ray>& rays, std::vector<RayBins>& bins)
{
    std::vector<BinQuery> queries;
    for (size_t i = 0; i < rays.size(); ++i) queries.push_back({&rays[i], infinity, &bins[i]});
    return queries;
}

/// Calls f(media, ray, bins, tolerance) for rays through and around each case: from outside, from
/// inside and past it; each with its bins made alone, and made side by side with the others'.
void for_each_ray(float cut,
                  const std::function<void(const Case&, const Ray&, const RayBins&, double)>& f)
{
    for (const Case& c : cases()) {
        const Bounds3 bounds = bounds_of(c.media);
        int met = 0;
        std::vector<Ray> rays;
        for (uint32_t i = 0; i < 60; ++i) rays.push_back(test::test_ray(bounds, i));
        std::vector<RayBins> side_by_side(rays.size());
        BinCounts counts;
        make_ray_bins(c.media, queries_of(rays, side_by_side), cut, counts);
        for (size_t i = 0; i < rays.size(); ++i) {
            RayBins bins;
            make_ray_bins(c.media, rays[i], cut, bins, counts);
            const double whole =
                static_cast<double>(optical_depth(c.media, rays[i], {0.0f, infinity}));
            const double tolerance = c.tolerance * whole + rounding(c.media, bins);
            met += bins.empty() ? 0 : 1;
            SCOPED_TRACE(std::string(c.name) + ", ray " + std::to_string(i));
            f(c, rays[i], bins, tolerance);
            f(c, rays[i], side_by_side[i], tolerance);
            if (testing::Test::HasFailure()) return;
        }
        if (optical_depth(c.media, {bounds.centre(), test::along_x.d}, {0.0f, infinity}) > 0.0f) {
            EXPECT_GT(met, 20) << c.name;
        }
    }
}

TEST(RayBins, EdgesIncreaseAndHoldTheExactDepth)
{
    for_each_ray(0.0f, [](const Case& c, const Ray& ray, const RayBins& bins, double tolerance) {
        const float whole = optical_depth(c.media, ray, {0.0f, infinity});
        EXPECT_EQ(bins.empty(), !(whole > 0.0f));
        EXPECT_LE(bins.count, RayBins::capacity);
        if (bins.empty()) return;
        EXPECT_GE(bins.t0, 0.0);
        EXPECT_NEAR(bins.tau[0], 0.0f, tolerance);
        EXPECT_NEAR(bins.depth(), whole, tolerance);
        for (int k = 0; k < bins.count; ++k) {
            ASSERT_LT(bins.s[k], bins.s[k + 1]) << k;
            ASSERT_LE(bins.tau[k], bins.tau[k + 1]) << k;
        }
        for (int k = 0; k <= bins.count; ++k) {
            const float t = bins.world_t(bins.s[k]);
            ASSERT_NEAR(bins.tau[k], optical_depth(c.media, ray, {0.0f, t}), tolerance)
                << "edge " << k << " of " << bins.count;
        }
    });
}

TEST(RayBins, DepthsBetweenEdgesAreExact)
{
    for_each_ray(0.0f, [](const Case& c, const Ray& ray, const RayBins& bins, double tolerance) {
        if (bins.empty()) return;
        EXPECT_EQ(depth_to(c.media, ray, bins, bins.s[0] - 1.0f), 0.0f);
        EXPECT_EQ(depth_to(c.media, ray, bins, bins.s[bins.count]), bins.depth());
        EXPECT_EQ(depth_to(c.media, ray, bins, infinity), bins.depth());
        Rng rng(3, 0, Stream::Test, 0, 0);
        for (int i = 0; i < 10; ++i) {
            const float share = rng.uniform();
            const float s = bins.s[0] + share * (bins.s[bins.count] - bins.s[0]);
            const float t = bins.world_t(s);
            ASSERT_NEAR(depth_to(c.media, ray, bins, s), optical_depth(c.media, ray, {0.0f, t}),
                        tolerance)
                << s;
        }
    });
}

TEST(RayBins, InvertingIsTheInverse)
{
    for_each_ray(0.0f, [](const Case& c, const Ray& ray, const RayBins& bins, double tolerance) {
        Rng rng(4, 0, Stream::Test, 0, 0);
        for (int k = 0; k < bins.count; ++k) {
            const float depth = bins.depth_of_bin(k);
            EXPECT_EQ(invert_bin(c.media, ray, bins, k, 0.0f), bins.s[k]);
            EXPECT_EQ(invert_bin(c.media, ray, bins, k, infinity), bins.s[k + 1]);
            if (!(depth > 0.0f)) continue;
            EXPECT_EQ(invert_bin(c.media, ray, bins, k, depth), bins.s[k + 1]);
            float before = bins.s[k];
            float goal = 0.0f;
            for (int i = 0; i < 3; ++i) {
                goal += depth * 0.33f * rng.uniform();
                const float s = invert_bin(c.media, ray, bins, k, goal);
                ASSERT_GE(s, before);
                ASSERT_LE(s, bins.s[k + 1]);
                before = s;
                ASSERT_NEAR(depth_to(c.media, ray, bins, s) - bins.tau[k], goal, tolerance)
                    << "bin " << k;
            }
        }
    });
}

TEST(RayBins, BinOfFindsTheBinAndClamps)
{
    for_each_ray(0.0f, [](const Case&, const Ray&, const RayBins& bins, double) {
        if (bins.empty()) return;
        for (int k = 0; k < bins.count; ++k) {
            ASSERT_EQ(bin_of(bins, bins.s[k]), k);
            const float middle = 0.5f * (bins.s[k] + bins.s[k + 1]);
            ASSERT_EQ(bin_of(bins, middle), middle < bins.s[k + 1] ? k : k + 1);
        }
        ASSERT_EQ(bin_of(bins, bins.s[bins.count]), bins.count - 1);
        ASSERT_EQ(bin_of(bins, bins.s[0] - 1.0f), 0);
        ASSERT_EQ(bin_of(bins, infinity), bins.count - 1);
    });
}

TEST(RayBins, TheWalkEndsWhereNoLightGetsThrough)
{
    // Up to the cut nothing changes; behind it the depth stands still.
    constexpr float cut = 1e-3f;
    const double enough = -std::log(1e-3);
    int cut_rays = 0;
    for_each_ray(cut, [&](const Case& c, const Ray& ray, const RayBins& bins, double tolerance) {
        const double whole = static_cast<double>(optical_depth(c.media, ray, {0.0f, infinity}));
        EXPECT_GE(bins.depth(), std::min(whole, enough) - tolerance);
        if (!(bins.depth() < whole - tolerance)) return;
        ++cut_rays;
        const float t = bins.world_t(bins.s[bins.count]);
        EXPECT_NEAR(bins.depth(), optical_depth(c.media, ray, {0.0f, t}), tolerance);
    });
    EXPECT_GT(cut_rays, 40);
}

TEST(RayBins, ThinMediaAreBinnedEveryFewCellsAndDenseOnesByTransmittance)
{
    // 64 voxels: 65 cells along x, four to a bin. A depth of 0.01 closes none of them earlier.
    const Media thin = media_of({volume_of(
        bricks_of({64, 64, 64}, unit_cube(), [](Vec3i p) { return p.x % 2 ? 1.0f : 0.9f; }),
        0.01f)});
    RayBins bins;
    BinCounts counts;
    make_ray_bins(thin, test::along_x, 0.0f, bins, counts);
    EXPECT_GE(bins.count, 65 / 4);
    EXPECT_LE(bins.count, 65 / 4 + 2);
    EXPECT_EQ(counts.rays, 1);
    EXPECT_EQ(counts.bins, bins.count);
    EXPECT_GE(counts.cells, 60);
    // One constant body of depth 4: equal steps of 4 % in transmittance, 25 of them, beside those
    // at brick borders.
    const Media dense = media_of({test::slab(4.0f)});
    make_ray_bins(dense, test::along_x, 0.0f, bins, counts);
    for (int k = 0; k < bins.count; ++k) {
        const float lost = std::exp(-bins.tau[k]) - std::exp(-bins.tau[k + 1]);
        EXPECT_LT(lost, 0.0402f) << k;
    }
    EXPECT_GE(bins.count, 25);
}

TEST(RayBins, LongRaysFitByLargerBins)
{
    // 2000 cells of a ripple along the ray, thin and thick: capacity is not exceeded, nothing lost.
    const auto grid = bricks_of({2000, 4, 4}, {Mat3(100.0f), Vec3(0.0f)}, [](Vec3i p) {
        return 1.0f + 0.5f * std::sin(0.37f * static_cast<float>(p.x));
    });
    for (const float scale : {1e-4f, 0.05f, 1.0f, 30.0f}) {
        for (const bool two : {false, true}) {
            Media media = media_of({volume_of(grid, scale)});
            if (two) media.volumes.push_back(media.volumes.front());
            const Ray ray{{-1.0f, 0.02f, 0.02f}, {1.0f, 0.0f, 0.0f}};
            RayBins bins;
            BinCounts counts;
            make_ray_bins(media, ray, 0.0f, bins, counts);
            const double whole = static_cast<double>(optical_depth(media, ray, {0.0f, infinity}));
            EXPECT_GT(bins.count, 40);
            EXPECT_LE(bins.count, RayBins::capacity);
            // 2000 float additions: an error of 2000 half units in the last place at the worst.
            EXPECT_NEAR(bins.depth(), whole, 1e-4 * whole) << scale << " " << two;
        }
    }
}

TEST(RayBins, ChequeredBricksReachCapacityAndStayExact)
{
    // Every other brick is empty: each needs edges of its own until there are no more.
    const auto grid = bricks_of({1600, 4, 4}, {Mat3(100.0f), Vec3(0.0f)}, [](Vec3i p) {
        const int within = p.x % 16;
        return within > 1 && within < 7 ? 1.0f : 0.0f;
    });
    const Media media = media_of({volume_of(grid, 2.0f)});
    const Ray ray{{-1.0f, 0.02f, 0.02f}, {1.0f, 0.0f, 0.0f}};
    RayBins bins;
    BinCounts counts;
    make_ray_bins(media, ray, 0.0f, bins, counts);
    EXPECT_EQ(bins.count, RayBins::capacity);
    const float whole = optical_depth(media, ray, {0.0f, infinity});
    EXPECT_NEAR(bins.depth(), whole, 1e-5f * whole);
    for (int k = 0; k < bins.count; ++k) {
        const float t = bins.world_t(bins.s[k + 1]);
        EXPECT_NEAR(bins.tau[k + 1], optical_depth(media, ray, {0.0f, t}), 1e-5f * whole) << k;
    }
}

TEST(RayBins, GapsAreBinsOfNoDepth)
{
    const Media media = media_of({beads()});
    RayBins bins;
    BinCounts counts;
    const Ray ray{{-1.0f, 0.11f, 0.12f}, {1.0f, 0.0f, 0.0f}};
    make_ray_bins(media, ray, 0.0f, bins, counts);
    int gaps = 0;
    for (int k = 0; k < bins.count; ++k) gaps += bins.depth_of_bin(k) == 0.0f ? 1 : 0;
    // 128 voxels, dense in bricks 1, 4, 7, 10, 13: gaps between the five.
    EXPECT_EQ(gaps, 4);
}

TEST(RayBins, ExtremeDepthsStayFiniteAndOrdered)
{
    Rng rng(5, 0, Stream::Test, 0, 0);
    for (const float depth : {1e-8f, 1e-4f, 1.0f, 100.0f, 1e4f, 1e8f, 1e30f}) {
        for (const bool constant : {false, true}) {
            for (const bool two : {false, true}) {
                Media media;
                media.volumes.push_back(constant ? test::slab(depth)
                                                 : volume_of(bumpy_bricks(), depth));
                if (two) media.volumes.push_back(volume_of(bumpy_bricks(), depth, test::tilted()));
                for (const float cut : {0.0f, 1e-7f}) {
                    RayBins bins;
                    BinCounts counts;
                    const Ray& ray = test::along_x;
                    make_ray_bins(media, ray, cut, bins, counts);
                    ASSERT_FALSE(bins.empty());
                    EXPECT_GT(bins.depth(), 0.0f);
                    for (int k = 0; k < bins.count; ++k) {
                        ASSERT_TRUE(std::isfinite(bins.tau[k + 1]));
                        ASSERT_LE(bins.tau[k], bins.tau[k + 1]);
                        ASSERT_LT(bins.s[k], bins.s[k + 1]) << depth << " " << constant;
                        const float goal = bins.depth_of_bin(k) * rng.uniform();
                        const float s = invert_bin(media, ray, bins, k, goal);
                        ASSERT_GE(s, bins.s[k]);
                        ASSERT_LE(s, bins.s[k + 1]);
                        const float back = depth_to(media, ray, bins, s);
                        ASSERT_GE(back, bins.tau[k]);
                        ASSERT_LE(back, bins.tau[k + 1]);
                    }
                }
            }
        }
    }
}

TEST(RayBins, RaysThatMissAndRaysThatAreNonsense)
{
    const Media media = media_of({volume_of(bumpy_bricks(), 3.0f), test::slab(1.0f)});
    const float bad = std::numeric_limits<float>::quiet_NaN();
    for (const Ray& ray :
         {Ray{{-3.0f, 5.0f, 0.5f}, {1.0f, 0.0f, 0.0f}}, Ray{{3.0f, 0.5f, 0.5f}, {1.0f, 0.0f, 0.0f}},
          Ray{{bad, 0.5f, 0.5f}, {1.0f, 0.0f, 0.0f}}, Ray{{-3.0f, 0.5f, 0.5f}, {bad, 0.0f, 0.0f}},
          Ray{{-3.0f, 0.5f, 0.5f}, {0.0f, 0.0f, 0.0f}}}) {
        RayBins bins;
        BinCounts counts;
        make_ray_bins(media, ray, 0.0f, bins, counts);
        EXPECT_TRUE(bins.empty());
        EXPECT_EQ(bins.depth(), 0.0f);
        EXPECT_EQ(depth_to(media, ray, bins, 1.0f), 0.0f);
        make_ray_bins(media_of({media.volumes[0]}), std::vector<BinQuery>{{&ray, infinity, &bins}},
                      0.0f, counts);
        EXPECT_TRUE(bins.empty());
        EXPECT_EQ(counts.bins, 0);
    }
}

TEST(RayBins, AWrongDepthIsNoticed)
{
    // Negative control of the tolerances: a medium shifted by half a voxel fails them.
    const Volume volume = volume_of(bumpy_bricks(), 8.0f);
    Trs shift;
    shift.translate.x = 0.5 / 64.0;
    const Media shifted = media_of({volume_of(bumpy_bricks(), 8.0f, {{shift}})});
    const Media media = media_of({volume});
    int noticed = 0;
    for (uint32_t i = 0; i < 60; ++i) {
        const Ray ray = test::test_ray(world_bounds(volume), i);
        RayBins bins;
        BinCounts counts;
        make_ray_bins(shifted, ray, 0.0f, bins, counts);
        const float whole = optical_depth(media, ray, {0.0f, infinity});
        for (int k = 0; k <= bins.count && !bins.empty(); ++k) {
            const float t = bins.world_t(bins.s[k]);
            if (std::abs(bins.tau[k] - optical_depth(media, ray, {0.0f, t})) > 1e-4f * whole) {
                ++noticed;
            }
        }
    }
    EXPECT_GT(noticed, 200);
}

}  // namespace
}  // namespace mote
