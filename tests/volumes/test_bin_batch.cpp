#include <gtest/gtest.h>

#include <bit>

#include "pinned_isa.h"
#include "volumes.h"
#include "volumes/ray_bins.h"

namespace mote {
namespace {

Media one_medium(float scale)
{
    return {{test::volume_of(test::bumpy_bricks(), scale, test::tilted())}};
}

std::vector<Ray> rays_through(const Media& media, uint32_t count)
{
    std::vector<Ray> rays;
    const Bounds3 bounds = world_bounds(media.volumes.front());
    for (uint32_t i = 0; i < count; ++i) rays.push_back(test::test_ray(bounds, i));
    return rays;
}

std::vector<RayBins> bins_of(const Media& media, std::span<const Ray> rays, float cut,
                             BinCounts& counts, float t_end = infinity)
{
    std::vector<RayBins> bins(rays.size());
    std::vector<BinQuery> queries;
    for (size_t i = 0; i < rays.size(); ++i) queries.push_back({&rays[i], t_end, &bins[i]});
    make_ray_bins(media, queries, cut, counts);
    return bins;
}

void expect_same_bits(const RayBins& a, const RayBins& b)
{
    ASSERT_EQ(a.count, b.count);
    EXPECT_EQ(a.cells, b.cells);
    if (a.empty()) return;
    EXPECT_EQ(a.t0, b.t0);
    for (int k = 0; k <= a.count; ++k) {
        ASSERT_EQ(std::bit_cast<uint32_t>(a.s[k]), std::bit_cast<uint32_t>(b.s[k])) << k;
        ASSERT_EQ(std::bit_cast<uint32_t>(a.tau[k]), std::bit_cast<uint32_t>(b.tau[k])) << k;
    }
}

TEST(BinBatch, TheSameBitsWithAnyInstructionSetAndAnyCompany)
{
    const Media media = one_medium(8.0f);
    const std::vector<Ray> rays = rays_through(media, 200);
    BinCounts counts;
    const std::vector<RayBins> together = bins_of(media, rays, 1e-7f, counts);
    for (const Isa isa : test::supported_isas()) {
        const test::PinnedIsa pinned(isa);
        SCOPED_TRACE(name_of(isa));
        for (size_t begin = 0, n = 1; begin < rays.size(); begin += n, n = n % 70 + 13) {
            const size_t end = std::min(begin + n, rays.size());
            BinCounts few;
            const auto bins =
                bins_of(media, std::span(rays).subspan(begin, end - begin), 1e-7f, few);
            for (size_t i = begin; i < end; ++i) expect_same_bits(bins[i - begin], together[i]);
        }
    }
}

TEST(BinBatch, CountsWhatOneByOneCounts)
{
    // Cells that rounding leaves no length count with one of the two only; where there is next to
    // nothing it decides whether a gap begins.
    for (const float scale : {0.1f, 8.0f, 300.0f}) {
        const Media media = one_medium(scale);
        const std::vector<Ray> rays = rays_through(media, 200);
        BinCounts together;
        const auto bins = bins_of(media, rays, 1e-4f, together);
        BinCounts alone;
        double bins_alone = 0.0;
        double bins_together = 0.0;
        for (size_t i = 0; i < rays.size(); ++i) {
            RayBins own;
            make_ray_bins(media, rays[i], 1e-4f, own, alone);
            EXPECT_NEAR(own.count, bins[i].count, 4) << i;
            bins_alone += own.count;
            bins_together += bins[i].count;
            EXPECT_NEAR(own.cells, bins[i].cells, 3) << i;
        }
        EXPECT_NEAR(bins_together, bins_alone, 0.03 * bins_alone);
        EXPECT_EQ(together.rays, alone.rays);
        EXPECT_EQ(together.misses, alone.misses);
        EXPECT_EQ(together.uniform_bricks, alone.uniform_bricks);
        EXPECT_NEAR(static_cast<double>(together.cells), static_cast<double>(alone.cells),
                    0.002 * static_cast<double>(alone.cells));
        EXPECT_GT(together.misses, 10);
        EXPECT_GT(together.uniform_bricks, 0);
    }
}

TEST(BinBatch, EndsWhereTheRayDoes)
{
    const Media media = one_medium(8.0f);
    const std::vector<Ray> rays = rays_through(media, 60);
    BinCounts counts;
    const auto whole = bins_of(media, rays, 0.0f, counts);
    int shorter = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        if (whole[i].empty()) continue;
        const float t_end = whole[i].world_t(0.5f * whole[i].s[whole[i].count]);
        const auto part = bins_of(media, std::span(rays).subspan(i, 1), 0.0f, counts, t_end);
        const float expected = optical_depth(media, rays[i], {0.0f, t_end});
        EXPECT_NEAR(part[0].depth(), expected, 1e-4f * whole[i].depth()) << i;
        shorter += part[0].depth() < whole[i].depth() ? 1 : 0;
    }
    EXPECT_GT(shorter, 20);
}

TEST(BinBatch, RaysAlongCellAndBrickBorders)
{
    // Lanes whose rays run in the planes between cells beside some that do not.
    const Media media{{test::volume_of(test::bumpy_bricks(), 8.0f)}};
    std::vector<Ray> rays;
    for (int i = 0; i <= 64; ++i) {
        const float at = static_cast<float>(i) / 64.0f;
        rays.push_back({{-1.0f, at, 0.5f}, {1.0f, 0.0f, 0.0f}});
        rays.push_back({{at, 2.0f, at}, {0.0f, -1.0f, 0.0f}});
        rays.push_back({{0.4f, at, -1.0f}, glm::normalize(Vec3(0.01f, 0.0f, 1.0f))});
    }
    BinCounts counts;
    const auto bins = bins_of(media, rays, 0.0f, counts);
    for (size_t i = 0; i < rays.size(); ++i) {
        const float expected = optical_depth(media, rays[i], {0.0f, infinity});
        EXPECT_NEAR(bins[i].depth(), expected, 2e-5f * expected + 1e-6f) << i;
    }
}

TEST(BinBatch, NothingToDo)
{
    BinCounts counts;
    make_ray_bins(one_medium(1.0f), std::span<const BinQuery>(), 0.0f, counts);
    EXPECT_EQ(counts.rays + counts.misses, 0);
}

}  // namespace
}  // namespace mote
