// OpenVDB grids to bricks and back to OpenVDB's and NanoVDB's samplers.
#include <gtest/gtest.h>

#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetSphere.h>

#include "core/parallel.h"
#include "core/stats.h"
#include "openvdb_grids.h"
#include "support/expect_error.h"
#include "volumes/make_bricks.h"
#include "volumes/procedural.h"
#include "volumes/tracking.h"

namespace mote {
namespace {

using test::bricks_of;
using test::rough_grid;

TEST(MakeBricks, ReconstructionIsThatOfTheOpenVdbAndNanoVdbSamplers)
{
    const auto grid = rough_grid();
    const auto bricks = bricks_of(*grid);
    auto clean = grid->deepCopy();  // the oracles see the inactive tile's value, mote does not
    clean->tree().addTile(1, {-64, -64, -64}, 0.0f, false);
    const auto handle = nanovdb::openToNanoVDB(*clean);
    const auto* nano = handle.grid<float>();
    const auto accessor = nano->getAccessor();
    auto nano_sampler = nanovdb::createSampler<1>(accessor);
    Rng rng(9, 0, Stream::Test, 0, 0);
    int inside = 0;
    for (int i = 0; i < 50'000; ++i) {
        const Vec3 p = rng.uniform3() * Vec3(110.0f, 80.0f, 80.0f) - Vec3(40.0f);
        const openvdb::Vec3d index(p.x, p.y, p.z);
        const openvdb::Vec3d object = grid->indexToWorld(index);
        const Vec3 p_object(Vec3d(object.x(), object.y(), object.z()));
        const float expected = openvdb::tools::BoxSampler::sample(clean->tree(), index);
        const float by_nano = nano_sampler(nanovdb::Vec3<float>(p.x, p.y, p.z));
        EXPECT_NEAR(by_nano, expected, 1e-5f);
        // Floats place the point within 2e-5 voxels; values change by up to 2 per voxel.
        EXPECT_NEAR(sample_trilinear(*bricks, bricks->index_from_object.point(p_object)), expected,
                    1e-4f);
        EXPECT_NEAR(sample_trilinear(*bricks, p), expected, 2e-6f);
        inside += expected > 0.0f ? 1 : 0;
    }
    EXPECT_GT(inside, 5'000);
}

TEST(MakeBricks, BuildsTheSameBitsForAnyThreadCount)
{
    ProceduralParams params;
    params.kind = ProceduralKind::Plume;
    params.voxel_size = 0.02f;
    params.size = {1.0f, 1.5f, 1.0f};
    std::shared_ptr<const BrickGrid> first;
    for (const int threads : {1, 2, 3, 8}) {
        run_with_threads(threads, [&] {
            GridLoadReport report;
            const auto bricks = make_bricks(*make_procedural(params, 1.5), {}, report);
            if (!first) first = bricks;
            EXPECT_EQ(bricks->values, first->values);
            EXPECT_EQ(bricks->table, first->table);
            EXPECT_EQ(bricks->sum, first->sum);
        });
    }
}

TEST(MakeBricks, SanitisesOnceAndReports)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    auto grid = openvdb::FloatGrid::create(0.0f);
    auto accessor = grid->getAccessor();
    const float values[] = {1.0f, nan, -2.0f, infinity, -infinity, 3.0f, -0.0f, 1e-42f};
    for (int i = 0; i < 8; ++i) accessor.setValue({i, 0, 0}, values[i]);
    GridLoadReport report;
    const auto bricks = make_bricks(*grid, {}, report);
    EXPECT_EQ(report.non_finite, 3);
    EXPECT_EQ(report.negative, 1);
    EXPECT_DOUBLE_EQ(bricks->sum, 4.0 + static_cast<double>(1e-42f));
    EXPECT_EQ(bricks->max_value, 3.0f);
    EXPECT_EQ(sample_trilinear(*bricks, {1.0f, 0.0f, 0.0f}), 0.0f);
    EXPECT_EQ(sample_trilinear(*bricks, {5.0f, 0.0f, 0.0f}), 3.0f);
}

TEST(MakeBricks, TilesCostTableEntriesAndBudgetsHoldBeforeAllocation)
{
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("huge");
    grid->tree().addTile(2, {0, 0, 0}, 1.5f, true);  // 128^3 voxels of one value
    GridLoadReport report;
    const auto bricks = make_bricks(*grid, {}, report);
    EXPECT_LT(bricks->memory_bytes(), 6'000'000u);  // 17^3 positions, the faces stored
    EXPECT_DOUBLE_EQ(bricks->sum, 1.5 * 128 * 128 * 128);
    EXPECT_EQ(sample_trilinear(*bricks, Vec3(64.2f)), 1.5f);

    grid->tree().addTile(3, {4096, 0, 0}, 1.0f, true);  // 7e10 voxels
    expect_error([&] { static_cast<void>(make_bricks(*grid, {}, report)); }, ExitCode::Memory,
                 {"huge"});
    auto far = openvdb::FloatGrid::create(0.0f);
    far->tree().setValue({0, 0, 0}, 1.0f);
    far->tree().setValue({1 << 27, 1 << 27, 1 << 27}, 1.0f);  // a table of 5e21 entries
    expect_error([&] { static_cast<void>(make_bricks(*far, {}, report)); }, ExitCode::Memory,
                 {"limit"});
    auto beyond = openvdb::FloatGrid::create(0.0f);
    beyond->tree().setValue({std::numeric_limits<int>::min(), 0, 0}, 1.0f);
    expect_error([&] { static_cast<void>(make_bricks(*beyond, {}, report)); }, ExitCode::Input,
                 {"2^30"});
}

TEST(MakeBricks, RefusesLevelSetsAndFrustumTransforms)
{
    GridLoadReport report;
    const auto sphere =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, openvdb::Vec3f(0.0f), 0.1f);
    expect_error([&] { static_cast<void>(make_bricks(*sphere, {}, report)); }, ExitCode::Input,
                 {"level set"});
    auto grid = rough_grid();
    grid->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0.0), openvdb::Vec3d(10.0)), 0.5, 1.0, 0.1));
    expect_error([&] { static_cast<void>(make_bricks(*grid, {}, report)); }, ExitCode::Input,
                 {"frustum"});
}

