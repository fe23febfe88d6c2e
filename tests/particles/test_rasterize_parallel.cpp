// That neither threads nor waves of particles show in the result.
#include <gtest/gtest.h>

#include <openvdb/openvdb.h>

#include "core/error.h"
#include "core/parallel.h"
#include "particles/clouds.h"
#include "particles/rasterize.h"
#include "particles/rasterize_plan.h"

namespace mote {
namespace {

template <class Grid>
bool same_bits(const Grid& a, const Grid& b)
{
    if (a.activeVoxelCount() != b.activeVoxelCount()) return false;
    auto other = b.getConstAccessor();
    for (auto v = a.cbeginValueOn(); v; ++v) {
        if (!other.isValueOn(v.getCoord()) || other.getValue(v.getCoord()) != *v) return false;
    }
    return true;
}

TEST(Rasterize, IsBitIdenticalForAnyThreadCount)
{
    const ParticleSet set = random_cloud(60'000, 4.0f, 0.0f, 0.15f, 5);
    RasterizeParams params = voxels_of(0.03f);
    params.channels = {true, true, true};
    params.shutter_close_s = 0.02f;
    std::vector<ParticleGrids> runs;
    for (const int threads : {1, 2, 3, 8}) {
        run_with_threads(threads, [&] { runs.push_back(rasterize(set, params)); });
    }
    for (const ParticleGrids& run : runs) {
        EXPECT_TRUE(same_bits(*run.density, *runs[0].density));
        EXPECT_TRUE(same_bits(*run.velocity, *runs[0].velocity));
        EXPECT_TRUE(same_bits(*run.temperature, *runs[0].temperature));
        EXPECT_TRUE(same_bits(*run.color, *runs[0].color));
    }
}

TEST(Rasterize, WavesAddUpToTheSameGrids)
{
    // With room for one splat each of the plan's chunks is a wave of its own. Leaves that several
    // waves touch are summed in another order: float rounding, 1e-6 of the largest value.
    const ParticleSet set = random_cloud(140'000, 4.0f, 0.0f, 0.15f, 7);
    RasterizeParams params = voxels_of(0.06f);
    params.channels = {true, true, true};
    ASSERT_EQ(make_raster_plan(set, params).wave_end.size(), 1u);
    const ParticleGrids one = rasterize(set, params);
    params.max_splats = 1;
    ASSERT_GT(make_raster_plan(set, params).wave_end.size(), 3u);
    const ParticleGrids many = rasterize(set, params);

    EXPECT_NEAR(mass_in(*many.density) / total_mass(set), 1.0, 1e-5);
    ASSERT_EQ(many.density->activeVoxelCount(), one.density->activeVoxelCount());
    EXPECT_FALSE(same_bits(*many.density, *one.density));  // the waves did overlap
    float largest = 0.0f;
    for (auto v = one.density->cbeginValueOn(); v; ++v) largest = std::max(largest, *v);
    auto density = many.density->getConstAccessor();
    for (auto v = one.density->cbeginValueOn(); v; ++v) {
        ASSERT_NEAR(density.getValue(v.getCoord()), *v, 1e-6f * largest) << v.getCoord();
    }
    auto temperature = many.temperature->getConstAccessor();
    for (auto v = one.temperature->cbeginValueOn(); v; ++v) {
        ASSERT_NEAR(temperature.getValue(v.getCoord()), *v, 1e-5f * *v) << v.getCoord();
    }
    run_with_threads(
        3, [&] { EXPECT_TRUE(same_bits(*rasterize(set, params).velocity, *many.velocity)); });
}

TEST(Rasterize, TheBudgetCountsTheLeavesOfAllWaves)
{
    // Two clusters far apart, in two waves: each fits, both do not.
    ParticleSet set = random_cloud(65'536, 1.0f, 0.1f, 0.1f, 4);
    for (size_t i = 32'768; i < set.size(); ++i) set.position[i].x += 100.0f;
    RasterizeParams params = voxels_of(0.05f);
    params.max_splats = 1;
    const auto voxels =
        static_cast<int64_t>(512 * rasterize(set, params).density->tree().leafCount());
    params.max_voxels = voxels;
    EXPECT_NO_THROW((void)rasterize(set, params));
    params.max_voxels = voxels - 1;
    EXPECT_THROW((void)rasterize(set, params), Error);
}

}  // namespace
}  // namespace mote
