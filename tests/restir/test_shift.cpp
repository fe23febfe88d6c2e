#include "restir/shift.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/rng.h"
#include "restir/pixel_domains.h"
#include "restir/reproject.h"
#include "restir/reuse_scenes.h"

namespace mote {
namespace {

constexpr ShiftKind kinds[] = {ShiftKind::RandomNumbers, ShiftKind::World, ShiftKind::Fraction};

/// Two frames of moving smoke seen by a moving camera, and one frame's neighbouring pixels.
class ShiftTest : public testing::Test {
  protected:
    static const std::vector<FrameDomain>& frames()
    {
        static const std::vector<FrameDomain> made = [] {
            std::vector<FrameDomain> out;
            for (const Scene& scene : test::everything_moves_frames(2)) {
                out.push_back(test::frame_domain_of(scene));
            }
            return out;
        }();
        return made;
    }

    /// Two rays that may be of different frames and a map between them.
    struct Pair {
        const FrameDomain* from_frame = nullptr;
        const FrameDomain* to_frame = nullptr;
        PixelDomain from, to;
        RayMap map;

        [[nodiscard]] ShiftEnd from_end() const { return {*from_frame, from}; }
        [[nodiscard]] ShiftEnd to_end() const { return {*to_frame, to}; }
    };

    /// Random rays a pixel or two apart, in time or in space.
    static Pair random_pair(Rng& rng)
    {
        Pair pair;
        const bool in_time = rng.uniform() < 0.5f;
        pair.from_frame = &frames()[in_time ? 0 : 1];
        pair.to_frame = &frames()[1];
        const Vec2 film = Vec2(8.0f, 6.0f) * rng.uniform2();
        test::make_domain(*pair.to_frame, film, pair.to);
        test::make_domain(*pair.from_frame, film + 2.0f * rng.uniform2() - 1.0f, pair.from);
        const Vec3 motion = in_time ? 0.1f * (rng.uniform3() - 0.5f) : Vec3(0.0f);
        pair.map = make_ray_map(pair.from.ray, pair.to.ray, motion);
        return pair;
    }

