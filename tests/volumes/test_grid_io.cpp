#include <gtest/gtest.h>

#include <cstdlib>

#include <sys/resource.h>

#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/LevelSetSphere.h>

#include "core/sanitizers.h"
#include "openvdb_grids.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "volumes/grid_io.h"
#include "volumes/make_bricks.h"
#include "volumes/procedural.h"

namespace mote {
namespace {

namespace fs = std::filesystem;
using test::bricks_of;
using test::rough_grid;
using test::velocity_grid;

TEST(GridIo, ReadsBackWhatItWrote)
{
    const TemporaryFolder folder;
    const std::string path = folder.file("smoke.vdb");
    auto doubles = openvdb::DoubleGrid::create(0.0);
    doubles->tree().setValue({1, 2, 3}, 0.25);
    doubles->setName("fine");
    auto halves = rough_grid();
    halves->setName("half");
    halves->setSaveFloatAsHalf(true);
    write_vdb(path, {rough_grid(), velocity_grid(), doubles, halves});
    const std::vector<GridInfo> infos = list_grids(path);
    ASSERT_EQ(infos.size(), 4u);
    const auto grid = read_float_grid(path, "density");
    const auto original = rough_grid();
    EXPECT_EQ(bricks_of(*grid)->values, bricks_of(*original)->values);
    EXPECT_NEAR(bricks_of(*read_float_grid(path, "half"))->sum, bricks_of(*original)->sum, 10.0);
    EXPECT_EQ(read_float_grid(path, "fine")->tree().getValue({1, 2, 3}), 0.25f);
    EXPECT_EQ(read_vec3_grid(path, "velocity")->tree().getValue({7, 7, 7})[2], -3.0f);
    for (const GridInfo& info : infos) {
        if (info.name != "density") continue;
        EXPECT_EQ(info.value_type, "float");
        EXPECT_EQ(info.grid_class, "fog volume");
        EXPECT_EQ(info.active_voxels, static_cast<int64_t>(original->activeVoxelCount()));
        EXPECT_EQ(info.bbox_hi.x, 55);
        EXPECT_GT(info.memory_bytes, 0);
    }
}

TEST(GridIo, MessagesNameFileGridAndRemedy)
{
    openvdb::initialize();  // point grids are made before anything of mote's is called
    const TemporaryFolder folder;
    const std::string path = folder.file("smoke.vdb");
    auto level_set =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, openvdb::Vec3f(0.0f), 0.1f);
    level_set->setName("surface");
    auto mask = openvdb::BoolGrid::create(false);
    mask->setName("mask");
    openvdb::points::PointDataGrid::Ptr points;
    {
        const std::vector<openvdb::Vec3f> positions{{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}};
        const auto transform = openvdb::math::Transform::createLinearTransform(0.5);
        points = openvdb::points::createPointDataGrid<openvdb::points::NullCodec,
                                                      openvdb::points::PointDataGrid>(positions,
                                                                                      *transform);
        points->setName("sparks");
    }
    write_vdb(path, {rough_grid(), velocity_grid(), level_set, mask, points});
    const auto expect_failure = [&](const std::string& grid,
                                    std::initializer_list<const char*> parts) {
        expect_error([&] { (void)read_float_grid(path, grid); }, ExitCode::Input, parts);
    };
    expect_failure("densty", {path.c_str(), "did you mean \"density\"", "\"velocity\" (vec3s)"});
    expect_failure("surface", {"level set"});
    expect_failure("mask", {"type bool"});
    expect_failure("sparks", {"[[particles]]"});
    expect_failure("velocity", {"vector grid"});
    expect_error([&] { static_cast<void>(read_vec3_grid(path, "density")); }, ExitCode::Input,
                 {"scalar grid"});
    GridBudget small;
    small.max_voxels = 100;
    expect_error([&] { static_cast<void>(read_float_grid(path, "density", small)); },
                 ExitCode::Memory, {"active voxels"});
    small = {};
    small.max_file_bytes = 1000;
    expect_error([&] { static_cast<void>(list_grids(path, small)); }, ExitCode::Memory, {"limit"});
    expect_error([&] { static_cast<void>(list_grids(folder.file("none.vdb"))); }, ExitCode::Input,
                 {"no such file"});
    expect_error([&] { static_cast<void>(list_grids(folder.file("."))); }, ExitCode::Input,
                 {"not a file"});
    std::ofstream(folder.file("text.vdb")) << "this is no grid file, whatever its name says";
    expect_error([&] { static_cast<void>(list_grids(folder.file("text.vdb"))); }, ExitCode::Input,
                 {"text.vdb"});
    expect_error([&] { write_vdb("/nonexistent/a.vdb", {rough_grid()}); }, ExitCode::Output,
                 {"/nonexistent/a.vdb"});
}

/// Damages a file in one of four ways, as `i` says.
std::string mutate(std::string bytes, uint32_t i)
{
    Rng rng(77, 0, Stream::Test, i, 0);
    const auto below = [&](size_t n) { return static_cast<size_t>(rng.next()) % n; };
    switch (i % 4) {
        case 0:
            bytes.resize(below(bytes.size()));
            break;
        case 1:
            for (int k = 0; k < 3; ++k) bytes[below(1500)] = static_cast<char>(rng.next());
            break;
        case 2: {
            const uint32_t extremes[] = {0u, 0x7fffffffu, 0x80000000u, 0xffffffffu, 0x00ffffffu};
            const uint32_t value = extremes[below(5)];
            bytes.replace(below(4000), 4, reinterpret_cast<const char*>(&value), 4);
            break;
        }
        default:
            for (int k = 0; k < 20; ++k) {
                bytes[below(bytes.size())] = static_cast<char>(rng.next());
            }
    }
    return bytes;
}

/// Reads damaged copies of a file of a scalar and a vector grid, written with this compression,
/// the scalars as half floats or not. More than `least_errors` of them must be refused.
void read_damaged_files(uint32_t compression, bool as_half, double least_errors)
{
    const TemporaryFolder folder;
    const std::string whole = folder.file("whole.vdb");
    {
        ProceduralParams params;
        params.voxel_size = 0.04f;
        auto density = make_procedural(params, 0.0);
        density->setSaveFloatAsHalf(as_half);
        openvdb::io::File file(whole);
        file.setCompression(compression);
        file.write({density, velocity_grid()});
    }
    const std::string bytes = read_bytes(whole);
    ASSERT_GT(bytes.size(), 8000u);
    GridBudget budget;
    budget.max_voxels = 50'000'000;
    budget.max_brick_bytes = 500'000'000;
    const uint32_t count = std::getenv("MOTE_LONG_TESTS") ? 400 : 55;
    uint32_t errors = 0;
    uint32_t accepted = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const std::string path = folder.file("m" + std::to_string(i) + ".vdb");
        write_bytes(path, mutate(bytes, 1000 * compression + i));
        try {
            static_cast<void>(list_grids(path, budget));
            GridLoadReport report;
            const auto bricks =
                make_bricks(*read_float_grid(path, "density", budget), budget, report);
            for (const BrickRange& range : bricks->ranges) {
                ASSERT_GE(range.min, 0.0f);
                ASSERT_LT(range.max, infinity);
            }
            static_cast<void>(
                make_color_bricks(*read_vec3_grid(path, "velocity", budget), budget, report));
            ++accepted;
        } catch (const Error& e) {
            EXPECT_TRUE(e.code() == ExitCode::Input || e.code() == ExitCode::Memory);
            ++errors;
        }
        fs::remove(path);
    }
    EXPECT_EQ(errors + accepted, count);
    EXPECT_GT(errors, least_errors * count);
    // Sanitizers keep up to four bytes of notes for each of the program's.
    constexpr long most_kilobytes = is_instrumented ? 10'000'000 : 2'500'000;
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    EXPECT_LT(usage.ru_maxrss, most_kilobytes) << "a child needed more than 2.5 GB";
    getrusage(RUSAGE_SELF, &usage);
    EXPECT_LT(usage.ru_maxrss, most_kilobytes) << "the reader needed more than 2.5 GB";
    std::printf("%u errors, %u accepted, peak %ld MB\n", errors, accepted, usage.ru_maxrss / 1000);
}

TEST(GridIoFuzz, DamagedBloscFilesGiveOneErrorOrUsableBricks)
{
    read_damaged_files(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK, false,
                       0.33);
}

TEST(GridIoFuzz, DamagedZipFilesOfHalfFloatsGiveOneErrorOrUsableBricks)
{
    read_damaged_files(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK, true, 0.33);
}

TEST(GridIoFuzz, DamagedPlainFilesGiveOneErrorOrUsableBricks)
{
    // Only the quarter that is cut short shows; other damage is mostly of voxel values.
    read_damaged_files(openvdb::io::COMPRESS_NONE, false, 0.2);
}

}  // namespace
}  // namespace mote
