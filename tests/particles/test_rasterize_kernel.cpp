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
    // The closed form per row. What is left is the rounding of 1 in (1 - r^2/h^2).
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

TEST(Kernel, EightAtOnceAgreeWithOne)
{
    for (const float support : {1.0f, 1.7f, 4.0f, 4.1f, 9.0f}) {
        KernelCentres centres;
        for (uint32_t i = 0; i < 8; ++i) {
            Rng rng(2, 0, Stream::Test, i, 0);
            centres.x[i] = rng.uniform();
            centres.y[i] = i == 0 ? 0.0f : rng.uniform();
            centres.z[i] = rng.uniform();
            centres.support[i] = std::max(1.0f, support - rng.uniform());
        }
        float sums[8];
        kernel_lattice_sums(centres, sums);
        for (int i = 0; i < 8; ++i) {
            const double exact =
                direct_sum(Vec3(centres.x[i], centres.y[i], centres.z[i]), centres.support[i]);
            ASSERT_NEAR(static_cast<double>(sums[i]) / exact, 1.0, 1e-6) << support;
        }
    }
}

TEST(Kernel, BlockAgreesWithTheScalarKernel)
{
    const Vec3 p(1.3f, 6.9f, -2.2f);
    const float support = 5.7f;
    const KernelBlock block = make_kernel_block(p.x, p.y, p.z, support, std::sqrt(3.0f));
    for (size_t x = 0; x < 8; ++x) {
        for (size_t y = 0; y < 8; ++y) {
            const Float8 roots = eval_row_roots(block, x, y);
            for (int z = 0; z < 8; ++z) {
                const Vec3 d = Vec3(x, y, z) - p;
                const float r2 = glm::dot(d, d) / (support * support);
                EXPECT_NEAR(roots[z] * roots[z], 3.0f * eval_kernel(r2), 2e-6f);
            }
        }
    }
}

}  // namespace
}  // namespace mote
