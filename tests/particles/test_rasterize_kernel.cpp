#include <gtest/gtest.h>

#include "core/rng.h"
#include "particles/kernel.h"
#include "particles/kernel_rows.h"

namespace mote {
namespace {

double direct_sum(Vec3 p, float support)
{
    const int reach = static_cast<int>(support) + 2;
    double sum = 0.0;
    for (int x = -reach; x <= reach; ++x) {
        for (int y = -reach; y <= reach; ++y) {
            for (int z = -reach; z <= reach; ++z) {
                const Vec3d d = (Vec3d(x, y, z) - Vec3d(p)) / static_cast<double>(support);
                const double root = std::max(0.0, 1.0 - glm::dot(d, d));
                sum += root * root;
            }
        }
    }
    return sum;
}

TEST(Kernel, LatticeSumAgreesWithADirectSum)
{
    // Both the vector form (up to 3.5 voxels) and the closed form per row. Float rounding.
    for (const float support : {1.0f, 1.2f, 2.0f, 3.49f, 3.51f, 5.0f, 12.3f, 30.0f}) {
        for (uint32_t i = 0; i < 20; ++i) {
            const Vec3 p = Rng(1, 0, Stream::Test, i, 0).uniform3();
            const double exact = direct_sum(p, support);
            ASSERT_NEAR(kernel_lattice_sum(p, support) / exact, 1.0, 1e-6) << support;
        }
        const double exact = direct_sum(Vec3(0.0f), support);
        ASSERT_NEAR(kernel_lattice_sum(Vec3(0.0f), support) / exact, 1.0, 1e-6) << support;
    }
}

TEST(Kernel, SmallestSupportAlwaysReachesTheLattice)
{
    EXPECT_GT(kernel_lattice_sum(Vec3(0.5f), min_support_voxels), 0.4);
}

TEST(Kernel, RowsAgreeWithTheScalarKernel)
{
    const float support = 3.7f;
    const KernelRows rows = make_kernel_rows(-2.0f, 1.3f, support, 1.0f);
    for (const float d2 : {0.0f, 1.0f, 9.0f, 20.0f}) {
        const Float8 values = eval_row(rows, d2);
        for (int i = 0; i < 8; ++i) {
            const float dz = static_cast<float>(i - 2) - 1.3f;
            EXPECT_NEAR(values[i], eval_kernel((d2 + dz * dz) / (support * support)), 1e-6f);
        }
    }
}

}  // namespace
}  // namespace mote
