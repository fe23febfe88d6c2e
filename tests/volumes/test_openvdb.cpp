// Everything that needs OpenVDB's headers, in one file: they cost half a minute to compile.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetSphere.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/rng.h"
#include "core/stats.h"
#include "volumes/grid_io.h"
#include "volumes/make_bricks.h"
#include "volumes/procedural.h"
#include "volumes/tracking.h"

namespace mote {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, removed at the end.
class TemporaryFolder {
  public:
    TemporaryFolder()
        : path_(fs::temp_directory_path() / ("mote_volumes_" + std::to_string(getpid())))
    {
        fs::create_directories(path_);
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] std::string file(const std::string& name) const
    {
        return (path_ / name).string();
    }

  private:
    fs::path path_;
};

std::string message_of(const std::function<void()>& f, ExitCode expected)
{
    try {
        f();
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), expected) << e.what();
        EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
        return e.what();
    }
    ADD_FAILURE() << "no error";
    return "";
}

#define EXPECT_MESSAGE(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

/// Sparse values on both sides of the origin, with a tile, under a rotated and sheared transform.
openvdb::FloatGrid::Ptr rough_grid()
{
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0.0f);
    Rng rng(4, 0, Stream::Test, 0, 0);
    auto accessor = grid->getAccessor();
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 p = rng.uniform3() * 60.0f - Vec3(30.0f);
        accessor.setValue({static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
                           static_cast<int>(std::floor(p.z))},
                          rng.uniform());
    }
    grid->tree().addTile(1, {40, 8, -16}, 0.7f, true);  // an 8^3 block of one value
    grid->tree().addTile(1, {48, 8, -16}, 0.7f, true);
    grid->tree().addTile(1, {-64, -64, -64}, 5.0f, false);  // inactive: counts as 0
    const openvdb::Mat4d m(0.05, 0.01, 0.0, 0.0, -0.012, 0.04, 0.0, 0.0, 0.003, 0.0, 0.09, 0.0, 3.0,
                           -1.0, 2.0, 1.0);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(m));
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

std::shared_ptr<const BrickGrid> bricks_of(const openvdb::FloatGrid& grid)
{
    GridLoadReport report;
    return make_bricks(grid, {}, report);
}

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
    EXPECT_MESSAGE(
        message_of([&] { static_cast<void>(make_bricks(*grid, {}, report)); }, ExitCode::Memory),
        "huge");
    auto far = openvdb::FloatGrid::create(0.0f);
    far->tree().setValue({0, 0, 0}, 1.0f);
    far->tree().setValue({1 << 27, 1 << 27, 1 << 27}, 1.0f);  // a table of 5e21 entries
    EXPECT_MESSAGE(
        message_of([&] { static_cast<void>(make_bricks(*far, {}, report)); }, ExitCode::Memory),
        "limit");
    auto beyond = openvdb::FloatGrid::create(0.0f);
    beyond->tree().setValue({std::numeric_limits<int>::min(), 0, 0}, 1.0f);
    EXPECT_MESSAGE(
        message_of([&] { static_cast<void>(make_bricks(*beyond, {}, report)); }, ExitCode::Input),
        "2^30");
}

TEST(MakeBricks, RefusesLevelSetsAndFrustumTransforms)
{
    GridLoadReport report;
    const auto sphere =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, openvdb::Vec3f(0.0f), 0.1f);
    EXPECT_MESSAGE(
        message_of([&] { static_cast<void>(make_bricks(*sphere, {}, report)); }, ExitCode::Input),
        "level set");
    auto grid = rough_grid();
    grid->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0.0), openvdb::Vec3d(10.0)), 0.5, 1.0, 0.1));
    EXPECT_MESSAGE(
        message_of([&] { static_cast<void>(make_bricks(*grid, {}, report)); }, ExitCode::Input),
        "frustum");
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
    EXPECT_MESSAGE(
        message_of([&] { static_cast<void>(make_procedural(params, 0.0)); }, ExitCode::Memory),
        "voxel_size");
    params.voxel_size = -1.0f;
    EXPECT_MESSAGE(
        message_of([&] { static_cast<void>(make_procedural(params, 0.0)); }, ExitCode::Input),
        "voxel_size");
}

