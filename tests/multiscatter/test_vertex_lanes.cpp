// Sums over a group of vertices, eight side by side, against the same one by one.

#include <gtest/gtest.h>

#include <set>

#include "core/rng.h"
#include "multiscatter/vertex_groups.h"
#include "multiscatter/vertex_lanes.h"
#include "restir/scenes.h"

namespace mote {
namespace {

// Of approximate_inv_sqrt, 5e-6, six times in a kernel, and rounding.
constexpr float relative = 1e-4f;

Vec3 random_direction(Rng& rng)
{
    return sample_phase(Phase{}, Vec3(0.0f, 0.0f, 1.0f), rng.uniform2());
}

std::vector<PathVertex> random_vertices(const Phase& phase, size_t count, float scale = 1.0f)
{
    std::vector<PathVertex> out(count);
    for (size_t i = 0; i < count; ++i) {
        Rng rng(3, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        out[i].x = scale * (rng.uniform3() - Vec3(0.5f));
        out[i].wo = random_direction(rng);
        out[i].phase = &phase;
        out[i].lobe = phase;
        out[i].weight = rng.uniform3();
    }
    return out;
}

std::vector<int> all_of(size_t count)
{
    std::vector<int> out(count);
    for (size_t i = 0; i < count; ++i) out[i] = static_cast<int>(i);
    return out;
}

CoarseExtinction clump_extinction()
{
    const Media media = test::lit_clumps(5.0f).media;
    return make_coarse_extinction(media, find_smoke_cells(media, 4.0f, 10'000));
}

TEST(LobeLanes, AreThePhaseFunction)
{
    for (const float g : {-0.95f, -0.3f, 0.0f, 1e-4f, 0.3f, 0.85f, 0.999f}) {
        LobeLanes lobe;
        for (int k = 0; k < lane_count; ++k) lobe.set(k, g, 0.25f);
        for (const float c : {-1.0f, -0.99f, -0.2f, 0.0f, 0.7f, 0.9999f, 1.0f}) {
            const float expected = 0.25f * eval_hg(c, g);
            EXPECT_NEAR(lobe.eval(splat(c))[5], expected, 3e-5f * expected) << g << ' ' << c;
        }
    }
}

/// Straight on is straight on, whatever directions are rounded to.
TEST(LobeLanes, PeaksAreSound)
{
    for (const float g : {-0.999f, 0.0f, 0.999f}) {
        LobeLanes lobe;
        for (int k = 0; k < lane_count; ++k) lobe.set(k, g, 1.0f);
        for (const float more : {1e-6f, 1e-5f}) {
            const float peak = eval_hg(std::copysign(1.0f, g), g);
            EXPECT_NEAR(lobe.eval(splat(std::copysign(1.0f + more, g)))[0], peak, 3e-5f * peak);
        }
    }
}

TEST(VertexLanes, KernelsAreDensitiesOfPaths)
{
    const CoarseExtinction extinction = clump_extinction();
    const Phase phase{0.7f, -0.4f, 0.3f};
    const Vec3 y(0.1f, 0.2f, -0.3f);
    const Vec3 normal = glm::normalize(Vec3(1.0f, 2.0f, -0.5f));
    const std::vector<PathVertex> vertices = random_vertices(phase, 13);
    const std::vector<int> members = all_of(vertices.size());
    const std::vector<float> shares(vertices.size(), 1.0f / 13.0f);
    LaneGroup group;
    fill_lanes(vertices, members, shares, group);
    ASSERT_EQ(group.width(), 16u);
    for (const Vec3* n : {static_cast<const Vec3*>(nullptr), &normal}) {
        std::vector<float> kernel(group.width(), -1.0f);
        eval_kernels(group, extinction, y, n, kernel);
        const GroupView view = view_of(group, y, kernel);
        double density = 0.0;
        Vec3d middle(0.0);
        for (size_t i = 0; i < vertices.size(); ++i) {
            const PathVertex& v = vertices[i];
            const Vec3 to = y - v.x;
            const Vec3 wi = glm::normalize(to);
            const float expected = phase_pdf(v.lobe, v.wo, wi) *
                                   assumed_transmittance(extinction, y, v.x) *
                                   (n ? std::abs(glm::dot(*n, wi)) : 1.0f) / glm::dot(to, to);
            EXPECT_NEAR(kernel[i], expected, relative * expected);
            density += static_cast<double>(kernel[i]) / 13.0;
            middle -= static_cast<double>(kernel[i]) / 13.0 * Vec3d(wi);
        }
        EXPECT_EQ(kernel[13], 0.0f);
        EXPECT_EQ(kernel[15], 0.0f);
        EXPECT_NEAR(view.density, density, 1e-5 * density);
        EXPECT_LT(glm::length(Vec3d(view.middle) - middle / density), 1e-4);
    }
}

/// Nothing may get lost, however far, near or dense: a vertex always sees what it has found.
TEST(VertexLanes, KernelsNeverVanish)
{
    CoarseExtinction extinction = clump_extinction();
    for (float& sigma_t : extinction.sigma_t) sigma_t *= 1e6f;
    const Phase phase{0.999f};
    for (const float scale : {1e-6f, 1.0f, 1e6f}) {
        const std::vector<PathVertex> vertices = random_vertices(phase, 8, scale);
        const std::vector<float> shares(8, 0.125f);
        LaneGroup group;
        fill_lanes(vertices, all_of(8), shares, group);
        std::vector<float> kernel(8);
        for (const Vec3& y : {vertices[0].x, vertices[1].x + 1e-7f * scale, Vec3(2.0f * scale)}) {
            eval_kernels(group, extinction, y, nullptr, kernel);
            const GroupView view = view_of(group, y, kernel);
            EXPECT_GT(view.density, 0.0f);
            for (const float k : kernel) {
                EXPECT_GT(k, 0.0f) << scale;
                EXPECT_TRUE(std::isfinite(k)) << scale;
            }
        }
    }
}

TEST(VertexLanes, LightScattersToTheWholeGroup)
{
    const Phase phase{0.6f, -0.2f, 0.5f};
    const std::vector<PathVertex> vertices = random_vertices(phase, 11);
    const std::vector<float> shares(11, 1.0f / 11.0f);
    LaneGroup group;
    fill_lanes(vertices, all_of(11), shares, group);
    PathVertex y;
    y.x = Vec3(0.8f, 0.1f, 0.0f);
    y.phase = &phase;
    y.weight = Vec3(0.5f, 0.7f, 0.9f);
    Rng rng(4, 0, Stream::Test, 0, 0);
    for (int a = 0; a < PathVertex::most_arrivals; ++a)
        y.add({random_direction(rng), rng.uniform3()});
    std::vector<float> kernel(group.width(), 0.0f);
    for (size_t i = 0; i < 11; ++i) kernel[i] = rng.uniform();
    LaneSums sums;
    sums.clear(group.lanes.size());
    std::vector<float> brought(group.width());
    scatter_to_group(group, y, kernel, sums, brought);
    scatter_to_group(group, y, kernel, sums, brought);
    for (size_t i = 0; i < 11; ++i) {
        const Vec3 wo = glm::normalize(vertices[i].x - y.x);
        Spectrum expected(0.0f);
        for (const IncidentSample& a : y.arrivals) {
            expected += kernel[i] * y.weight * eval_phase(phase, wo, a.wi) * a.E;
        }
        EXPECT_NEAR(brought[i], max_component(expected), relative * brought[i]);
        EXPECT_NEAR(sums.at(i).x, 2.0f * expected.x, 2.0f * relative * expected.x);
        EXPECT_NEAR(sums.at(i).z, 2.0f * expected.z, 2.0f * relative * expected.z);
    }
    EXPECT_EQ(brought[11], 0.0f);
}

TEST(VertexGroups, ArePartsOfAllAndCompact)
{
    const Phase phase;
    for (const size_t count : {size_t{1}, size_t{64}, size_t{65}, size_t{1000}}) {
        std::vector<PathVertex> vertices = random_vertices(phase, count);
        for (size_t i = 0; i < count; i += 7) vertices[i].x = Vec3(0.25f);  // ties
        std::vector<int> order = all_of(count);
        const std::vector<VertexGroup> groups = make_groups(vertices, 64, order);
        std::set<int> seen;
        double volume = 0.0;
        for (const VertexGroup& group : groups) {
            EXPECT_LE(group.count, 64u);
            EXPECT_GT(group.count, count > 64 ? 16u : 0u);
            Vec3 lo(infinity);
            Vec3 hi(-infinity);
            for (size_t i = group.first; i < group.first + group.count; ++i) {
                seen.insert(order[i]);
                lo = glm::min(lo, vertices[static_cast<size_t>(order[i])].x);
                hi = glm::max(hi, vertices[static_cast<size_t>(order[i])].x);
            }
            const Vec3d size(hi - lo);
            volume += size.x * size.y * size.z;
        }
        EXPECT_EQ(seen.size(), count);
        EXPECT_LE(volume, 1.0 + 1e-6);  // boxes do not overlap
    }
    std::vector<int> none;
    EXPECT_TRUE(make_groups({}, 64, none).empty());
}

}  // namespace
}  // namespace mote
