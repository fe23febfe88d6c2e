#include <gtest/gtest.h>

#include <algorithm>

#include "core/box_tree.h"
#include "core/rng.h"

namespace mote {
namespace {

/// Boxes of very different sizes, some of them flat, at places in a unit cube.
std::vector<BoxTree::Item> random_boxes(int count, Rng& rng)
{
    std::vector<BoxTree::Item> items;
    for (int i = 0; i < count; ++i) {
        Bounds3 box;
        box.lo = rng.uniform3();
        Vec3 size = 0.5f * rng.uniform3() * rng.uniform();
        if (i % 5 == 0) size[i % 3] = 0.0f;
        box.hi = box.lo + size;
        items.push_back({3 * i, box});
    }
    return items;
}

/// Ids of the boxes that a ray meets, by trying them all; widened: those that rounding may add.
std::vector<int> met_by(const std::vector<BoxTree::Item>& items, const Ray& ray, float wider)
{
    std::vector<int> met;
    for (const BoxTree::Item& item : items) {
        const Bounds3 box{item.bounds.lo - wider, item.bounds.hi + wider};
        const Interval inside = clip(ray.o, ray.d, box, {0.0f, infinity});
        if (inside.t0 <= inside.t1) met.push_back(item.id);
    }
    return met;
}

TEST(BoxTree, FindsAllBoxesThatRaysMeetAndNoneFarFromThem)
{
    Rng rng(1, 0, Stream::Test, 0, 0);
    int found = 0;
    for (const int count : {1, 2, 7, 8, 9, 64, 65, 1000}) {
        const std::vector<BoxTree::Item> items = random_boxes(count, rng);
        const BoxTree tree(items);
        for (int trial = 0; trial < 300; ++trial) {
            Vec3 d = 2.0f * rng.uniform3() - 1.0f;
            if (trial % 3 == 0) d[trial % 2] = 0.0f;  // along planes
            if (trial % 7 == 0) d = Vec3(0.0f, 0.0f, -1.0f);
            const Ray ray{1.6f * rng.uniform3() - 0.3f, glm::normalize(d), 0.0f};
            std::vector<int> met;
            tree.for_each_on_ray(ray, [&](int id) { met.push_back(id); });
            std::sort(met.begin(), met.end());
            const std::vector<int> surely = met_by(items, ray, 0.0f);
            const std::vector<int> perhaps = met_by(items, ray, 1e-5f);
            EXPECT_TRUE(std::includes(met.begin(), met.end(), surely.begin(), surely.end()));
            EXPECT_TRUE(std::includes(perhaps.begin(), perhaps.end(), met.begin(), met.end()));
            found += static_cast<int>(met.size());
        }
    }
    EXPECT_GT(found, 1000);
}

TEST(BoxTree, RaysWithinThePlaneOfAFlatBoxMeetIt)
{
    const Bounds3 flat{Vec3(0.25f, 0.5f, -1.0f), Vec3(0.75f, 0.5f, 1.0f)};
    const BoxTree tree({{4, flat}});
    int met = 0;
    tree.for_each_on_ray({Vec3(0.5f, 0.5f, 5.0f), Vec3(0.0f, 0.0f, -1.0f), 0.0f},
                         [&](int id) { met += id; });
    tree.for_each_on_ray({Vec3(0.5f, 5.0f, 0.0f), Vec3(0.0f, -1.0f, 0.0f), 0.0f},
                         [&](int id) { met += id; });
    tree.for_each_on_ray({Vec3(0.5f, 5.0f, 0.0f), Vec3(0.0f, 1.0f, 0.0f), 0.0f},
                         [&](int id) { met += 100 * id; });  // behind the ray
    EXPECT_EQ(met, 8);
    EXPECT_TRUE(BoxTree().is_empty());
    EXPECT_TRUE(BoxTree(std::vector<BoxTree::Item>()).is_empty());
}

}  // namespace
}  // namespace mote
