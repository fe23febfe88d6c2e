#include <gtest/gtest.h>

#include <openvdb/openvdb.h>

#include "scene/prepare.h"
#include "support/scene_files.h"
#include "volumes/grid_io.h"

namespace mote {
namespace {

/// A cube of 10 voxels of 0.1 m; `value` everywhere.
template <class Grid>
typename Grid::Ptr make_cube(const std::string& name, const typename Grid::ValueType& value)
{
    auto grid = Grid::create();
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
    grid->fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(9)), value);
    return grid;
}

/// Scene with one volume from files in its own folder.
struct FileScene {
    explicit FileScene(const std::string& volume_keys)
        : scene_path(folder.write("scene.toml", "[[volumes]]\nname = \"v\"\n" + volume_keys +
                                                    "\n[[lights]]\ntype = \"environment\"\n"))
    {
        openvdb::initialize();
    }
    void write(const std::string& name, const openvdb::GridPtrVec& grids) const
    {
        write_vdb(folder.file(name), grids);
    }
    [[nodiscard]] Scene prepare(int frame, const PrepareNeeds& needs = {})
    {
        return prepare_frame(load_scene(scene_path), frame, needs, cache, stats);
    }
    [[nodiscard]] std::string error(const PrepareNeeds& needs = {})
    {
        try {
            (void)prepare(1, needs);
        } catch (const Error& e) {
            return e.what();
        }
        return "no error";
    }

    TemporaryFolder folder;
    std::string scene_path;
    SceneCache cache;
    PrepareStats stats;
};

TEST(PrepareFiles, SequencesFollowTheFrameAndAreKeptWhileTheyDoNotChange)
{
    FileScene scene("file = { path = \"s.##.vdb\", offset = 10, outside = \"hold\" }");
    scene.write("s.11.vdb", {make_cube<openvdb::FloatGrid>("density", 1.0f)});
    scene.write("s.12.vdb", {make_cube<openvdb::FloatGrid>("density", 2.0f)});
    const Scene first = scene.prepare(1);
    EXPECT_EQ(first.media.volumes[0].density->max_value, 1.0f);
    EXPECT_EQ(scene.prepare(2).media.volumes[0].density->max_value, 2.0f);
    EXPECT_EQ(scene.stats.grids_built, 2);
    const Scene held = scene.prepare(99);  // shows the last file again
    EXPECT_EQ(held.media.volumes[0].density->max_value, 2.0f);
    EXPECT_EQ(scene.stats.grids_built, 2);
    EXPECT_EQ(scene.stats.grids_reused, 1);
}

TEST(PrepareFiles, ReadOnlyTheGridsThatAreUsed)
{
    const std::string plain = "file = \"a.vdb\"\n";
    const openvdb::GridPtrVec grids{
        make_cube<openvdb::FloatGrid>("density", 1.0f),
        make_cube<openvdb::FloatGrid>("temperature", 2.0f),
        make_cube<openvdb::Vec3SGrid>("velocity", openvdb::Vec3s(1.0f, 0.0f, 0.0f))};
    FileScene unlit(plain);
    unlit.write("a.vdb", grids);
    const Scene scene = unlit.prepare(1);
    EXPECT_EQ(unlit.stats.grids_built, 1);
    EXPECT_EQ(scene.media.volumes[0].temperature, nullptr);

    FileScene lit(plain + "emission = { blackbody_scale = 1, temperature_scale = 800 }");
    lit.write("a.vdb", grids);
    const Scene shown = lit.prepare(1, PrepareNeeds{true});
    EXPECT_EQ(lit.stats.grids_built, 3);
    EXPECT_EQ(shown.media.volumes[0].temperature->max_value, 2.0f);
    ASSERT_NE(shown.media.volumes[0].velocity, nullptr);
    EXPECT_EQ(shown.media.volumes[0].velocity->channel[0].max_value, 1.0f);
}

TEST(PrepareFiles, MissingGridsNameFileAndGridAndWhatThereIs)
{
    const openvdb::GridPtrVec grids{make_cube<openvdb::FloatGrid>("density", 1.0f),
                                    make_cube<openvdb::FloatGrid>("heat", 2.0f)};
    FileScene fire("file = \"a.vdb\"\nemission = { blackbody_scale = 1 }");
    fire.write("a.vdb", grids);
    const std::string message = fire.error();
    EXPECT_NE(message.find("a.vdb"), std::string::npos) << message;
    EXPECT_NE(message.find("\"temperature\""), std::string::npos) << message;
    EXPECT_NE(message.find("heat"), std::string::npos) << message;

    FileScene plain("file = \"a.vdb\"");
    plain.write("a.vdb", grids);
    const std::string still = plain.error(PrepareNeeds{true});
    EXPECT_NE(still.find("\"velocity\""), std::string::npos) << still;
    EXPECT_NE(still.find("set that to \"\" for a volume at rest"), std::string::npos) << still;
    EXPECT_EQ(plain.prepare(1, PrepareNeeds{true, true}).media.volumes[0].velocity, nullptr);

    FileScene swapped("file = \"a.vdb\"\ndensity_grid = \"v\"");
    swapped.write("a.vdb", {make_cube<openvdb::Vec3SGrid>("v", openvdb::Vec3s(1.0f))});
    EXPECT_NE(swapped.error().find("one number per voxel"), std::string::npos) << swapped.error();
}

TEST(PrepareFiles, BadValuesAreCountedOnce)
{
    FileScene scene("file = \"a.vdb\"");
    auto grid = make_cube<openvdb::FloatGrid>("density", 1.0f);
    grid->tree().setValue(openvdb::Coord(1), -1.0f);
    grid->tree().setValue(openvdb::Coord(2), std::numeric_limits<float>::quiet_NaN());
    scene.write("a.vdb", {grid});
    (void)scene.prepare(1);
    (void)scene.prepare(2);
    EXPECT_EQ(scene.stats.negative_values, 1);
    EXPECT_EQ(scene.stats.non_finite_values, 1);
}

}  // namespace
}  // namespace mote
