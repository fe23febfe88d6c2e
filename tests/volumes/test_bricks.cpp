#include <gtest/gtest.h>

#include "support/trials.h"
#include "volumes.h"
#include "volumes/brick_walk.h"
#include "volumes/procedural_density.h"

namespace mote {
namespace {

using test::bricks_of;
using test::bumpy;

const BrickGrid& bumpy_grid()
{
    static const auto grid = bricks_of({70, 61, 67}, test::unit_cube(), bumpy);
    return *grid;
}

TEST(Bricks, ReconstructionAtVoxelsIsTheVoxel)
{
    const BrickGrid& grid = bumpy_grid();
    for (int x = -2; x < 72; ++x) {
        for (int y = -2; y < 63; ++y) {
            for (int z = -2; z < 69; ++z) {
                const bool inside = x >= 0 && y >= 0 && z >= 0 && x < 70 && y < 61 && z < 67;
                const float expected = inside ? bumpy({x, y, z}) : 0.0f;
                ASSERT_EQ(sample_trilinear(grid, Vec3(x, y, z)), expected);
            }
        }
    }
}

TEST(Bricks, SupportReachesOneVoxelBeyondTheData)
{
    // One voxel at a brick corner: the hat function touches eight bricks.
    const auto grid = bricks_of({1, 1, 1}, {}, [](Vec3i) { return 2.0f; });
    EXPECT_EQ(grid->active_bricks(), 8u);
    EXPECT_FLOAT_EQ(sample_trilinear(*grid, {-0.5f, -0.25f, 0.5f}), 2.0f * 0.5f * 0.75f * 0.5f);
    EXPECT_EQ(sample_trilinear(*grid, {-1.0f, 0.0f, 0.0f}), 0.0f);
    EXPECT_EQ(sample_trilinear(*grid, {1.0f, 0.0f, 0.0f}), 0.0f);
    EXPECT_EQ(grid->sum, 2.0);
}

TEST(Bricks, NonFinitePointsAndFarPointsAreOutside)
{
    const BrickGrid& grid = bumpy_grid();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float v : {nan, infinity, -infinity, 1e30f, -1e30f}) {
        EXPECT_EQ(sample_trilinear(grid, {v, 5.0f, 5.0f}), 0.0f);
        EXPECT_EQ(sample_trilinear(grid, {5.0f, 5.0f, v}), 0.0f);
    }
    EXPECT_EQ(sample_trilinear(BrickGrid{}, Vec3(0.0f)), 0.0f);
}

TEST(Bricks, RangesBoundTheReconstructionAndTheMeanIsExact)
{
    const BrickGrid& grid = bumpy_grid();
    int checked = 0;
    for (int z = 0; z < grid.brick_count.z; ++z) {
        for (int y = 0; y < grid.brick_count.y; ++y) {
            for (int x = 0; x < grid.brick_count.x; ++x) {
                const int32_t brick = grid.table[grid.table_index(x, y, z)];
                if (brick <= 0) continue;
                const BrickRange range = grid.ranges[static_cast<size_t>(brick)];
                // Gauss-Legendre with two points per axis integrates each cell's trilinear exactly.
                double sum = 0.0;
                for (int n = 0; n < 8 * 512; ++n) {
                    const auto at = [&](int cell, int bit) {
                        return static_cast<float>(cell) + (bit ? 0.78867513f : 0.21132487f);
                    };
                    const Vec3 p =
                        Vec3(8 * x, 8 * y, 8 * z) +
                        Vec3(at(n >> 3 & 7, n & 1), at(n >> 6 & 7, n & 2), at(n >> 9 & 7, n & 4));
                    const float v = sample_local(grid, p);
                    ASSERT_LE(v, range.max * 1.000001f);
                    ASSERT_GE(v, range.min * 0.999999f);
                    sum += static_cast<double>(v);
                }
                // 4096 float lookups, each within 1e-6 of the exact value.
                ASSERT_NEAR(sum / 4096.0, static_cast<double>(range.mean), 1e-6);
                ++checked;
            }
        }
    }
    EXPECT_GT(checked, 300);
}

TEST(Bricks, BricksOfOneValueShareStorage)
{
    const auto grid = bricks_of({160, 160, 160}, {}, [](Vec3i) { return 0.5f; });
    // 21^3 positions, of which 19^3 hold nothing but 0.5.
    EXPECT_EQ(grid->active_bricks(), 21u * 21u * 21u - 19u * 19u * 19u + 1u);
    EXPECT_EQ(grid->max_value, 0.5f);
}

TEST(Bricks, SkipDistancesAreExact)
{
    const auto lone = bricks_of({100, 64, 80}, {}, [](Vec3i p) {
        const bool first = p.x == 4 && p.y == 4 && p.z == 4;
        return first || (p.x > 84 && p.y > 60 && p.z == 70) ? 1.0f : 0.0f;
    });
    std::vector<Vec3i> filled;
    const auto each = [&](auto&& f) {
        for (int z = 0; z < lone->brick_count.z; ++z) {
            for (int y = 0; y < lone->brick_count.y; ++y) {
                for (int x = 0; x < lone->brick_count.x; ++x) {
                    f(Vec3i(x, y, z), lone->table[lone->table_index(x, y, z)]);
                }
            }
        }
    };
    each([&](Vec3i p, int32_t entry) {
        if (entry > 0) filled.push_back(p);
    });
    ASSERT_FALSE(filled.empty());
    each([&](Vec3i p, int32_t entry) {
        if (entry > 0) return;
        int nearest = 16;  // the longest that is stored
        for (const Vec3i& q : filled) {
            const Vec3i d = glm::abs(p - q);
            nearest = std::min(nearest, std::max(d.x, std::max(d.y, d.z)));
        }
        EXPECT_EQ(entry, -nearest);
    });
}

/// Spans of the walk against a brute-force march: every point of the ray that lies well inside a
/// stored brick must be in exactly one span, of that brick; spans are ordered and disjoint.
void check_walk(const BrickGrid& grid, const LocalRay& ray)
{
    std::vector<BrickSpan> spans;
    for_each_brick(grid, ray, [&](const BrickSpan& span) {
        spans.push_back(span);
        return true;
    });
    for (size_t i = 0; i < spans.size(); ++i) {
        ASSERT_LT(spans[i].s0, spans[i].s1);
        ASSERT_GE(spans[i].s0, i == 0 ? 0.0f : spans[i - 1].s1);
        ASSERT_LE(spans[i].s1, ray.s1);
    }
    size_t next = 0;
    for (int i = 0; i < 400; ++i) {
        const float s = ray.s1 * (static_cast<float>(i) + 0.5f) / 400.0f;
        const Vec3 p = ray.at(s);
        const Vec3 in_brick = p - 8.0f * glm::floor(p / 8.0f);
        const bool near_border = glm::any(glm::lessThan(in_brick, Vec3(0.01f))) ||
                                 glm::any(glm::greaterThan(in_brick, Vec3(7.99f)));
        if (near_border) continue;
        const Vec3i c = Vec3i(p) / 8;
        const int32_t expected = grid.table[grid.table_index(c.x, c.y, c.z)];
        while (next < spans.size() && spans[next].s1 <= s) ++next;
        const bool in_span = next < spans.size() && spans[next].s0 <= s;
        ASSERT_EQ(in_span, expected > 0) << "at s = " << s;
        if (in_span) {
            ASSERT_EQ(spans[next].brick, expected);
        }
    }
}

TEST(BrickWalk, SpansTileTheBricksAlongRandomRays)
{
    const BrickGrid& grid = bumpy_grid();
    const GridFrame frame{glm::dmat3(1.0), -Vec3d(grid.lo)};
    int hits = 0;
    for (uint32_t i = 0; i < 3000; ++i) {
        const Ray ray = test::test_ray({Vec3(0.0f), Vec3(70.0f)}, i);
        const LocalRay local = make_local_ray(grid, frame, ray, {0.0f, infinity});
        if (local.misses()) continue;
        ++hits;
        check_walk(grid, local);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(hits, 1000);
}

TEST(BrickWalk, SparseGridsAreCrossedInJumps)
{
    const auto grid = bricks_of({300, 40, 300}, {}, [](Vec3i p) {
        return p.x < 5 || p.x > 294 || (p.z == 150 && p.x == 150) ? 1.0f : 0.0f;
    });
    const GridFrame frame{glm::dmat3(1.0), -Vec3d(grid->lo)};
    for (uint32_t i = 0; i < 1000; ++i) {
        const Ray ray = test::test_ray({Vec3(0.0f), Vec3(300.0f, 40.0f, 300.0f)}, i);
        check_walk(*grid, make_local_ray(*grid, frame, ray, {0.0f, infinity}));
        if (HasFatalFailure()) return;
    }
}

TEST(BrickWalk, AxisParallelAndGrazingRays)
{
    const BrickGrid& grid = bumpy_grid();
    const GridFrame frame{glm::dmat3(1.0), -Vec3d(grid.lo)};
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {-1.0f, 1.0f}) {
            for (const float offset : {0.0f, 8.0f, 15.999999f, 16.0f, 20.3f, 66.0f, 70.0f}) {
                Ray ray;
                ray.o = Vec3(offset);
                ray.o[axis] = sign > 0.0f ? -100.0f : 200.0f;
                ray.d = Vec3(0.0f);
                ray.d[axis] = sign;
                check_walk(grid, make_local_ray(grid, frame, ray, {0.0f, infinity}));
                if (HasFatalFailure()) return;
            }
        }
    }
}

