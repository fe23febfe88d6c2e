#include <map>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>

#include "particles/cache.h"
#include "particles/cache_samples.h"
#include "particles/emitter.h"
#include "particles/write_points.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

using openvdb::points::PointDataGrid;

// Positions are stored relative to their voxel and come back within rounding of the sum; all else
// is stored as it is.
TEST(CacheVdb, AnEmitterSurvivesTheRoundTrip)
{
    const TemporaryFolder folder;
    EmitterParams params;
    params.count = 20'000;
    params.cooling = 1.0f;
    params.temperature = 1500.0f;
    const ParticleSet before = emit_particles(params, 6.0);
    const std::string path = folder.file("plume.vdb");
    write_points(path, before);
    const ParticleSet after = read_particle_file(path, {}, 24.0);
    ASSERT_EQ(after.size(), before.size());
    std::map<int64_t, size_t> index;
    for (size_t i = 0; i < after.size(); ++i) index[after.id[i]] = i;
    ASSERT_EQ(index.size(), before.size());
    for (size_t i = 0; i < before.size(); ++i) {
        const size_t j = index.at(before.id[i]);
        EXPECT_LT(glm::length(before.position[i] - after.position[j]), 5e-7f);
        EXPECT_EQ(before.velocity[i], after.velocity[j]);
        EXPECT_EQ(before.radius[i], after.radius[j]);
        EXPECT_EQ(before.mass[i], after.mass[j]);
        EXPECT_EQ(before.temperature[i], after.temperature[j]);
        EXPECT_EQ(before.color[i], after.color[j]);
        EXPECT_EQ(before.age[i], after.age[j]);
    }
}

TEST(CacheVdb, SmallSetsAndMissingAttributes)
{
    const TemporaryFolder folder;
    const std::string path = folder.file("a.vdb");
    write_points(path, sample_particles());
    const ParticleSet set = read_particle_file(path, {}, 24.0);
    EXPECT_EQ(set.size(), 3u);
    EXPECT_EQ(std::count(set.id.begin(), set.id.end(), 5'000'000'000), 1);
    ParticleSet bare;
    bare.position = {Vec3(1.0f, 2.0f, 3.0f), Vec3(1.0f, 2.0f, 3.0f)};
    write_points(path, bare);
    const ParticleSet again = read_particle_file(path, {}, 24.0);
    EXPECT_EQ(again.position, bare.position);
    EXPECT_TRUE(again.velocity.empty());
    EXPECT_EQ(again.mass[0], 0.5f);
    write_points(path, {});
    EXPECT_EQ(read_particle_file(path, {}, 24.0).size(), 0u);
    EXPECT_EQ(error_message([&] { write_points(folder.file("no/a.vdb"), bare); }, ExitCode::Output)
                  .substr(0, folder.path().size()),
              folder.path());
}

/// Points of attributes in compressed codecs, as other tools write them.
PointDataGrid::Ptr coded_grid(const char* name, double voxel_size)
{
    const std::vector<openvdb::Vec3s> positions = {{0.1f, 0.2f, 0.3f}, {5.0f, 5.0f, 5.0f}};
    const openvdb::points::PointAttributeVector<openvdb::Vec3s> wrapper(positions);
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel_size);
    const auto index =
        openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(wrapper, *transform);
    auto grid = openvdb::points::createPointDataGrid<openvdb::points::FixedPointCodec<false>,
                                                     PointDataGrid>(*index, wrapper, *transform);
    grid->setName(name);
    const auto add = [&](auto codec, const char* attribute, const auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        openvdb::points::appendAttribute<Value, decltype(codec)>(grid->tree(), attribute);
        const openvdb::points::PointAttributeVector<Value> list(values);
        openvdb::points::populateAttribute(grid->tree(), index->tree(), attribute, list);
    };
    using openvdb::points::FixedPointCodec;
    using openvdb::points::TruncateCodec;
    using openvdb::points::UnitRange;
    add(TruncateCodec(), "pscale", std::vector<float>{0.5f, 0.25f});
    add(FixedPointCodec<false, UnitRange>(), "density", std::vector<float>{1.0f, 0.5f});
    add(TruncateCodec(), "v", std::vector<openvdb::Vec3s>{{1.0f, 2.0f, 3.0f}, {0.0f, 0.0f, 1.0f}});
    add(openvdb::points::NullCodec(), "id", std::vector<int32_t>{4, 9});
    add(openvdb::points::NullCodec(), "temperature", std::vector<double>{300.0, 900.0});
    return grid;
}

TEST(CacheVdb, CompressedCodecsAndSeveralGrids)
{
    openvdb::initialize();
    const TemporaryFolder folder;
    const std::string path = folder.file("coded.vdb");
    auto fog = openvdb::FloatGrid::create();
    fog->setName("density");
    openvdb::io::File(path).write({coded_grid("one", 0.5), fog, coded_grid("two", 2.0)});
    const ParticleSet set = read_particle_file(path, {}, 24.0);
    ASSERT_EQ(set.size(), 4u);
    for (size_t i = 0; i < set.size(); ++i) {
        const bool is_first = set.id[i] == 4;
        const Vec3 expected = is_first ? Vec3(0.1f, 0.2f, 0.3f) : Vec3(5.0f);
        // 16-bit offsets: half a step of 2^-16 voxels, voxels of 2 m: 2e-5 m.
        EXPECT_LT(glm::length(set.position[i] - expected), 4e-5f);
        EXPECT_EQ(set.radius[i], is_first ? 0.5f : 0.25f);
        EXPECT_EQ(set.velocity[i], is_first ? Vec3(1.0f, 2.0f, 3.0f) : Vec3(0.0f, 0.0f, 1.0f));
        EXPECT_EQ(set.temperature[i], is_first ? 300.0f : 900.0f);
        const float r = set.radius[i];
        const float ball = 4.0f / 3.0f * pi * r * r * r;
        EXPECT_NEAR(set.mass[i] / ball, is_first ? 1.0f : 0.5f, 2e-5f);
    }
}

TEST(CacheVdb, EveryErrorNamesTheFile)
{
    openvdb::initialize();
    const TemporaryFolder folder;
    const std::string path = folder.file("a.vdb");
    const auto message = [&](const CacheParams& params, ExitCode code = ExitCode::Input) {
        return error_message([&] { (void)read_particle_file(path, params, 24.0); }, code);
    };
    auto fog = openvdb::FloatGrid::create();
    fog->setName("density");
    openvdb::io::File(path).write({fog});
    EXPECT_EQ(message({}), path +
                               ": no points; the file holds \"density\" (float). Fog volumes "
                               "belong into a [[volumes]] entry");
    write_points(path, sample_particles());
    CacheParams params;
    params.attributes = {{"mass", "weight"}};
    EXPECT_EQ(message(params),
              path +
                  ": no attribute \"weight\" of one number to read as mass; the file has Cd (3 "
                  "numbers), P (3 numbers), age, id, mass, pscale, temperature, v (3 numbers)");
    params = {};
    params.max_particles = 2.0f;
    EXPECT_TRUE(message(params, ExitCode::Memory).starts_with(path + ": more than 2 particles in"));
    folder.write("a.vdb", "this is no vdb file at all, whatever its name may say");
    const std::string no_vdb = message({});
    EXPECT_TRUE(no_vdb.starts_with(path + ": damaged or of another format")) << no_vdb;
    EXPECT_TRUE(no_vdb.ends_with("copy or write it again")) << no_vdb;
}

}  // namespace
}  // namespace mote
