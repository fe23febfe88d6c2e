#include <gtest/gtest.h>

#include "clouds.h"
#include "core/parallel.h"
#include "restir/transmittance_map.h"

namespace mote {
namespace {

using test::bounds_of;
using test::two_clouds;

constexpr Interval everything{0.0f, infinity};
const Vec3 slanted = glm::normalize(Vec3(0.4f, 1.0f, -0.7f));

/// Mean square error of exp(-depth) over the mean square of the exact one, at random points of the
/// media's box that have smoke before them.
double relative_mse(const TransmittanceMap& map, const Media& media, Vec3 wi)
{
    const Bounds3 bounds = bounds_of(media);
    double error = 0.0;
    double square = 0.0;
    for (uint32_t i = 0; i < 4000; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        const Vec3 x = bounds.lo + rng.uniform3() * bounds.extent();
        const Ray ray{x, wi, 0.5f};
        const float depth = optical_depth(media, ray, everything);
        if (depth < 0.1f) continue;
        const double T = std::exp(-static_cast<double>(depth));
        const double difference = static_cast<double>(map.transmittance(x)) - T;
        error += difference * difference;
        square += T * T;
    }
    return error / square;
}

TEST(TransmittanceMap, AgreesWithExactDepthsAndConvergesWithSpacing)
{
    const Media media = two_clouds();
    // Along, against and across axes of the grids and of the world.
    const Mat4d m = matrix(media.volumes[0].world_from_object.at(0.0f));
    const std::vector<Vec3> directions = {slanted,
                                          Vec3(1.0f, 0.0f, 0.0f),
                                          Vec3(0.0f, -1.0f, 0.0f),
                                          Vec3(0.0f, 0.0f, 1.0f),
                                          glm::normalize(Vec3(Vec3d(m[1]))),
                                          -glm::normalize(Vec3(Vec3d(m[2])))};
    for (const Vec3& wi : directions) {
        TransmittanceMapParams params;
        const double coarse = relative_mse(TransmittanceMap(media, wi, params), media, wi);
        params.spacing = 0.25f * TransmittanceMap(media, wi, params).spacing();
        const double fine = relative_mse(TransmittanceMap(media, wi, params), media, wi);
        // Measured: 3e-4 to 9e-4, and 5.5e-3 along the longest axis, where little light comes
        // through; 35 to 150 times less at a quarter of the spacing (256 where depth is smooth).
        EXPECT_LT(coarse, 8e-3);
        EXPECT_LT(fine, coarse / 25.0);
    }
}

TEST(TransmittanceMap, TheWrongDirectionIsRejected)
{
    const Media media = two_clouds();
    EXPECT_GT(relative_mse(TransmittanceMap(media, -slanted), media, slanted), 0.05);
    Media one = media;
    one.volumes.pop_back();
    EXPECT_GT(relative_mse(TransmittanceMap(one, slanted), media, slanted), 0.01);
}

TEST(TransmittanceMap, OutsideIsClearTowardsTheLightAndFullyDeepBehind)
{
    const Media media = two_clouds();
    const Bounds3 bounds = bounds_of(media);
    const float reach = glm::length(bounds.extent());
    for (const Vec3& wi : {slanted, -slanted, Vec3(0.0f, 1.0f, 0.0f)}) {
        const TransmittanceMap map(media, wi);
        const Mat3 frame = make_frame(wi);
        double deepest = 0.0;
        for (uint32_t i = 0; i < 500; ++i) {
            Rng rng(2, 0, Stream::Test, i, 0);
            const Vec3 x = bounds.lo + rng.uniform3() * bounds.extent();
            EXPECT_EQ(map.optical_depth(x + (1.0f + 20.0f * rng.uniform()) * reach * wi), 0.0f);
            const float angle = 2.0f * pi * rng.uniform();
            const Vec3 aside = frame * Vec3(std::cos(angle), std::sin(angle), 0.0f);
            EXPECT_EQ(map.optical_depth(x + (1.0f + 20.0f * rng.uniform()) * reach * aside), 0.0f);
            // Behind everything only the ray counts, not the distance.
            const float behind = map.optical_depth(x - reach * wi);
            EXPECT_NEAR(map.optical_depth(x - 30.0f * reach * wi), behind, 1e-3f * (behind + 1.0f));
            deepest = std::max(deepest, static_cast<double>(behind));
        }
        EXPECT_GT(deepest, 5.0);
    }
}

TEST(TransmittanceMap, HomogeneousSlabIsExact)
{
    // Inside the constant part the depth is linear along the ray: nothing is lost between planes,
    // however far apart. The first plane lies on the slab's face, so two spacings in are safe.
    Volume volume = test::constant_cube(41, 2.0f);
    volume.density_scale = 3.0f;
    finalize(volume);
    const Media media{{volume}};
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {-1.0f, 1.0f}) {
            Vec3 wi(0.0f);
            wi[axis] = sign;
            TransmittanceMapParams params;
            params.spacing = 0.11f;
            const TransmittanceMap map(media, wi, params);
            for (uint32_t i = 0; i < 300; ++i) {
                Rng rng(3, 0, Stream::Test, i, 0);
                const Vec3 x = Vec3(-0.75f) + 1.5f * rng.uniform3();
                const float exact = optical_depth(media, {x, wi, 0.5f}, everything);
                EXPECT_NEAR(map.optical_depth(x), exact, 1e-5f * (exact + 1.0f));
            }
        }
    }
}