TEST(BrickWalk, MissesNanAndEmptyRangesCrossNothing)
{
    const BrickGrid& grid = bumpy_grid();
    const GridFrame frame{glm::dmat3(1.0), -Vec3d(grid.lo)};
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto crosses = [&](const Ray& ray, Interval range) {
        bool any = false;
        for_each_brick(grid, make_local_ray(grid, frame, ray, range), [&](const BrickSpan&) {
            any = true;
            return true;
        });
        return any;
    };
    const Ray through{{-10.0f, 30.0f, 30.0f}, {1.0f, 0.0f, 0.0f}};
    EXPECT_TRUE(crosses(through, {0.0f, infinity}));
    EXPECT_FALSE(crosses(through, {0.0f, 1.0f}));
    EXPECT_FALSE(crosses(through, {200.0f, infinity}));
    EXPECT_FALSE(crosses(through, {50.0f, 40.0f}));
    EXPECT_FALSE(crosses({{-10.0f, 30.0f, 30.0f}, {-1.0f, 0.0f, 0.0f}}, {0.0f, infinity}));
    EXPECT_FALSE(crosses({{nan, 30.0f, 30.0f}, {1.0f, 0.0f, 0.0f}}, {0.0f, infinity}));
    EXPECT_FALSE(crosses({{0.0f, 30.0f, 30.0f}, {nan, nan, nan}}, {0.0f, infinity}));
    EXPECT_FALSE(crosses({{0.0f, 30.0f, 30.0f}, {0.0f, 0.0f, 0.0f}}, {0.0f, infinity}));
    const BrickGrid empty;
    EXPECT_TRUE(make_local_ray(empty, frame, through, {0.0f, infinity}).misses());
}

TEST(Procedural, DensitiesStayInRangeAndThePlumeHasGaps)
{
    for (const ProceduralKind kind : {ProceduralKind::Box, ProceduralKind::Sphere,
                                      ProceduralKind::Puff, ProceduralKind::Plume}) {
        ProceduralParams params;
        params.kind = kind;
        params.voxel_size = 0.05f;
        const ProceduralDensity density(params, 0.4);
        int filled = 0;
        for (int i = 0; i < 8000; ++i) {
            const float v = density.at({i / 400, i / 20 % 20, i % 20});
            ASSERT_GE(v, 0.0f);
            ASSERT_LE(v, 1.0f);
            filled += v > 0.0f ? 1 : 0;
        }
        EXPECT_GT(filled, 400);
        if (kind != ProceduralKind::Box) {
            EXPECT_LT(filled, 6000);
        }
    }
}

}  // namespace
}  // namespace mote
