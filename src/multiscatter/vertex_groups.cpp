#include "multiscatter/vertex_groups.h"

#include <algorithm>

namespace mote {
namespace {

void split(std::span<const PathVertex> vertices, size_t most, std::vector<int>& order,
           VertexGroup group, std::vector<VertexGroup>& groups)
{
    if (group.count == 0) return;
    if (group.count <= most) {
        groups.push_back(group);
        return;
    }
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(group.first);
    const auto last = first + static_cast<std::ptrdiff_t>(group.count);
    Vec3 lo(infinity);
    Vec3 hi(-infinity);
    for (auto i = first; i != last; ++i) {
        lo = glm::min(lo, vertices[static_cast<size_t>(*i)].x);
        hi = glm::max(hi, vertices[static_cast<size_t>(*i)].x);
    }
    const Vec3 size = hi - lo;
    int axis = size.x >= size.y ? 0 : 1;
    if (size.z > size[axis]) axis = 2;
    const size_t parts = (group.count + most - 1) / most;
    const size_t half = group.count * (parts / 2) / parts;
    // Ties go by index, so that the order is one and the same everywhere.
    std::nth_element(first, first + static_cast<std::ptrdiff_t>(half), last, [&](int a, int b) {
        const float xa = vertices[static_cast<size_t>(a)].x[axis];
        const float xb = vertices[static_cast<size_t>(b)].x[axis];
        return xa != xb ? xa < xb : a < b;
    });
    split(vertices, most, order, {group.first, half}, groups);
    split(vertices, most, order, {group.first + half, group.count - half}, groups);
}

}  // namespace

std::vector<VertexGroup> make_groups(std::span<const PathVertex> vertices, size_t most,
                                     std::vector<int>& order)
{
    std::vector<VertexGroup> groups;
    split(vertices, most, order, {0, order.size()}, groups);
    return groups;
}

}  // namespace mote
