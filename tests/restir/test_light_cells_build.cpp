#include <gtest/gtest.h>

#include "core/parallel.h"
#include "core/stats.h"
#include "restir/light_cells_scene.h"

namespace mote {
namespace {

using test::test_eye;

TEST(LightCellsBuild, NothingIsBuiltWithoutLightsOrSmoke)
{
    const LightCells none(test::clumpy_media(), {}, test_eye);
    EXPECT_TRUE(none.is_empty());
    EXPECT_EQ(none.cell_count(), 0u);
    EXPECT_EQ(none.sample(Vec3(0.0f), 0.5).light, -1);
    EXPECT_EQ(none.inscatter(Vec3(0.0f)), 0.0f);

    const LightCells no_smoke(Media{}, test::random_lights(10), test_eye);
    EXPECT_EQ(no_smoke.cell_count(), 0u);
    EXPECT_NEAR(test::pmf_sum(no_smoke, 10, Vec3(0.0f)), 1.0, 1e-6);

    Volume hollow = test::constant_cube();
    hollow.density_scale = 0.0f;
    EXPECT_EQ(LightCells(Media{{hollow}}, test::random_lights(10), test_eye).cell_count(), 0u);
}

TEST(LightCellsBuild, OneLightIsAlwaysChosenAndStillWeighsDistances)
{
    const LightCells cells(test::clumpy_media(), test::random_lights(1), test_eye);
    EXPECT_EQ(cells.sample(Vec3(0.0f), 0.3).light, 0);
    EXPECT_EQ(cells.sample(Vec3(0.0f), 0.3).pmf, 1.0f);
    EXPECT_EQ(cells.pmf(0, Vec3(9.0f)), 1.0f);
    const Vec3 lamp = test::random_lights(1)[0].position;
    EXPECT_GT(cells.inscatter(0.8f * lamp), cells.inscatter(-0.5f * lamp));
}

/// What all lights scatter to the eye at x, by plain marching.
double inscatter_by_marching(const Media& media, const std::vector<LocalLight>& lights, Vec3 x)
{
    const Volume& volume = media.volumes[0];
    const Vec3 wo = glm::normalize(test_eye - x);
    double sum = 0.0;
    for (const LocalLight& light : lights) {
        const Vec3 to_light = light.position - x;
        const float distance = glm::length(to_light);
        const double tau = test::marched_depth(volume, x, light.position, 60);
        const float phase = eval_phase(volume.phase, wo, to_light / distance);
        sum += static_cast<double>(light.power * inv_4pi / sqr(distance) * phase) * std::exp(-tau);
    }
    return sum;
}

TEST(LightCellsBuild, InscatterIsNearTheSumOverAllLights)
{
    // Approximate by design: coarse transmittance, clusters, interpolation, here with only 12 cells
    // across. Stated: a factor of 1.25 on average; of a point's standard deviation 1.5, or 2 for a
    // single light, whose shadows nothing fills. Measured: 1.04 to 1.17, and 1.2 or 1.8.
    const Media media = test::clumpy_media();
    for (const int count : {1, 40, 400}) {
        const std::vector<LocalLight> lights = test::random_lights(count);
        const LightCells cells(media, lights, test_eye);
        RunningStats log_ratio;
        for (uint32_t k = 0; log_ratio.count < 150; ++k) {
            Rng rng(6, 0, Stream::Test, k, 0);
            const Vec3 x = 1.6f * rng.uniform3() - 0.8f;
            if (!(test::sigma_at(media.volumes[0], x) > 0.0f)) continue;
            const double exact = inscatter_by_marching(media, lights, x);
            log_ratio.add(std::log(static_cast<double>(cells.inscatter(x)) / exact));
        }
        EXPECT_LT(std::abs(log_ratio.mean), std::log(1.25)) << count;
        EXPECT_LT(std::sqrt(log_ratio.variance()), std::log(count == 1 ? 2.0 : 1.5)) << count;
    }
}

TEST(LightCellsBuild, InscatterIsAboveZeroWhereverThereIsSmoke)
{
    Media media = test::clumpy_media();
    media.volumes[0].density_scale = 1000.0f;
    finalize(media.volumes[0]);
    const LightCells cells(media, test::random_lights(3), test_eye);
    for (uint32_t k = 0; k < 2000; ++k) {
        const float s = cells.inscatter(test::some_point(k));
        EXPECT_GT(s, 0.0f);
        EXPECT_TRUE(std::isfinite(s));
    }
}

TEST(LightCellsBuild, NearLightsAreFavoured)
{
    const std::vector<LocalLight> lights = test::random_lights(1000);
    const LightCells cells(test::clumpy_media(), lights, test_eye);
    for (uint32_t k = 0; k < 20; ++k) {
        const LocalLight& near = lights[k];
        if (glm::length(near.position) > 0.7f) continue;
        const Vec3 x = near.position + Vec3(0.02f, 0.0f, 0.01f);
        EXPECT_GT(cells.pmf(near.id, x), 0.005f);  // by power alone about 0.001
    }
}

TEST(LightCellsBuild, TheSameForAnyNumberOfThreads)
{
    const Media media = test::clumpy_media();
    const std::vector<LocalLight> lights = test::random_lights(700);
    LightCells one;
    LightCells many;
    run_with_threads(1, [&] { one = LightCells(media, lights, test_eye); });
    run_with_threads(5, [&] { many = LightCells(media, lights, test_eye); });
    ASSERT_EQ(one.entry_count(), many.entry_count());
    for (uint32_t k = 0; k < 2000; ++k) {
        const Vec3 x = test::some_point(k);
        const double u = static_cast<double>(to_unit_float(hash32(k)));
        EXPECT_EQ(one.sample(x, u).light, many.sample(x, u).light);
        EXPECT_EQ(one.sample(x, u).pmf, many.sample(x, u).pmf);
        EXPECT_EQ(one.inscatter(x), many.inscatter(x));
    }
}

TEST(LightCellsBuild, ANewEyeGivesWhatAFreshBuildGives)
{
    const Media media = test::clumpy_media();
    const std::vector<LocalLight> lights = test::random_lights(300);
    const Vec3 eye(-4.0f, 1.0f, 2.0f);
    LightCells moved(media, lights, test_eye);
    moved.set_eye(eye);
    const LightCells fresh(media, lights, eye);
    for (uint32_t k = 0; k < 300; ++k) {
        const Vec3 x = test::some_point(k);
        EXPECT_EQ(moved.inscatter(x), fresh.inscatter(x));
        EXPECT_EQ(moved.sample(x, 0.4).pmf, fresh.sample(x, 0.4).pmf);
    }
}

TEST(LightCellsBuild, SeveralVolumesOfAnyTransformAreCovered)
{
    // Two rotated, stretched volumes far apart: inscatter in both is near what one of them alone
    // would say, and cells stay few.
    Media media;
    for (const double side : {-3.0, 3.0}) {
        Volume volume = test::clumpy_cube(32);
        volume.density_scale = 2.0f;
        volume.world_from_object.keys[0].translate = Vec3d(side, 0.0, 0.0);
        volume.world_from_object.keys[0].rotate =
            glm::angleAxis(0.7, glm::normalize(Vec3d(1.0, 2.0, 0.5)));
        volume.world_from_object.keys[0].scale = Vec3d(1.0, 0.5, 1.5);
        finalize(volume);
        media.volumes.push_back(volume);
    }
    const LocalLight light{0, Vec3(0.0f, 2.0f, 0.0f), 0.0f, Vec3(0.0f), 10.0f};
    const LightCells cells(media, std::vector<LocalLight>{light}, test_eye);
    int inside = 0;
    for (uint32_t k = 0; k < 3000; ++k) {
        Rng rng(8, 0, Stream::Test, k, 0);
        const Vec3 x = (rng.uniform3() - 0.5f) * Vec3(9.0f, 2.5f, 3.5f);
        float sigma_t = 0.0f;
        for (const Volume& volume : media.volumes)
            sigma_t +=
                sample_local(*volume.density, Vec3(frames_at(volume, 0.5f).density.point(x)));
        if (!(sigma_t > 0.0f)) continue;
        ++inside;
        const Vec3 d = light.position - x;
        const float distance = glm::length(d);
        const float tau = optical_depth(media, {x, d / distance, 0.5f}, {0.0f, distance});
        const float exact = light.power * sqr(inv_4pi) / sqr(distance) * std::exp(-tau);
        EXPECT_GT(cells.inscatter(x), 0.3f * exact);
        EXPECT_LT(cells.inscatter(x), 3.0f * exact);
    }
    EXPECT_GT(inside, 100);
}

TEST(LightCellsBuild, CellsGrowToKeepToTheirBudget)
{
    LightCellsParams params;
    params.most_cells = 1000;
    params.edge_voxels = 1.0f;
    const LightCells cells(test::clumpy_media(), test::random_lights(20), test_eye, params);
    EXPECT_GT(cells.cell_count(), 100u);
    EXPECT_LE(cells.cell_count(), 1000u);
}

TEST(LightCellsBuild, AnEmissiveVolumeIsOneMoreLight)
{
    Media media = test::clumpy_media();
    Volume& volume = media.volumes[0];
    volume.emission = volume.density;
    volume.emission_params.emission_scale = 0.3f;
    finalize(volume);
    std::vector<LocalLight> lights = test::random_lights(5);
    const EmissiveBricks bricks = make_emissive_bricks(volume);
    add_emissive_volume(volume, bricks, 77, lights);
    ASSERT_EQ(lights.size(), 6u);
    EXPECT_NEAR(lights[5].power, static_cast<float>(bricks.total_power), 1e-4f * lights[5].power);
    EXPECT_LT(glm::length(lights[5].position), 0.2f);
    const LightCells cells(media, lights, test_eye);
    const Vec3 x(0.1f);
    EXPECT_GT(cells.pmf(77, x), 0.0f);
    EXPECT_NEAR(test::pmf_sum(cells, 78, x), 1.0, 1e-5);
    EXPECT_EQ(cells.pmf(50, x), 0.0f);
}

}  // namespace
}  // namespace mote
