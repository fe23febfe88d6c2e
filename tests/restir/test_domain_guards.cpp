// Domains and shifts at the edge of what floats can tell: every guard has a case that needs it.
#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"
#include "restir/pixel_domains.h"
#include "restir/scenes.h"
#include "restir/shift.h"

namespace mote {
namespace {

class DomainGuards : public testing::Test {
  protected:
    static const FrameDomain& frame()
    {
        static const FrameDomain made = [] {
            Scene scene = test::lit_clumps(6.0f);
            scene.media.volumes = {test::constant_cube(20)};
            finalize(scene.media.volumes[0]);
            scene.lights = {test::sun()};
            return test::frame_domain_of(scene);
        }();
        return made;
    }

    /// From inside the cube to `t_end`, still inside; all bins of the same weight.
    static PixelDomain even_domain(float t_end = 1.2f)
    {
        PixelDomain domain;
        domain.ray = {Vec3(0.1f, 0.05f, 0.7f), Vec3(0.0f, 0.0f, -1.0f), 0.5f};
        BinCounts counts;
        make_ray_bins(frame().scene->media, domain.ray, 0.0f, domain.bins, counts, t_end);
        for (int k = 0; k <= domain.bins.count; ++k) domain.cdf[k] = static_cast<float>(k);
        return domain;
    }

    /// The same with other weights, one per bin, then `last` for all that follow.
    static PixelDomain weighted(std::initializer_list<float> first, float last)
    {
        PixelDomain domain = even_domain();
        auto next = first.begin();
        for (int k = 0; k < domain.bins.count; ++k) {
            const float weight = next != first.end() ? *next++ : last;
            domain.cdf[k + 1] = domain.cdf[k] + weight;
        }
        return domain;
    }

