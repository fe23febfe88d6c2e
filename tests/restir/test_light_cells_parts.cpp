// What the light cells are made of: approximations, coarse optical depths, light cuts.
#include <gtest/gtest.h>

#include "core/float8.h"
#include "restir/light_cells_scene.h"
#include "restir/light_cut.h"

namespace mote {
namespace {

TEST(Float8, ApproximationsKeepToTheirStatedErrors)
{
    for (int i = 0; i < 4000; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / 4000.0f;
        const float large = std::exp2(240.0f * u - 120.0f);
        const float inv = approximate_inv_sqrt(splat(large))[3];
        EXPECT_NEAR(inv * std::sqrt(large), 1.0f, 5e-6f) << large;
        const float e = approximate_exp(splat(-87.0f * u))[5];
        EXPECT_NEAR(e / std::exp(-87.0f * u), 1.0f, 1e-5f) << -87.0f * u;
        const float above_one = std::exp2(100.0f * u * u);
        EXPECT_NEAR(approximate_log(splat(above_one))[7], std::log(above_one), 3e-5f) << above_one;
    }
    EXPECT_EQ(approximate_exp(splat(-infinity))[0], approximate_exp(splat(-87.0f))[0]);
}

TEST(CoarseExtinction, OpticalDepthsAreNearTheExactOnes)
{
    // Means over cells of 4 voxels: a tenth of the mean depth, and 30 % for single rays on average.
    const Media media = test::clumpy_media();
    const SmokeCells cells = find_smoke_cells(media, 4.0f, 100'000);
    const CoarseExtinction extinction = make_coarse_extinction(media, cells);
    double sum = 0.0;
    double exact_sum = 0.0;
    double error_sum = 0.0;
    for (uint32_t k = 0; k < 500; ++k) {
        Rng rng(9, 0, Stream::Test, k, 0);
        const Vec3 a = 1.6f * rng.uniform3() - 0.8f;
        const Vec3 b = (k % 2 == 0 ? 1.6f : 20.0f) * (rng.uniform3() - 0.5f);
        Float8 tau;
        coarse_optical_depths(extinction, a, splat(b.x), splat(b.y), splat(b.z), 16, tau);
        const float distance = glm::length(b - a);
        const float exact = optical_depth(media, {a, (b - a) / distance, 0.5f}, {0.0f, distance});
        sum += static_cast<double>(tau[2]);
        exact_sum += static_cast<double>(exact);
        error_sum += static_cast<double>(std::abs(tau[2] - exact));
    }
    EXPECT_NEAR(sum / exact_sum, 1.0, 0.1);
    EXPECT_LT(error_sum / exact_sum, 0.3);
}

TEST(CoarseExtinction, FarAndHostilePointsGiveFiniteDepths)
{
    const Media media = test::clumpy_media();
    const CoarseExtinction extinction =
        make_coarse_extinction(media, find_smoke_cells(media, 4.0f, 100'000));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Float8 x{0.0f, 1e30f, -1e30f, infinity, nan, 0.1f, -2.0f, 0.0f};
    Float8 tau;
    coarse_optical_depths(extinction, Vec3(0.0f), x, splat(0.0f), splat(0.0f), 16, tau);
    for (int l = 0; l < lane_count; ++l) EXPECT_TRUE(tau[l] >= 0.0f && tau[l] < 1e3f) << l;
    coarse_optical_depths(extinction, Vec3(1e9f), x, x, x, 16, tau);
    for (int l = 0; l < lane_count; ++l) EXPECT_TRUE(tau[l] >= 0.0f && tau[l] < 1e3f) << l;
}

TEST(LightCut, CoversAllLightsOnceAndNearOnesSingly)
{
    const Media media = test::clumpy_media();
    const CoarseExtinction extinction =
        make_coarse_extinction(media, find_smoke_cells(media, 4.0f, 100'000));
    const std::vector<LocalLight> lights = test::random_lights(5000);
    const LightClusters clusters = make_light_clusters(lights);
    std::vector<int> cut;
    for (uint32_t k = 0; k < 40; ++k) {
        const Vec3 x = 0.5f * lights[k].position;
        choose_light_cut(clusters, extinction, x, 0.02f, 64, cut);
        EXPECT_LE(cut.size(), 64u);
        int next = 0;
        int nearest = 0;
        for (int l = 1; l < 5000; ++l) {
            const auto distance = [&](int id) {
                return glm::length(lights[static_cast<size_t>(id)].position - x);
            };
            if (distance(l) < distance(nearest)) nearest = l;
        }
        for (const int n : cut) {
            const LightCluster& node = clusters.nodes[static_cast<size_t>(n)];
            EXPECT_EQ(node.begin, next);
            next = node.end;
            const int place = clusters.place(nearest);
            if (place >= node.begin && place < node.end) {
                EXPECT_LT(node.end - node.begin, 100);  // of 5000
            }
        }
        EXPECT_EQ(next, 5000);
    }
}

TEST(LightClusters, LightsInOnePlaceAreStillToldApart)
{
    std::vector<LocalLight> lights = test::random_lights(300);
    for (LocalLight& light : lights) light.position = Vec3(0.2f);
    const LightCells cells(test::clumpy_media(), lights, test::test_eye);
    EXPECT_NEAR(test::pmf_sum(cells, 300, Vec3(0.2f)), 1.0, 1e-5);
    for (int i = 0; i < 300; ++i) EXPECT_GT(cells.pmf(i, Vec3(0.2f)), 0.0f);
}

}  // namespace
}  // namespace mote
