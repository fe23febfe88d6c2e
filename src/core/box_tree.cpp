#include "core/box_tree.h"

#include <algorithm>

namespace mote {
namespace {

/// Items below each child of a node over n items: a power of eight, so that leaves are full.
size_t items_per_child(size_t n)
{
    size_t capacity = 1;
    while (capacity * lane_count < n) capacity *= lane_count;
    return capacity;
}

/// Sorts items into consecutive groups of `capacity`, halving along the longest axis.
void sort_into(std::span<BoxTree::Item> items, size_t capacity)
{
    const size_t groups = (items.size() + capacity - 1) / capacity;
    if (groups < 2) return;
    Bounds3 centres;
    for (const BoxTree::Item& item : items) centres.extend(item.bounds.centre());
    const Vec3 extent = centres.extent();
    int axis = extent.y > extent.x ? 1 : 0;
    if (extent.z > extent[axis]) axis = 2;
    const size_t middle = groups / 2 * capacity;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle),
                     items.end(), [axis](const BoxTree::Item& a, const BoxTree::Item& b) {
                         const float ca = a.bounds.centre()[axis];
                         const float cb = b.bounds.centre()[axis];
                         return ca != cb ? ca < cb : a.id < b.id;
                     });
    sort_into(items.first(middle), capacity);
    sort_into(items.subspan(middle), capacity);
}

/// Flat boxes must be met by rays that touch them to within rounding.
Bounds3 widened(Bounds3 box)
{
    const Vec3 size = glm::max(glm::abs(box.lo), glm::abs(box.hi));
    box.lo -= 1e-6f * size;
    box.hi += 1e-6f * size;
    return box;
}

}  // namespace

BoxTree::BoxTree(std::vector<Item> items)
{
    if (items.empty()) return;
    nodes_.reserve(items.size() / (lane_count - 1) + 16);
    nodes_.emplace_back();
    build(items, 0);
}

Bounds3 BoxTree::build(std::span<Item> items, int index)
{
    const size_t capacity = items_per_child(items.size());
    sort_into(items, capacity);
    Node node;
    Bounds3 all;
    for (int lane = 0; !items.empty(); ++lane) {
        node.lanes |= 1u << lane;
        const size_t count = std::min(capacity, items.size());
        Bounds3 box;
        if (count == 1) {
            box = widened(items.front().bounds);
            node.child[lane] = ~items.front().id;
        } else {
            node.child[lane] = static_cast<int32_t>(nodes_.size());
            nodes_.emplace_back();
            box = build(items.first(count), node.child[lane]);
        }
        for (int axis = 0; axis < 3; ++axis) {
            node.lo[axis][lane] = box.lo[axis];
            node.hi[axis][lane] = box.hi[axis];
        }
        all.extend(box);
        items = items.subspan(count);
    }
    nodes_[static_cast<size_t>(index)] = node;
    return all;
}

}  // namespace mote