    static std::optional<ShiftedSample> forth(ShiftKind kind, const Pair& pair, float u)
    {
        return shift(kind, {u, 0, Vec3(0.3f, 0.6f, 0.0f)}, pair.from_end(), pair.to_end(),
                     pair.map);
    }
    static std::optional<ShiftedSample> back(ShiftKind kind, const Pair& pair, const PathSample& y)
    {
        return shift(kind, y, pair.to_end(), pair.from_end(), pair.map.inverse());
    }
};

/// du'/du by central differences, between points of one bin on either ray. Floats: u has 24 bits
/// and distances about 22, over a step of 0.002; curvature inside a bin is of second order.
TEST_F(ShiftTest, JacobianIsTheDerivative)
{
    for (const ShiftKind kind : kinds) {
        int compared = 0;
        int off = 0;
        double largest_change = 0.0;
        for (uint32_t trial = 0; trial < 3000; ++trial) {
            Rng rng(1, 0, Stream::Test, trial, 0);
            const Pair pair = random_pair(rng);
            const float u = 0.02f + 0.96f * rng.uniform();
            const float step = 0.001f;
            const auto mid = forth(kind, pair, u);
            const auto low = forth(kind, pair, u - step);
            const auto high = forth(kind, pair, u + step);
            if (!mid || !low || !high) continue;
            const auto bin = [&](const PixelDomain& domain, const FrameDomain& frame, float at) {
                return point_at(frame, domain, at).bin;
            };
            if (bin(pair.from, *pair.from_frame, u - step) !=
                    bin(pair.from, *pair.from_frame, u + step) ||
                bin(pair.to, *pair.to_frame, low->y.u) != bin(pair.to, *pair.to_frame, high->y.u)) {
                continue;
            }
            const float slope = (high->y.u - low->y.u) / (2.0f * step);
            ++compared;
            if (std::abs(slope - mid->jacobian) > 0.02f * mid->jacobian + 1e-3f) ++off;
            largest_change =
                std::max(largest_change, std::abs(std::log(static_cast<double>(mid->jacobian))));
        }
        EXPECT_GT(compared, 500);
        EXPECT_LE(off, compared / 200) << static_cast<int>(kind);  // kinks at cell borders
        if (kind == ShiftKind::RandomNumbers) {
            EXPECT_EQ(largest_change, 0.0);
        } else {
            EXPECT_GT(largest_change, 0.5);  // a missing Jacobian would show
        }
    }
}

/// There and back is where one was, and the Jacobians cancel. Where smoke is so thin that u hardly
/// changes with distance (one per cent of the numbers stand for bins whatever their depth),
/// rounding of u moves the point: one in a thousand may be off by more than the rounding of u' and
/// of distances. What is defined one way is defined the other: at the very ends of a ray rounding
/// may decide.
TEST_F(ShiftTest, ComesBackAndIsDefinedAlikeBothWays)
{
    for (const ShiftKind kind : kinds) {
        int defined = 0;
        int undefined = 0;
        int one_way = 0;
        int off = 0;
        for (uint32_t trial = 0; trial < 5000; ++trial) {
            Rng rng(2, 0, Stream::Test, trial, 0);
            const Pair pair = random_pair(rng);
            const float u = rng.uniform();
            const auto there = forth(kind, pair, u);
            if (!there) {
                ++undefined;
                continue;
            }
            ++defined;
            const auto again = back(kind, pair, there->y);
            if (!again) {
                ++one_way;
                continue;
            }
            EXPECT_NEAR(again->y.u, u, 1e-2f) << static_cast<int>(kind);
            if (std::abs(again->y.u - u) > 4e-5f + 2e-6f / there->jacobian ||
                std::abs(again->jacobian * there->jacobian - 1.0f) > 0.01f) {
                ++off;
            }
            EXPECT_EQ(again->y.light, 0);
            EXPECT_EQ(again->y.v, Vec3(0.3f, 0.6f, 0.0f));
        }
        EXPECT_GT(defined, 2500);
        EXPECT_GT(undefined, 100) << static_cast<int>(kind);
        EXPECT_LE(one_way, defined / 2000) << static_cast<int>(kind);
        EXPECT_LE(off, defined / 1000) << static_cast<int>(kind);
    }
}

/// The image of [0,1) under a shift, measured by its Jacobian, cannot exceed [0,1); random numbers
/// and fractions of light cover all of it.
TEST_F(ShiftTest, JacobiansIntegrateToWhatIsCovered)
{
    for (const ShiftKind kind : kinds) {
        for (uint32_t trial = 0; trial < 30; ++trial) {
            Rng rng(3, 0, Stream::Test, trial, 0);
            const Pair pair = random_pair(rng);
            if (!(pair.from.Z() > 0.0f) || !(pair.to.Z() > 0.0f)) continue;
            double covered = 0.0;
            constexpr int steps = 2000;
            for (int i = 0; i < steps; ++i) {
                const auto there =
                    forth(kind, pair, (static_cast<float>(i) + 0.5f) / static_cast<float>(steps));
                if (there) covered += static_cast<double>(there->jacobian) / steps;
            }
            // Midpoint rule over jumps at bin borders and, by place, steep changes of density.
            if (kind == ShiftKind::World) {
                EXPECT_LE(covered, 1.05);
            } else {
                EXPECT_NEAR(covered, 1.0, 0.01);
            }
        }
    }
}

TEST_F(ShiftTest, IsUndefinedWithoutSmokeOnEitherSide)
{
    Rng rng(4, 0, Stream::Test, 0, 0);
    Pair pair = random_pair(rng);
    test::make_domain(*pair.to_frame, Vec2(4.0f, 3.0f), pair.to);
    test::make_domain(*pair.from_frame, Vec2(4.0f, 3.0f), pair.from);
    PixelDomain& miss = pair.to;
    const PixelDomain hit = pair.from;
    Ray away = hit.ray;
    away.d = -away.d;
    BinCounts counts;
    make_pixel_domain(*pair.to_frame, away, miss, counts);
    ASSERT_TRUE(miss.bins.empty());
    for (const ShiftKind kind : kinds) {
        EXPECT_FALSE(forth(kind, pair, 0.5f));
        EXPECT_FALSE(back(kind, pair, {0.5f, 0, Vec3(0.0f)}));
    }
}

/// Lights that change their kind between frames: neither could have made the other's sample.
TEST_F(ShiftTest, IsUndefinedBetweenKindsOfLights)
{
    FrameDomain other = frames()[1];
    ASSERT_EQ(other.lights.size(), 2u);
    other.lights[0].kind = SampledLightKind::EmissiveVolume;
    other.lights.pop_back();
    Rng rng(5, 0, Stream::Test, 0, 0);
    Pair pair = random_pair(rng);
    pair.from_frame = &frames()[1];
    pair.to_frame = &other;
    test::make_domain(frames()[1], Vec2(4.0f, 3.0f), pair.to);
    test::make_domain(frames()[1], Vec2(4.2f, 3.1f), pair.from);
    for (const ShiftKind kind : kinds) {
        for (const int light : {-1, 0, 1, 2}) {
            const PathSample y{0.5f, light, Vec3(0.5f)};
            EXPECT_FALSE(shift(kind, y, pair.from_end(), pair.to_end(), RayMap{}));
            EXPECT_FALSE(shift(kind, y, pair.to_end(), pair.from_end(), RayMap{}));
        }
    }
}

}  // namespace
}  // namespace mote