    static std::optional<ShiftedSample> shifted(ShiftKind kind, float u, const PixelDomain& from,
                                                const PixelDomain& to)
    {
        return shift(kind, {u, 0, Vec3(0.0f)}, {frame(), from}, {frame(), to}, {});
    }
};

TEST_F(DomainGuards, NoNumberStandsForABinOfNoWeightOrNoDepth)
{
    ASSERT_GT(even_domain().bins.count, 4);
    // The smallest float: products with numbers below 1 round up to it.
    const PixelDomain tiny = weighted({0x1p-149f}, 0.0f);
    const RayPoint nowhere = point_at(frame(), tiny, one_minus_epsilon);
    EXPECT_EQ(nowhere.weight, 0.0f);
    EXPECT_TRUE(is_finite(nowhere.x) && std::isfinite(nowhere.s));

    PixelDomain flat = even_domain();
    for (int k = 0; k < flat.bins.count; ++k) flat.bins.tau[k + 1] = 0.0f;
    EXPECT_EQ(point_at(frame(), flat, 0.5f).weight, 0.0f);
    EXPECT_FALSE(number_at(frame(), flat, 0.5f * (flat.bins.s[1] + flat.bins.s[2])));

    const PixelDomain dark = weighted({}, 0.0f);
    EXPECT_EQ(point_at(frame(), dark, 0.5f).weight, 0.0f);
    EXPECT_FALSE(number_at(frame(), dark, dark.bins.s[1]));
    PixelDomain empty = even_domain();
    empty.bins.count = 0;  // what is beyond is whatever was there before
    EXPECT_EQ(point_at(frame(), empty, 0.5f).weight, 0.0f);
    EXPECT_FALSE(number_at(frame(), empty, 0.0f));

    const PixelDomain hole = weighted({1.0f, 0.0f}, 1.0f);
    EXPECT_FALSE(number_at(frame(), hole, 0.5f * (hole.bins.s[1] + hole.bins.s[2])));
    EXPECT_TRUE(number_at(frame(), hole, 0.5f * (hole.bins.s[2] + hole.bins.s[3])));
}

/// Where the table's medium and the frame's differ, as after a change of the scene.
TEST_F(DomainGuards, NothingIsFoundWhereNothingScatters)
{
    Scene scene = *frame().scene;
    scene.media.volumes[0].density_scale = 0.0f;
    FrameDomain thin = frame();
    thin.scene = std::make_shared<const Scene>(scene);
    const PixelDomain domain = even_domain();
    EXPECT_FALSE(number_at(thin, domain, domain.bins.s[2]));
}

TEST_F(DomainGuards, NumbersStayBelowOne)
{
    for (const PixelDomain& domain : {even_domain(), weighted({1.0f}, 1e-9f)}) {
        for (int k = 0; k <= domain.bins.count; ++k) {
            for (const int way : {-1, 0, 1}) {
                const float at = domain.bins.s[k];
                const float s = way == 0 ? at : std::nextafter(at, way < 0 ? -infinity : infinity);
                const auto number = number_at(frame(), domain, s);
                if (!number) continue;
                EXPECT_TRUE(number->u >= 0.0f && number->u < 1.0f) << k << " " << number->u;
            }
        }
    }
    const PixelDomain domain = even_domain();
    EXPECT_TRUE(number_at(frame(), domain, domain.bins.s[domain.bins.count]));
}

TEST_F(DomainGuards, ShiftsByPlaceHaveAJacobianOrNone)
{
    const PixelDomain even = even_domain();
    const PixelDomain rare = weighted({1e-40f}, 1.0f);
    // Densities of almost 0 here, and there; and of 0.
    EXPECT_FALSE(shifted(ShiftKind::World, 0.0f, rare, even));
    const PixelDomain rarest = weighted({0x1p-149f}, 1e6f);
    EXPECT_FALSE(shifted(ShiftKind::World, 1e-3f, even, rarest));
    EXPECT_FALSE(shifted(ShiftKind::World, 0.0f, rarest, even));
    // The near end stands for no number that stands for nothing.
    PixelDomain tiny = weighted({0x1p-149f}, 0.0f);
    for (int k = 1; k <= tiny.bins.count; ++k) tiny.bins.tau[k] = 5.0f;
    ASSERT_EQ(point_at(frame(), tiny, one_minus_epsilon).weight, 0.0f);
    ASSERT_TRUE(number_at(frame(), tiny, 0.0f));
    EXPECT_FALSE(shifted(ShiftKind::World, one_minus_epsilon, tiny, tiny));
}

TEST_F(DomainGuards, ShiftsFromOrToNothingAreUndefined)
{
    const PixelDomain even = even_domain();
    const PixelDomain dark = weighted({}, 0.0f);
    PixelDomain empty = even_domain();
    empty.bins.count = 0;
    for (const ShiftKind kind : {ShiftKind::World, ShiftKind::Fraction}) {
        EXPECT_FALSE(shifted(kind, 0.5f, dark, even));
        EXPECT_FALSE(shifted(kind, 0.5f, even, dark));
        EXPECT_FALSE(shifted(kind, 0.5f, empty, even));
        EXPECT_FALSE(shifted(kind, 0.5f, even, empty));
    }
    const PixelDomain hole = weighted({0.0f}, 1.0f);
    EXPECT_FALSE(shifted(ShiftKind::Fraction, 0.0f, even, hole));
}

/// Rays of many lengths: where rounding carries the last number varies.
TEST_F(DomainGuards, SharesOfCollisionsStayBelowOne)
{
    for (int i = 0; i < 300; ++i) {
        const PixelDomain even = even_domain(1.0f + 0.001f * static_cast<float>(i));
        PixelDomain from = even;  // all numbers stand for places in the last bin
        for (int k = 0; k < from.bins.count; ++k) from.cdf[k] = 0.0f;
        PixelDomain to = even;  // hardly any number does
        for (int k = 1; k <= to.bins.count; ++k) to.cdf[k] = 1.0f + 1e-7f * static_cast<float>(k);
        const auto end = shifted(ShiftKind::Fraction, one_minus_epsilon, from, to);
        if (end) {
            EXPECT_TRUE(end->y.u >= 0.0f && end->y.u < 1.0f) << i;
            EXPECT_TRUE(end->jacobian > 0.0f && std::isfinite(end->jacobian)) << i;
        }
        // All the light of a thick ray collides. The last of its numbers is not at an infinite
        // depth, where no light is.
        PixelDomain thick = even;
        for (int k = 1; k <= thick.bins.count; ++k) {
            thick.bins.tau[k] = k == 1 ? 5.0f : 200.0f * static_cast<float>(k);
        }
        const auto far = shifted(ShiftKind::Fraction, one_minus_epsilon, from, thick);
        ASSERT_TRUE(far) << i;
        EXPECT_TRUE(far->y.u >= 0.0f && far->y.u < 1.0f) << i;
        EXPECT_TRUE(far->jacobian > 0.0f && std::isfinite(far->jacobian)) << i;
    }
}

/// Gaps between media get no numbers.
TEST_F(DomainGuards, BinsWithoutDepthGetNoWeight)
{
    Scene scene = *frame().scene;
    scene.media.volumes = {
        test::cube_volume(40, 2.0f, [](Vec3 p) { return std::abs(p.z) > 0.5f ? 1.0f : 0.0f; })};
    finalize(scene.media.volumes[0]);
    const FrameDomain gap = test::frame_domain_of(scene);
    PixelDomain domain;
    test::make_domain(gap, Vec2(4.0f, 3.0f), domain);
    int gaps = 0;
    for (int k = 0; k < domain.bins.count; ++k) {
        const float width = domain.cdf[k + 1] - domain.cdf[k];
        gaps += domain.bins.depth_of_bin(k) > 0.0f ? 0 : 1;
        EXPECT_EQ(width > 0.0f, domain.bins.depth_of_bin(k) > 0.0f) << k;
    }
    EXPECT_GT(gaps, 0);
}

}  // namespace
}  // namespace mote
