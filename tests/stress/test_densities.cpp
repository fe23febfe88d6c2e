// Densities that are denormal, huge, negative or no numbers at all.
#include <gtest/gtest.h>

#include <openvdb/openvdb.h>

#include "scene/prepare.h"
#include "stress/play.h"
#include "stress/stress_scenes.h"
#include "support/expect_error.h"
#include "support/scene_files.h"
#include "volumes/grid_io.h"
#include "volumes/make_bricks.h"

namespace mote {
namespace {

/// 6^3 voxels of 0.2 m of density 1 around the origin, every third one replaced.
openvdb::FloatGrid::Ptr grid_with(float odd)
{
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.2));
    auto accessor = grid->getAccessor();
    for (int x = -3; x < 3; ++x) {
        for (int y = -3; y < 3; ++y) {
            for (int z = -3; z < 3; ++z) {
                accessor.setValue({x, y, z}, (x + y + z) % 3 == 0 ? odd : 1.0f);
            }
        }
    }
    return grid;
}

Scene scene_with(float odd, GridLoadReport& report)
{
    Volume volume;
    volume.density = make_bricks(*grid_with(odd), {}, report);
    volume.albedo = Spectrum(0.8f);
    volume.density_scale = 2.0f;
    finalize(volume);
    return test::lit_by_all(volume);
}

TEST(StressDensities, WhatIsNoDensityCountsAsNothing)
{
    GridLoadReport none;
    const Scene empty = scene_with(0.0f, none);
    EXPECT_EQ(none.non_finite + none.negative, 0);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float odd : {nan, -nan, infinity, -infinity, -1.0f, -1e-42f, -3e38f}) {
        GridLoadReport report;
        const Scene scene = scene_with(odd, report);
        EXPECT_EQ(report.non_finite + report.negative, 72) << odd;
        const auto image = [&](const Scene& of) {
            return test::play(test::repeated(of, 1), test::restir_ways()[0], "odd")[0];
        };
        EXPECT_EQ(test::mean_of(image(scene), "G"), test::mean_of(image(empty), "G")) << odd;
    }
}

TEST(StressDensities, TheSmallestAndTheLargestStaySound)
{
    for (const float odd : {1e-45f, 1e-38f, 1e10f, 5e29f}) {
        GridLoadReport report;
        const Scene scene = scene_with(odd, report);
        EXPECT_EQ(report.non_finite + report.negative, 0) << odd;
        test::expect_sound_in_every_way(scene, "density " + std::to_string(odd), 2);
    }
    GridLoadReport report;
    Scene faint = scene_with(1.0f, report);
    for (const float scale : {1e-45f, 1e-38f, 1e20f, 1e30f}) {
        faint.media.volumes[0].density_scale = scale;
        finalize(faint.media.volumes[0]);
        test::expect_sound_in_every_way(faint, "scale " + std::to_string(scale), 2);
    }
}

TEST(StressDensities, OneVoxel)
{
    for (const float size : {1e-4f, 1.0f, 1e4f}) {
        for (const float density : {1e-6f, 1.0f, 1e6f}) {
            auto grid = openvdb::FloatGrid::create(0.0f);
            grid->tree().setValue({0, 0, 0}, density / size);
            grid->setTransform(
                openvdb::math::Transform::createLinearTransform(static_cast<double>(size)));
            GridLoadReport report;
            Volume volume;
            volume.density = make_bricks(*grid, {}, report);
            finalize(volume);
            Scene scene = test::lit_by_all(volume);
            scene.camera = test::stress_camera(Vec3(0.5f, 0.4f, 3.2f) * size);
            for (const test::Way& way : test::all_ways(2, 1)) {
                const auto images = test::play(test::repeated(scene, 2), way, "one voxel");
                if (way.render.estimator == EstimatorKind::Restir) {
                    EXPECT_GT(test::mean_of(images.back(), "opticalDepth.Y"), 0.0) << size;
                }
            }
        }
    }
}

/// A scene of a grid file, prepared as the command line does it.
Scene scene_of_file(float odd, float density_scale, PrepareStats& stats)
{
    const TemporaryFolder folder;
    openvdb::initialize();
    openvdb::io::File(folder.file("odd.vdb")).write(openvdb::GridPtrVec{grid_with(odd)});
    const SceneDescription description = load_scene(
        folder.write("scene.toml",
                     "[[volumes]]\nname = \"smoke\"\nfile = "
                     "\"odd.vdb\"\ndensity_scale = " +
                         std::to_string(density_scale) + "\n[[lights]]\ntype = \"distant\"\n"),
        {});
    SceneCache cache;
    return prepare_frame(description, 1, {}, cache, stats);
}

TEST(StressDensities, FilesOfNonsenseAreCountedAndShownWithoutIt)
{
    for (const float odd : {std::numeric_limits<float>::quiet_NaN(), infinity, -1.0f}) {
        PrepareStats stats;
        testing::internal::CaptureStdout();  // where spdlog's default logger writes
        const Scene scene = scene_of_file(odd, 2.0f, stats);
        const std::string log = testing::internal::GetCapturedStdout();
        EXPECT_EQ(stats.non_finite_values + stats.negative_values, 72) << odd;
        EXPECT_EQ(scene.media.volumes[0].density->max_value, 1.0f) << odd;
        EXPECT_NE(log.find("count as 0"), std::string::npos) << log;
        EXPECT_NE(log.find("\"density\""), std::string::npos) << log;
    }
}

TEST(StressDensities, ExtinctionsThatWouldOverflowAreRefused)
{
    PrepareStats stats;
    expect_error([&] { (void)scene_of_file(3e38f, 1.0f, stats); }, ExitCode::Input,
                 {"smoke", "3e+38", "density_scale"});
    expect_error([&] { (void)scene_of_file(1e15f, 1e19f, stats); }, ExitCode::Input,
                 {"smoke", "density_scale"});
    EXPECT_EQ(scene_of_file(1e15f, 1e14f, stats).media.volumes.size(), 1u);
}

}  // namespace
}  // namespace mote
