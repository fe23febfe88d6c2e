#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "pinned_isa.h"
#include "volumes.h"
#include "volumes/depth_batch.h"
#include "volumes/procedural_bricks.h"

namespace mote {
namespace {

using test::everything;
using test::PinnedIsa;
using test::supported_isas;
using test::tilted;
using test::volume_of;

std::shared_ptr<const BrickGrid> plume_bricks()
{
    static const auto grid = [] {
        ProceduralParams params;
        params.kind = ProceduralKind::Plume;
        params.size = {1.0f, 2.0f, 1.0f};
        params.voxel_size = 1.0f / 48.0f;
        return make_procedural_bricks(params, 0.0);
    }();
    return grid;
}

MovingTransform drifting()
{
    MovingTransform moving = tilted();
    moving.keys.push_back(moving.keys[0]);
    moving.keys[1].translate += Vec3d(0.2, 0.4, -0.1);
    moving.keys[1].rotate = glm::normalize(Quatd(0.9, -0.1, 0.3, 0.1));
    return moving;
}

/// Three overlapping volumes: turbulence at rest, bumps with a constant core under a rotation and
/// unequal scales, turbulence that moves and turns during the shutter.
const Media& overlapping()
{
    static const Media media{{volume_of(plume_bricks(), 40.0f),
                              volume_of(test::bumpy_bricks(), 8.0f, tilted()),
                              volume_of(plume_bricks(), 20.0f, drifting())}};
    return media;
}

Bounds3 bounds_of(const Media& media)
{
    Bounds3 bounds;
    for (const Volume& volume : media.volumes) bounds.extend(world_bounds(volume));
    return bounds;
}

/// Every third ray starts inside; every fifth is parallel to an axis, or nearly.
std::vector<DepthQuery> random_queries(const Media& media, uint32_t count)
{
    const Bounds3 bounds = bounds_of(media);
    std::vector<DepthQuery> out;
    out.reserve(count);
    for (uint32_t i = 0; i < count; ++i) {
        Rng rng(3, 0, Stream::Test, i, 0);
        Ray ray = test::test_ray(bounds, i);
        if (i % 3 == 0) ray.o = bounds.centre() + 0.3f * (rng.uniform3() - 0.5f) * bounds.extent();
        if (i % 5 == 0) {
            ray.d = Vec3(0.0f);
            ray.d[static_cast<int>(i / 5 % 3)] = i % 2 ? 1.0f : -1.0f;
        }
        if (i % 25 == 0) ray.d[static_cast<int>((i / 5 + 1) % 3)] = 1e-7f * rng.uniform();
        const float t1 = i % 4 == 0 ? 2.0f * rng.uniform() : infinity;
        out.push_back({ray.o, t1, ray.d, ray.time, infinity});
    }
    return out;
}

std::vector<float> depths(const Media& media, std::span<const DepthQuery> queries)
{
    std::vector<float> tau(queries.size(), -1.0f);
    WalkCounts counts;
    optical_depths(media, queries, tau, counts);
    return tau;
}

std::vector<uint32_t> bits_of(const std::vector<float>& values)
{
    std::vector<uint32_t> out;
    out.reserve(values.size());
    for (const float v : values) out.push_back(std::bit_cast<uint32_t>(v));
    return out;
}

/// Largest excess of the difference to optical_depth, ray by ray, over what rounding explains.
/// Positions are good to 2^-24 of the grid's 100 voxels, twice (here and there): 1e-5 voxels,
/// against gradients of about the density per voxel; 64 such cells average out.
double worst_excess(const Media& media, std::span<const DepthQuery> queries,
                    const std::vector<float>& tau)
{
    double worst = -1.0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const DepthQuery& query = queries[i];
        const auto exact = static_cast<double>(
            optical_depth(media, {query.o, query.d, query.time}, {0.0f, query.t1}));
        const double difference = std::abs(static_cast<double>(tau[i]) - exact);
        worst = std::max(worst, difference - (1e-5 * exact + 2e-6));
    }
    return worst;
}

std::vector<float> marched(const Media& media, std::span<const DepthQuery> queries)
{
    std::vector<float> tau(queries.size(), -1.0f);
    WalkCounts counts;
    march_depths(media, queries, tau, counts);
    return tau;
}

TEST(DepthBatch, MarchesAreNearTheExactDepthsForAThirdOfTheLookups)
{
    // Turbulence down to the voxel, where lookups three cells apart are worst: half of all depths
    // are within 2 %, and together they have no bias that shows. Where the density is linear, the
    // midpoint rule is exact but for the outermost layer of cells.
    const Media media{{volume_of(plume_bricks(), 40.0f)}};
    const auto queries = random_queries(media, 2000);
    const std::vector<float> exact = depths(media, queries);
    const std::vector<float> near = marched(media, queries);
    std::vector<double> errors;
    double sum = 0.0;
    double sum_near = 0.0;
    for (size_t i = 0; i < exact.size(); ++i) {
        if (exact[i] < 0.1f) continue;
        sum += static_cast<double>(exact[i]);
        sum_near += static_cast<double>(near[i]);
        errors.push_back(static_cast<double>(std::abs(near[i] / exact[i] - 1.0f)));
    }
    ASSERT_GT(errors.size(), 200u);
    std::nth_element(errors.begin(), errors.begin() + static_cast<ptrdiff_t>(errors.size() / 2),
                     errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.02);
    EXPECT_NEAR(sum_near / sum, 1.0, 0.01);
    std::vector<float> tau(queries.size());
    WalkCounts walk;
    optical_depths(media, queries, tau, walk);
    WalkCounts march;
    march_depths(media, queries, tau, march);
    EXPECT_LT(2 * march.cells, walk.cells);
}

TEST(DepthBatch, MarchesGiveTheSameBitsWithAnyInstructionSetAndBatch)
{
    const Media& media = overlapping();
    const auto queries = random_queries(media, 1500);
    std::vector<uint32_t> first;
    for (const Isa isa : supported_isas()) {
        const PinnedIsa pinned(isa);
        const auto bits = bits_of(marched(media, queries));
        if (first.empty()) first = bits;
        EXPECT_EQ(bits, first) << name_of(isa);
        for (const size_t i : {0u, 7u, 300u, 1499u}) {
            const auto alone = bits_of(marched(media, std::span(queries).subspan(i, 1)));
            EXPECT_EQ(alone[0], first[i]) << name_of(isa);
        }
    }
}

TEST(DepthBatch, AgreesWithTheWalkOfOneRay)
{
    const Media& media = overlapping();
    const auto queries = random_queries(media, 4000);
    for (const Isa isa : supported_isas()) {
        const PinnedIsa pinned(isa);
        const auto tau = depths(media, queries);
        EXPECT_LT(worst_excess(media, queries, tau), 0.0) << name_of(isa);
        double sum = 0.0;
        for (const float t : tau) sum += static_cast<double>(t);
        EXPECT_GT(sum, 2000.0);
    }
}

TEST(DepthBatch, ThatComparisonSeesAThousandthOfAVoxel)
{
    const Media& media = overlapping();
    auto queries = random_queries(media, 1000);
    const auto tau = depths(media, queries);
    for (DepthQuery& query : queries) query.o += Vec3(1e-3f / 48.0f);
    EXPECT_GT(worst_excess(media, queries, tau), 1e-4);
}

TEST(DepthBatch, EveryInstructionSetGivesTheSameBits)
{
    const auto queries = random_queries(overlapping(), 2000);
    std::vector<uint32_t> scalar;
    for (const Isa isa : supported_isas()) {
        const PinnedIsa pinned(isa);
        const auto bits = bits_of(depths(overlapping(), queries));
        if (scalar.empty()) scalar = bits;
        EXPECT_EQ(bits, scalar) << name_of(isa);
    }
}

TEST(DepthBatch, ResultsDoNotDependOnTheBatch)
{
    const auto queries = random_queries(overlapping(), 1500);
    const auto whole = bits_of(depths(overlapping(), queries));
    for (const size_t size : {size_t{1}, size_t{7}, size_t{300}}) {
        for (size_t i = 0; i < queries.size(); i += size) {
            const size_t count = std::min(size, queries.size() - i);
            const auto part = bits_of(depths(overlapping(), std::span(queries).subspan(i, count)));
            for (size_t j = 0; j < count; ++j) ASSERT_EQ(part[j], whole[i + j]) << size;
        }
    }
    auto reversed = queries;
    std::reverse(reversed.begin(), reversed.end());
    auto backwards = bits_of(depths(overlapping(), reversed));
    std::reverse(backwards.begin(), backwards.end());
    EXPECT_EQ(backwards, whole);
}

TEST(DepthBatch, RaysAlongCellAndBrickBorders)
{
    // World = index coordinates, so the rays lie exactly on borders of cells (integers) and bricks
    // (multiples of 8), where a walk by another rounding may end up in the neighbour.
    Volume volume = volume_of(plume_bricks(), 1.0f);
    Trs trs;
    trs.scale = Vec3d(48.0);
    volume.world_from_object = {{trs}};
    finalize(volume);
    const Media media{{volume}};
    const Vec3 lo = plume_bricks()->index_bounds.lo;
    std::vector<DepthQuery> queries;
    for (int i = 0; i < 600; ++i) {
        Rng rng(4, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        const Vec3 cell = glm::floor(rng.uniform3() * Vec3(48.0f, 96.0f, 48.0f));
        DepthQuery query;
        query.o = lo + (i % 2 ? cell : 8.0f * glm::floor(cell / 8.0f));
        const Vec3 diagonal(glm::sign(rng.uniform3() - 0.5f));
        query.d = Vec3(0.0f);
        for (int axis = 0; axis < 3; ++axis) {
            if (i % 3 == 2 || axis == i / 3 % 3 || (i % 3 == 1 && axis != i / 9 % 3)) {
                query.d[axis] = diagonal[axis];
            }
        }
        query.d = glm::normalize(query.d);
        if (i % 7 == 0) query.d.x = -1e-9f;
        queries.push_back(query);
    }
    for (const Isa isa : supported_isas()) {
        const PinnedIsa pinned(isa);
        const auto tau = depths(media, queries);
        EXPECT_LT(worst_excess(media, queries, tau), 0.0) << name_of(isa);
        EXPECT_GT(*std::max_element(tau.begin(), tau.end()), 1.0f);
    }
    // Both against a march that knows no cells: 160 voxels in steps of 0.008 (see
    // test_optical_depth for its error).
    for (size_t i = 0; i < queries.size(); i += 11) {
        const Ray ray{queries[i].o, queries[i].d};
        const double exact = test::marched_depth(volume, ray, {0.0f, 160.0f}, 20000);
        EXPECT_NEAR(static_cast<double>(optical_depth(media, ray, everything)), exact,
                    3e-4 * exact + 1e-3);
    }
}

TEST(DepthBatch, BricksOfOneValueTakeNoCells)
{
    // Rays between points well inside a constant box never leave its constant bricks.
    const Media media{{test::slab(5.0f)}};
    std::vector<DepthQuery> queries;
    for (uint32_t i = 0; i < 200; ++i) {
        Rng rng(5, 0, Stream::Test, i, 0);
        const Vec3 from = Vec3(0.15f) + 0.6f * rng.uniform3();
        const Vec3 to = Vec3(0.15f) + 0.6f * rng.uniform3();
        queries.push_back({from, glm::length(to - from), glm::normalize(to - from)});
    }
    std::vector<float> tau(queries.size());
    WalkCounts counts;
    optical_depths(media, queries, tau, counts);
    EXPECT_EQ(counts.rays, queries.size());
    EXPECT_GT(counts.bricks, queries.size());
    EXPECT_EQ(counts.cells, 0u);
    EXPECT_EQ(counts.uniform_bricks, counts.bricks);
    for (size_t i = 0; i < queries.size(); ++i) EXPECT_NEAR(tau[i], 5.0f * queries[i].t1, 1e-5f);
}

TEST(DepthBatch, StopsBeyondTauMax)
{
    const Media& media = overlapping();
    auto queries = random_queries(media, 2000);
    const auto exact = depths(media, queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        queries[i].tau_max = i % 10 == 0 ? 0.0f : 0.2f * static_cast<float>(i % 7);
    }
    const auto tau = depths(media, queries);
    int stopped = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        if (tau[i] <= queries[i].tau_max) {
            EXPECT_EQ(tau[i], exact[i]);
        } else {
            EXPECT_LE(tau[i], exact[i]);
            stopped += tau[i] < exact[i] ? 1 : 0;
        }
    }
    EXPECT_GT(stopped, 100);
}

TEST(DepthBatch, AStopCostsLittleMoreThanTheWayThere)
{
    // 32 bricks in a row with noise of mean 1, optical depth 64: depth 8 is behind the fourth.
    Rng rng(6, 0, Stream::Test, 0, 0);
    const auto grid = test::bricks_of({16, 16, 256}, test::unit_cube(),
                                      [&](Vec3i) { return 0.5f + rng.uniform(); });
    const Media media{{volume_of(grid, 16.0f)}};
    std::vector<DepthQuery> queries;
    for (int i = 0; i < 64; ++i) {
        const Vec3 from(0.02f + 0.2f * rng.uniform(), 0.02f + 0.2f * rng.uniform(), -1.0f);
        queries.push_back({from, infinity, {0.0f, 0.0f, 1.0f}});
    }
    std::vector<float> tau(queries.size());
    WalkCounts whole;
    optical_depths(media, queries, tau, whole);
    for (DepthQuery& query : queries) query.tau_max = 8.0f;
    WalkCounts stopped;
    optical_depths(media, queries, tau, stopped);
    for (const float t : tau) EXPECT_GE(t, 8.0f);
    EXPECT_LT(stopped.cells * 3, whole.cells);
}

TEST(DepthBatch, OddInputsGiveZero)
{
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const DepthQuery good{{0.0f, 0.0f, -5.0f}};
    std::vector<DepthQuery> queries(9, good);
    queries[1].o.x = nan;
    queries[2].d.y = nan;
    queries[3].t1 = nan;
    queries[4].d = Vec3(0.0f);
    queries[5].o.z = infinity;
    queries[6].d = Vec3(infinity, 0.0f, 0.0f);
    queries[7].t1 = 0.0f;
    queries[8].t1 = -1.0f;
    const Media media{{volume_of(plume_bricks(), 9.0f)}};
    const auto tau = depths(media, queries);
    EXPECT_GT(tau[0], 0.1f);
    for (size_t i = 1; i < tau.size(); ++i) EXPECT_EQ(tau[i], 0.0f) << i;
    EXPECT_TRUE(depths(media, {}).empty());
    EXPECT_EQ(depths({}, queries)[0], 0.0f);
    Volume hollow;
    EXPECT_EQ(depths({{hollow}}, queries)[0], 0.0f);
    // A ray whose time is not a number meets nothing that moves, and whatever is at rest.
    queries[0].time = nan;
    EXPECT_EQ(depths(media, queries)[0], tau[0]);
    EXPECT_EQ(depths({{volume_of(plume_bricks(), 9.0f, drifting())}}, queries)[0], 0.0f);
}

}  // namespace
}  // namespace mote
