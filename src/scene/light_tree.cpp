#include "scene/light_tree.h"

#include "core/distribution.h"
#include "core/error.h"

namespace mote {
double effective_distance2(const Bounds3& bounds, Vec3 x)
{
    const Vec3d to_centre = Vec3d(bounds.centre()) - Vec3d(x);
    const Vec3d half = 0.5 * Vec3d(bounds.extent());
    return std::max(glm::dot(to_centre, to_centre), glm::dot(half, half) / 6.0);
}

LightTree::LightTree(std::vector<Item> items)
{
    if (items.empty()) return;
    int max_id = 0;
    for (const Item& item : items) max_id = std::max(max_id, item.id);
    leaf_of_id_.assign(static_cast<size_t>(max_id) + 1, -1);
    nodes_.reserve(2 * items.size() - 1);
    build(items, 0, items.size(), -1);
}

int LightTree::build(std::vector<Item>& items, size_t begin, size_t end, int parent)
{
    const int index = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    nodes_.back().parent = parent;
    if (end - begin == 1) {
        const Item& item = items[begin];
        nodes_.back().bounds = item.bounds;
        nodes_.back().power = item.power;
        nodes_.back().id = item.id;
        leaf_of_id_[static_cast<size_t>(item.id)] = index;
        return index;
    }
    Bounds3 centres;
    for (size_t i = begin; i < end; ++i) centres.extend(items[i].bounds.centre());
    const Vec3 extent = centres.extent();
    int axis = extent.y > extent.x ? 1 : 0;
    if (extent.z > extent[axis]) axis = 2;
    const size_t middle = begin + (end - begin) / 2;
    const auto at = [&](size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [axis](const Item& a, const Item& b) {
        const float ca = a.bounds.centre()[axis];
        const float cb = b.bounds.centre()[axis];
        return ca != cb ? ca < cb : a.id < b.id;
    });
    const int left = build(items, begin, middle, index);
    const int right = build(items, middle, end, index);
    Node& node = nodes_[static_cast<size_t>(index)];
    const Node& left_node = nodes_[static_cast<size_t>(left)];
    const Node& right_node = nodes_[static_cast<size_t>(right)];
    node.right = right;
    node.bounds = left_node.bounds;
    node.bounds.extend(right_node.bounds);
    node.power = left_node.power + right_node.power;
    return index;
}

double LightTree::left_probability(const Node& node, size_t index, Vec3 x) const
{
    const Node& left = nodes_[index + 1];
    const Node& right = nodes_[static_cast<size_t>(node.right)];
    // Power over squared distance, multiplied out so that a light at x itself is no special case.
    const double l = static_cast<double>(left.power) * effective_distance2(right.bounds, x);
    const double r = static_cast<double>(right.power) * effective_distance2(left.bounds, x);
    // The floor bounds the weight of lights that turn out to matter more than they seem to, behind
    // a thick cloud for example.
    constexpr double floor = 1e-5;
    return l + r > 0.0 ? std::clamp(l / (l + r), floor, 1.0 - floor) : 0.5;
}

LightTree::Choice LightTree::sample(Vec3 x, Rng& rng) const
{
    MOTE_ASSERT(!is_empty());
    size_t index = 0;
    double pmf = 1.0;
    while (nodes_[index].id < 0) {
        const Node& node = nodes_[index];
        const double left = left_probability(node, index, x);
        if (uniform_double(rng) < left) {
            pmf *= left;
            ++index;
        } else {
            pmf *= 1.0 - left;
            index = static_cast<size_t>(node.right);
        }
    }
    return {nodes_[index].id, static_cast<float>(pmf)};
}

float LightTree::pmf(int id, Vec3 x) const
{
    if (id < 0 || static_cast<size_t>(id) >= leaf_of_id_.size()) return 0.0f;
    int child = leaf_of_id_[static_cast<size_t>(id)];
    if (child < 0) return 0.0f;
    double pmf = 1.0;
    for (int parent = nodes_[static_cast<size_t>(child)].parent; parent >= 0;) {
        const Node& node = nodes_[static_cast<size_t>(parent)];
        const double left = left_probability(node, static_cast<size_t>(parent), x);
        pmf *= child == node.right ? 1.0 - left : left;
        child = parent;
        parent = node.parent;
    }
    return static_cast<float>(pmf);
}

double LightTree::importance(Vec3 x) const
{
    if (is_empty()) return 0.0;
    return static_cast<double>(nodes_[0].power) /
           std::max(effective_distance2(nodes_[0].bounds, x), 1e-60);
}

}  // namespace mote