TEST(TransmittanceMap, TheRestOfARayIsWhatAMapOfTheOtherDirectionSays)
{
    const Media media = two_clouds();
    const Bounds3 bounds = bounds_of(media);
    TransmittanceMapParams params;
    params.max_depth = infinity;
    const TransmittanceMap map(media, slanted, params);
    double error = 0.0;
    double square = 0.0;
    for (uint32_t i = 0; i < 2000; ++i) {
        Rng rng(6, 0, Stream::Test, i, 0);
        const Vec3 x = bounds.lo + rng.uniform3() * bounds.extent();
        const float exact = std::exp(-optical_depth(media, {x, -slanted, 0.5f}, everything));
        if (exact > 0.9f) continue;
        error += static_cast<double>(sqr(std::exp(-map.depth_behind(x)) - exact));
        square += static_cast<double>(sqr(exact));
    }
    EXPECT_LT(error, 2e-3 * square);  // measured: 4e-4
    EXPECT_GT(square, 10.0);
    // The light's side sees everything, the other nothing, and what is opaque stays so.
    EXPECT_EQ(map.depth_behind(Vec3(0.0f) - 100.0f * slanted),
              2e-7f * map.optical_depth(Vec3(0.0f) - 100.0f * slanted));
    Media opaque = media;
    opaque.volumes[0].density_scale = 1e20f;
    const TransmittanceMap dark(opaque, slanted, params);
    EXPECT_GT(dark.depth_behind(Vec3(0.2f, -0.3f, 0.1f)), 100.0f);
}

TEST(TransmittanceMap, NothingInTheWayWithoutMediaOrDirection)
{
    const Vec3 x(0.1f, 0.2f, 0.3f);
    EXPECT_EQ(TransmittanceMap().optical_depth(x), 0.0f);
    EXPECT_EQ(TransmittanceMap(Media{}, slanted).optical_depth(x), 0.0f);
    Volume no_grid;
    Volume void_grid = test::cube_volume(9, 2.0f, [](Vec3) { return 0.0f; });
    Volume flat = test::constant_cube();
    flat.world_from_object.keys[0].scale = Vec3d(1.0, 0.0, 1.0);
    Volume off = test::constant_cube();
    off.density_scale = 0.0f;
    for (const Volume& volume : {no_grid, void_grid, flat, off}) {
        const TransmittanceMap map(Media{{volume}}, slanted);
        EXPECT_EQ(map.optical_depth(x), 0.0f);
        EXPECT_EQ(map.stats().rays, 0);
    }
    const Media media = two_clouds();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(TransmittanceMap(media, Vec3(0.0f)).optical_depth(x), 0.0f);
    EXPECT_EQ(TransmittanceMap(media, Vec3(nan)).optical_depth(x), 0.0f);
}

TEST(TransmittanceMap, AnyPointGivesAFiniteDepth)
{
    Media media = two_clouds();
    media.volumes[0].density_scale = 1e8f;
    const TransmittanceMap map(media, slanted);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float bad : {nan, infinity, -infinity, 1e30f, -1e30f, 0.0f}) {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 x(0.0f);
            x[axis] = bad;
            const float depth = map.optical_depth(x);
            EXPECT_TRUE(std::isfinite(depth) && depth >= 0.0f) << bad;
        }
    }
}

TEST(TransmittanceMap, SpacingGrowsToFitTheBudget)
{
    const Media media = two_clouds();
    for (const int64_t budget : {int64_t{0}, int64_t{100}, int64_t{20'000}}) {
        TransmittanceMapParams params;
        params.node_budget = budget;
        const TransmittanceMap map(media, slanted, params);
        EXPECT_LE(map.stats().nodes, std::max<int64_t>(budget, 18));
        EXPECT_EQ(map.stats().bytes, 4 * map.stats().nodes);
        EXPECT_GT(map.spacing(), TransmittanceMap(media, slanted).spacing());
        EXPECT_GE(map.optical_depth(Vec3(0.0f)), 0.0f);
    }
}

TEST(TransmittanceMap, MovingMediaStandStillAtMidShutter)
{
    Media moving = two_clouds();
    Trs end = moving.volumes[0].world_from_object.keys[0];
    end.translate += Vec3d(0.4, 0.0, 0.0);
    moving.volumes[0].world_from_object.keys.push_back(end);
    finalize(moving.volumes[0]);
    Media still = moving;
    still.volumes[0].world_from_object = {{moving.volumes[0].world_from_object.at(0.5f)}};
    finalize(still.volumes[0]);
    const TransmittanceMap a(moving, slanted);
    const TransmittanceMap b(still, slanted);
    for (uint32_t i = 0; i < 200; ++i) {
        Rng rng(4, 0, Stream::Test, i, 0);
        const Vec3 x = Vec3(-1.0f) + 2.0f * rng.uniform3();
        EXPECT_EQ(a.optical_depth(x), b.optical_depth(x));
    }
}

TEST(TransmittanceMap, DoesNotDependOnTheThreadCount)
{
    const Media media = two_clouds();
    const auto values = [&](int threads) {
        std::vector<float> out;
        run_with_threads(threads, [&] {
            const TransmittanceMap map(media, slanted);
            for (uint32_t i = 0; i < 500; ++i) {
                Rng rng(5, 0, Stream::Test, i, 0);
                out.push_back(map.optical_depth(Vec3(-1.0f) + 2.0f * rng.uniform3()));
            }
        });
        return out;
    };
    const std::vector<float> one = values(1);
    for (const int threads : {2, 5}) EXPECT_EQ(values(threads), one);
}

}  // namespace
}  // namespace mote
