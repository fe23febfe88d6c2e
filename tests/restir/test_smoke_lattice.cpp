#include <gtest/gtest.h>

#include "clouds.h"
#include "restir/smoke_lattice.h"

namespace mote {
namespace {

using test::two_clouds;

TEST(SmokeLattice, SmokeHasEightActiveNodesAroundIt)
{
    const Media media = two_clouds();
    const Bounds3 bounds = test::bounds_of(media);
    for (const float spacing : {0.03f, 0.1f, 0.4f, 10.0f}) {
        const SmokeLattice lattice = make_smoke_lattice(media, spacing, 1'000'000);
        EXPECT_EQ(lattice.spacing, spacing);
        int in_smoke = 0;
        for (uint32_t i = 0; i < 5000; ++i) {
            Rng rng(1, 0, Stream::Test, i, 0);
            const Vec3 x = bounds.lo + rng.uniform3() * bounds.extent();
            const SmokeLattice::Corners corners = lattice.corners(x);
            Vec3 mean(0.0f);
            for (int n = 0; n < 8; ++n) {
                const Vec3i node = corners.node(n);
                mean += corners.weight[n] * lattice.position(node);
                ASSERT_EQ(corners.slot[n], lattice.slots[lattice.index(node)]);
                if (corners.slot[n] != 0) {
                    ASSERT_EQ(lattice.nodes[static_cast<size_t>(corners.slot[n])], node);
                }
            }
            if (!(test::sigma_of(media, x) > 0.0f)) continue;
            ++in_smoke;
            EXPECT_LT(glm::length(mean - x), 1e-5f * (spacing + 1.0f));
            for (const int32_t slot : corners.slot) EXPECT_GT(slot, 0);
        }
        EXPECT_GT(in_smoke, 500);
    }
}

TEST(SmokeLattice, CoversWhereMovingMediaPass)
{
    Media media = two_clouds();
    MovingTransform& motion = media.volumes[0].world_from_object;
    Trs end = motion.keys[0];
    end.translate += Vec3d(3.0, 0.0, 0.0);
    motion.keys.push_back(end);
    finalize(media.volumes[0]);
    const SmokeLattice lattice = make_smoke_lattice(media, 0.1f, 1'000'000);
    for (const float time : {0.0f, 0.5f, 1.0f}) {
        const Vec3 centre(Vec3d(matrix(motion.at(time))[3]));
        for (const int32_t slot : lattice.corners(centre).slot) EXPECT_GT(slot, 0);
    }
}

TEST(SmokeLattice, EmptySpaceBetweenCloudsIsInactive)
{
    Media media = two_clouds();
    media.volumes[1].world_from_object.keys[0].translate = Vec3d(8.0, 0.0, 0.0);
    finalize(media.volumes[1]);
    const SmokeLattice lattice = make_smoke_lattice(media, 0.1f, 1'000'000);
    EXPECT_LT(lattice.active_count(), static_cast<int32_t>(lattice.slots.size() / 3));
    for (const int32_t slot : lattice.corners(Vec3(4.0f, 0.0f, 0.0f)).slot) EXPECT_EQ(slot, 0);
}

TEST(SmokeLattice, SpacingGrowsToFitTheBudget)
{
    const Media media = two_clouds();
    for (const int budget : {-5, 0, 100, 3000}) {
        const SmokeLattice lattice = make_smoke_lattice(media, 1e-4f, budget);
        EXPECT_LE(lattice.active_count(), std::max(budget, 64));
        EXPECT_GT(lattice.active_count(), 0);
    }
}

TEST(SmokeLattice, NoDensityNoNodes)
{
    for (const Media& media :
         {Media{}, Media{{test::cube_volume(9, 2.0f, [](Vec3) { return 0.0f; })}}}) {
        const SmokeLattice lattice = make_smoke_lattice(media, 0.1f, 1000);
        EXPECT_EQ(lattice.active_count(), 0);
        const float nan = std::numeric_limits<float>::quiet_NaN();
        for (const float x : {0.0f, 1e30f, -infinity, nan}) {
            for (const int32_t slot : lattice.corners(Vec3(x)).slot) EXPECT_EQ(slot, 0);
        }
    }
}

}  // namespace
}  // namespace mote