TEST(MakeBricks, EmptyGridsAreEmptyVolumes)
{
    auto grid = openvdb::FloatGrid::create(0.0f);
    const auto bricks = bricks_of(*grid);
    EXPECT_EQ(bricks->active_bricks(), 0u);
    EXPECT_EQ(sample_trilinear(*bricks, Vec3(0.0f)), 0.0f);
    grid->tree().setValue({3, 3, 3}, 0.0f);
    EXPECT_TRUE(bricks_of(*grid)->index_bounds.is_empty());
}

TEST(MakeColorBricks, KeepsColoursToTheEdgeOfTheCloud)
{
    auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
    for (int i = 0; i < 1000; ++i) {
        grid->tree().setValue({i / 100, i / 10 % 10, i % 10}, openvdb::Vec3s(0.8f, -2.0f, 0.1f));
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    grid->tree().setValue({30, 30, 30}, openvdb::Vec3s(nan, 1.0f, nan));
    GridLoadReport report;
    const auto color = make_color_bricks(*grid, {}, report);
    EXPECT_EQ(report.non_finite, 2);
    // Wherever the density's reconstruction may be non-zero, one voxel around the cloud.
    for (int i = 0; i < 1000; ++i) {
        Rng rng(1, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        const Vec3 p = rng.uniform3() * 11.0f - Vec3(1.0f);
        const Vec3 c = sample_color(*color, p);
        EXPECT_NEAR(c.x, 0.8f, 1e-5f);
        EXPECT_NEAR(c.y, -2.0f, 1e-5f);
        EXPECT_NEAR(c.z, 0.1f, 1e-5f);
    }
    EXPECT_EQ(sample_color(*color, Vec3(20.0f)), Vec3(0.0f));
    EXPECT_EQ(color->channel[0].table, color->channel[2].table);
}

TEST(MakeProcedural, BoxHasItsExactOpticalDepthAndSphereItsVolume)
{
    ProceduralParams params;
    params.kind = ProceduralKind::Box;
    params.size = {1.03f, 0.5f, 0.77f};  // not a whole number of voxels
    params.voxel_size = 0.05f;
    Volume volume;
    volume.density = bricks_of(*make_procedural(params, 0.0));
    volume.density_scale = 2.0f;
    finalize(volume);
    for (int axis = 0; axis < 3; ++axis) {
        Ray ray{Vec3(0.011f), Vec3(0.0f)};
        ray.o[axis] = -4.0f;
        ray.d[axis] = 1.0f;
        EXPECT_NEAR(optical_depth(volume, ray, {0.0f, infinity}), 2.0f * params.size[axis], 1e-5f);
    }
    params.kind = ProceduralKind::Sphere;
    params.size = Vec3(1.0f);
    params.voxel_size = 0.02f;
    const double voxel_volume = std::pow(static_cast<double>(params.voxel_size), 3);
    EXPECT_NEAR(bricks_of(*make_procedural(params, 0.0))->sum * voxel_volume, 3.14159265 / 6.0,
                1e-3);
    params.voxel_size = 1e-6f;
    expect_error([&] { static_cast<void>(make_procedural(params, 0.0)); }, ExitCode::Memory,
                 {"voxel_size"});
    params.voxel_size = -1.0f;
    expect_error([&] { static_cast<void>(make_procedural(params, 0.0)); }, ExitCode::Input,
                 {"voxel_size"});
}

}  // namespace
}  // namespace mote
