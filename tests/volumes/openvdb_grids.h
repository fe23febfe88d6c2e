#pragma once

#include <openvdb/openvdb.h>

#include "core/math.h"
#include "core/rng.h"
#include "volumes/make_bricks.h"

namespace mote::test {

/// Sparse values on both sides of the origin, with a tile, under a rotated and sheared transform.
inline openvdb::FloatGrid::Ptr rough_grid()
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

inline openvdb::Vec3SGrid::Ptr velocity_grid()
{
    auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
    for (int i = 0; i < 512; ++i) {
        grid->tree().setValue({i / 64, i / 8 % 8, i % 8}, openvdb::Vec3s(1.0f, 2.0f, -3.0f));
    }
    grid->setName("velocity");
    return grid;
}

inline std::shared_ptr<const BrickGrid> bricks_of(const openvdb::FloatGrid& grid)
{
    GridLoadReport report;
    return make_bricks(grid, {}, report);
}

}  // namespace mote::test
