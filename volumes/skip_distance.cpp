#include "volumes/skip_distance.h"

#include "core/parallel.h"

namespace mote {
namespace {

constexpr int furthest = 16;

/// One axis of the chessboard distance transform: out[i] = min over j of max(|i-j|, in[j]).
/// Values reach at most `furthest`, so each entry looks at a bounded neighbourhood; the search
/// stops as soon as no further neighbour can be nearer.
void sweep_line(const int32_t* in, int32_t* out, size_t stride, int count)
{
    int32_t nearest = furthest;
    for (int i = 0; i < count; ++i) {
        nearest = std::min(nearest, in[static_cast<size_t>(i) * stride]);
    }
    if (nearest == furthest) {  // most lines of a large sparse table
        for (int i = 0; i < count; ++i) out[static_cast<size_t>(i) * stride] = furthest;
        return;
    }
    for (int i = 0; i < count; ++i) {
        int32_t best = std::min(in[static_cast<size_t>(i) * stride], furthest);
        for (int d = 1; d < best; ++d) {
            if (i - d >= 0) {
                best = std::min(best, std::max(d, in[static_cast<size_t>(i - d) * stride]));
            }
            if (i + d < count) {
                best = std::min(best, std::max(d, in[static_cast<size_t>(i + d) * stride]));
            }
        }
        out[static_cast<size_t>(i) * stride] = best;
    }
}

}  // namespace

void set_skip_distances(BrickGrid& grid)
{
    const Vec3i n = grid.brick_count;
    std::vector<int32_t> distance(grid.table.size());
    for (size_t i = 0; i < distance.size(); ++i) distance[i] = grid.table[i] > 0 ? 0 : furthest;
    std::vector<int32_t> swept(distance.size());
    const size_t strides[3] = {1, static_cast<size_t>(n.x),
                               static_cast<size_t>(n.x) * static_cast<size_t>(n.y)};
    for (int axis = 0; axis < 3; ++axis) {
        const int u = axis == 0 ? 1 : 0;
        const int v = axis == 2 ? 1 : 2;
        const size_t lines = static_cast<size_t>(n[u]) * static_cast<size_t>(n[v]);
        parallel_for(lines, 256, [&](size_t begin, size_t end) {
            for (size_t line = begin; line != end; ++line) {
                const size_t start = line % static_cast<size_t>(n[u]) * strides[u] +
                                     line / static_cast<size_t>(n[u]) * strides[v];
                sweep_line(distance.data() + start, swept.data() + start, strides[axis], n[axis]);
            }
        });
        distance.swap(swept);
    }
    for (size_t i = 0; i < distance.size(); ++i) {
        if (grid.table[i] <= 0) grid.table[i] = -distance[i];
    }
}

}  // namespace mote