openvdb::Vec3SGrid::Ptr velocity_grid()
{
    auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
    for (int i = 0; i < 512; ++i) {
        grid->tree().setValue({i / 64, i / 8 % 8, i % 8}, openvdb::Vec3s(1.0f, 2.0f, -3.0f));
    }
    grid->setName("velocity");
    return grid;
}

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
    const auto failing = [&](const std::string& grid, ExitCode code = ExitCode::Input) {
        return message_of([&] { static_cast<void>(read_float_grid(path, grid)); }, code);
    };
    const std::string missing = failing("densty");
    EXPECT_MESSAGE(missing, path);
    EXPECT_MESSAGE(missing, "did you mean \"density\"");
    EXPECT_MESSAGE(missing, "\"velocity\" (vec3s)");
    EXPECT_MESSAGE(failing("surface"), "level set");
    EXPECT_MESSAGE(failing("mask"), "type bool");
    EXPECT_MESSAGE(failing("sparks"), "[[particles]]");
    EXPECT_MESSAGE(failing("velocity"), "vector grid");
    EXPECT_MESSAGE(
        message_of([&] { static_cast<void>(read_vec3_grid(path, "density")); }, ExitCode::Input),
        "scalar grid");
    GridBudget small;
    small.max_voxels = 100;
    EXPECT_MESSAGE(message_of([&] { static_cast<void>(read_float_grid(path, "density", small)); },
                              ExitCode::Memory),
                   "active voxels");
    small = {};
    small.max_file_bytes = 1000;
    EXPECT_MESSAGE(
        message_of([&] { static_cast<void>(list_grids(path, small)); }, ExitCode::Memory), "limit");
    EXPECT_MESSAGE(message_of([&] { static_cast<void>(list_grids(folder.file("none.vdb"))); },
                              ExitCode::Input),
                   "no such file");
    EXPECT_MESSAGE(
        message_of([&] { static_cast<void>(list_grids(folder.file("."))); }, ExitCode::Input),
        "not a file");
    std::ofstream(folder.file("text.vdb")) << "this is no grid file, whatever its name says";
    EXPECT_MESSAGE(message_of([&] { static_cast<void>(list_grids(folder.file("text.vdb"))); },
                              ExitCode::Input),
                   "text.vdb");
    EXPECT_MESSAGE(
        message_of([&] { write_vdb("/nonexistent/a.vdb", {rough_grid()}); }, ExitCode::Output),
        "/nonexistent/a.vdb");
}

std::string bytes_of(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
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

TEST(GridIoFuzz, DamagedFilesGiveOneErrorOrUsableBricks)
{
    const TemporaryFolder folder;
    const uint32_t per_file = std::getenv("MOTE_LONG_TESTS") ? 400 : 55;
    GridBudget budget;
    budget.max_voxels = 50'000'000;
    budget.max_brick_bytes = 500'000'000;
    int errors = 0;
    int accepted = 0;
    const uint32_t encodings[] = {openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK,
                                  openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK,
                                  openvdb::io::COMPRESS_NONE};
    for (uint32_t kind = 0; kind < 3; ++kind) {
        ProceduralParams params;
        params.voxel_size = 0.04f;
        auto density = make_procedural(params, 0.0);
        density->setSaveFloatAsHalf(kind == 1);
        const std::string whole = folder.file("whole.vdb");
        {
            openvdb::io::File file(whole);
            file.setCompression(encodings[kind]);
            file.write({density, velocity_grid()});
        }
        const std::string bytes = bytes_of(whole);
        ASSERT_GT(bytes.size(), 8000u);
        for (uint32_t i = 0; i < per_file; ++i) {
            const std::string path = folder.file("m" + std::to_string(kind * 1000 + i) + ".vdb");
            std::ofstream(path, std::ios::binary) << mutate(bytes, kind * per_file + i);
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
    }
    EXPECT_EQ(errors + accepted, static_cast<int>(3 * per_file));
    EXPECT_GT(errors, accepted / 2);
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    RecordProperty("child_peak_kilobytes", static_cast<int>(usage.ru_maxrss));
    EXPECT_LT(usage.ru_maxrss, 2'500'000) << "a child needed more than 2.5 GB";
    getrusage(RUSAGE_SELF, &usage);
    RecordProperty("peak_kilobytes", static_cast<int>(usage.ru_maxrss));
    EXPECT_LT(usage.ru_maxrss, 2'500'000) << "the reader needed more than 2.5 GB";
    std::printf("%d errors, %d accepted, peak %ld MB\n", errors, accepted, usage.ru_maxrss / 1000);
}

}  // namespace
}  // namespace mote
