#include "restir/domain_store.h"

#include <gtest/gtest.h>

#include "core/rng.h"
#include "restir/pixel_domains.h"
#include "restir/reuse_scenes.h"

namespace mote {
namespace {

void expect_equal(const PixelDomain& a, const PixelDomain& b)
{
    EXPECT_EQ(a.ray.o, b.ray.o);
    EXPECT_EQ(a.ray.d, b.ray.d);
    EXPECT_EQ(a.ray.time, b.ray.time);
    ASSERT_EQ(a.bins.count, b.bins.count);
    EXPECT_EQ(a.Z(), b.Z());
    EXPECT_EQ(a.bins.depth(), b.bins.depth());
    if (a.bins.empty()) return;
    EXPECT_EQ(a.bins.t0, b.bins.t0);
    for (int k = 0; k <= a.bins.count; ++k) {
        EXPECT_EQ(a.bins.s[k], b.bins.s[k]);
        EXPECT_EQ(a.bins.tau[k], b.bins.tau[k]);
        EXPECT_EQ(a.cdf[k], b.cdf[k]);
    }
}

/// Image larger than a tile, not a multiple of it, with rays that miss; stored tile by tile.
TEST(DomainStore, GivesBackWhatWasStored)
{
    using namespace test::scene_text;
    const std::vector<Scene> frames =
        test::frames_of(image(21, 18) + "[camera]\nposition = [0, 0, 2.6]\nfov = 30\n" +
                            test::scene_text::puff() + two_lamps,
                        1);
    const FrameDomain frame = test::frame_domain_of(frames[0]);
    DomainStore store(21, 18);
    EXPECT_FALSE(store.empty());
    PixelDomain domain;
    const auto make = [&](int x, int y) { test::make_domain(frame, Vec2(x, y) + 0.3f, domain); };
    for (const Tile& tile :
         {Tile{0, 0, 16, 16}, Tile{16, 0, 21, 16}, Tile{0, 16, 16, 18}, Tile{16, 16, 21, 18}}) {
        for (int y = tile.y0; y < tile.y1; ++y) {
            for (int x = tile.x0; x < tile.x1; ++x) {
                make(x, y);
                store.store(x, y, domain);
            }
        }
    }
    int empty = 0;
    PixelDomain loaded;
    for (int y = 0; y < 18; ++y) {
        for (int x = 0; x < 21; ++x) {
            make(x, y);
            store.load(x, y, loaded);
            expect_equal(domain, loaded);
            EXPECT_EQ(store.depth(x, y), domain.bins.depth());
            if (domain.bins.empty()) {
                ++empty;
                continue;
            }
            for (const float u : {0.0f, 0.37f, one_minus_epsilon}) {
                EXPECT_EQ(point_at(frame, domain, u).s, point_at(frame, loaded, u).s);
            }
        }
    }
    EXPECT_GT(empty, 20);
    EXPECT_LT(empty, 21 * 18 - 100);
    EXPECT_GT(store.memory_bytes(), size_t{21 * 18 * 40});
    EXPECT_TRUE(DomainStore().empty());
}

}  // namespace
}  // namespace mote
