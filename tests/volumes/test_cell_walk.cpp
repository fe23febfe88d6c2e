#include <gtest/gtest.h>

#include "volumes.h"
#include "volumes/cell_walk.h"

namespace mote {
namespace {

/// The cells of one span: their number. They tile it without gap or overlap and carry the density.
int check_cells(const BrickGrid& grid, const LocalRay& ray, const BrickSpan& span)
{
    int count = 0;
    float s = span.s0;
    float v = sample_in_brick(grid, span, ray.at(s));
    for_each_cell(grid, ray, span, [&](const CellSpan& cell) {
        EXPECT_EQ(cell.s0, s);
        EXPECT_GE(cell.s1, cell.s0);
        // Positions are products of up to 100 voxels, rounded to 4e-6, here and there, on three
        // axes; densities change by up to 0.75 per voxel.
        EXPECT_NEAR(cell.v0, v, 3e-5f);
        const float middle = 0.5f * (cell.s0 + cell.s1);
        EXPECT_NEAR(cell.vm, sample_in_brick(grid, span, ray.at(middle)), 3e-5f);
        EXPECT_NEAR(cell.v1, sample_in_brick(grid, span, ray.at(cell.s1)), 3e-5f);
        s = cell.s1;
        v = cell.v1;
        ++count;
        return true;
    });
    EXPECT_EQ(s, span.s1);
    EXPECT_LE(count, 22);
    return count;
}

TEST(CellWalk, CellsTileTheSpanAndCarryTheDensity)
{
    const Volume volume = test::volume_of(test::bumpy_bricks(), 1.0f, test::tilted());
    const BrickGrid& grid = *volume.density;
    int cells = 0;
    for (uint32_t i = 0; i < 300; ++i) {
        Ray ray = test::test_ray(world_bounds(volume), i);
        if (i % 4 == 0) ray.d[static_cast<int>(i / 4 % 3)] = 0.0f;
        const LocalRay local = density_ray(volume, ray, test::everything);
        for_each_brick(grid, local, [&](const BrickSpan& span) {
            cells += check_cells(grid, local, span);
            return true;
        });
    }
    EXPECT_GT(cells, 5000);
}

TEST(CellWalk, ARayAlongTheBricksBorderIsNotLostToRounding)
{
    // It is inside by half a rounding step, or outside, and would leave before it came in.
    const BrickGrid& grid = *test::bumpy_bricks();
    const int brick = grid.table[grid.table_index(2, 2, 2)];
    ASSERT_GT(brick, 0);
    for (const float side : {16.0f, 24.0f}) {
        for (const float slope : {0.0f, 1e-9f, -1e-9f, 1e-35f}) {
            const LocalRay ray{{side, 17.3f, 16.0f}, {slope, 0.4f, 1.0f}, 8.0f, 0.0};
            const BrickSpan span{0.0f, 8.0f, brick, Vec3(16.0f)};
            EXPECT_GE(check_cells(grid, ray, span), 8);
        }
    }
}

TEST(CellWalk, StopsWhenAsked)
{
    const BrickGrid& grid = *test::bumpy_bricks();
    const LocalRay ray{{16.5f, 17.3f, 16.0f}, {0.1f, 0.4f, 1.0f}, 8.0f, 0.0};
    const BrickSpan span{0.0f, 8.0f, grid.table[grid.table_index(2, 2, 2)], Vec3(16.0f)};
    int count = 0;
    EXPECT_FALSE(for_each_cell(grid, ray, span, [&](const CellSpan&) { return ++count < 3; }));
    EXPECT_EQ(count, 3);
}

}  // namespace
}  // namespace mote
