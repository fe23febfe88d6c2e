#include <gtest/gtest.h>

#include "clouds.h"
#include "restir/coarse_media.h"

namespace mote {
namespace {

constexpr Interval everything{0.0f, infinity};

TEST(CoarseMedia, HalvingIsATentFilter)
{
    // By definition, voxel by voxel; sizes and origins that do not fit bricks included.
    for (const Vec3i& size : {Vec3i(1, 1, 1), Vec3i(8, 9, 17), Vec3i(23, 16, 40)}) {
        std::vector<float> values;
        for (uint32_t i = 0; i < static_cast<uint32_t>(size.x * size.y * size.z); ++i) {
            Rng rng(1, 0, Stream::Test, i, 0);
            values.push_back(std::max(0.0f, rng.uniform() - 0.3f));
        }
        const Affine index_from_object{Mat3(3.0f), Vec3(0.25f, -7.0f, 0.0f)};
        const auto fine = make_dense_bricks(size, values, index_from_object);
        const BrickGrid coarse = halve_bricks(*fine);
        double sum = 0.0;
        for (int x = -2; x < size.x; ++x) {
            for (int y = -2; y < size.y; ++y) {
                for (int z = -2; z < size.z; ++z) {
                    double expected = 0.0;
                    for (int n = 0; n < 27; ++n) {
                        const Vec3i d(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
                        const double weight =
                            0.5 / (1 << (std::abs(d.x) + std::abs(d.y) + std::abs(d.z))) * 0.25;
                        expected += weight * static_cast<double>(sample_trilinear(
                                                 *fine, Vec3(2 * Vec3i(x, y, z) + d)));
                    }
                    const float value = sample_trilinear(coarse, Vec3(x, y, z));
                    ASSERT_NEAR(value, expected, 1e-6) << x << " " << y << " " << z;
                    sum += static_cast<double>(value);
                }
            }
        }
        EXPECT_NEAR(sum, coarse.sum, 1e-5 * coarse.sum);
        const Vec3 p(1.7f, 2.9f, 3.3f);
        EXPECT_EQ(coarse.index_from_object.point(p), 0.5f * fine->index_from_object.point(p));
    }
}

TEST(CoarseMedia, KeepsDepthsOfRaysOnAverage)
{
    const Media fine = test::two_clouds();
    const Media coarse = coarse_media(fine, 0.2f);
    ASSERT_EQ(coarse.volumes.size(), fine.volumes.size());
    EXPECT_NE(coarse.volumes[0].density, fine.volumes[0].density);
    double fine_sum = 0.0;
    double coarse_sum = 0.0;
    double difference = 0.0;
    const Bounds3 bounds = test::bounds_of(fine);
    for (uint32_t i = 0; i < 3000; ++i) {
        Rng rng(2, 0, Stream::Test, i, 0);
        const Vec3 d(0.0f, 1.0f, 0.0f);
        const Vec3 x = bounds.lo - d + rng.uniform3() * bounds.extent() * Vec3(1.0f, 0.0f, 1.0f);
        const double a = static_cast<double>(optical_depth(fine, {x, d}, everything));
        const double b = static_cast<double>(optical_depth(coarse, {x, d}, everything));
        fine_sum += a;
        coarse_sum += b;
        difference += std::abs(a - b);
    }
    // Means over an area, each with a thousand hits; what is smoothed out is much more.
    EXPECT_NEAR(coarse_sum, fine_sum, 0.01 * fine_sum);
    EXPECT_GT(difference, 0.05 * fine_sum);
}

TEST(CoarseMedia, CoarseEnoughIsShared)
{
    const Media fine = test::two_clouds();
    const Media same = coarse_media(fine, 0.01f);
    EXPECT_EQ(same.volumes[0].density, fine.volumes[0].density);
    EXPECT_TRUE(coarse_media(Media{}, 1.0f).empty());
    const Media huge = coarse_media(fine, infinity);  // ends
    EXPECT_EQ(huge.volumes.size(), 2u);
}

}  // namespace
}  // namespace mote
