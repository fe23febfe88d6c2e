#include "restir/light_cells.h"

#include <algorithm>

namespace mote {
namespace {

/// Probabilities of a cell's entries are whole multiples of this.
constexpr double quantum = 1.0 / 65536.0;

/// How many of the first count - 1 values of an ascending row are not above x. Vectors count all of
/// them before a search by halving has recovered from its first mispredicted branch.
template <class T>
uint32_t count_up_to(const T* row, uint32_t count, T x)
{
    T n = 0;
    for (uint32_t i = 0; i + 1 < count; ++i) n = static_cast<T>(n + (row[i] <= x ? 1 : 0));
    return static_cast<uint32_t>(n);
}

/// Start and length of an entry's interval of [0, 65536).
struct Share {
    double lo, size;
};

Share share_of(const uint16_t* cdf, uint32_t count, uint32_t i)
{
    const int lo = i > 0 ? cdf[i - 1] : 0;
    const int hi = i + 1 < count ? cdf[i] : 65536;
    return {static_cast<double>(lo), static_cast<double>(hi - lo)};
}

/// Choices that go down the tree together.
constexpr size_t side_by_side = 16;

constexpr uint16_t whole = 65535;
constexpr int everywhere_nodes[1] = {0};

/// Squared distance at which a cluster counts as seen from x.
float effective_distance2(const LightCluster& cluster, Vec3 x, float least2)
{
    const Vec3 to_x = x - cluster.centre;
    return std::max(glm::dot(to_x, to_x), std::max(0.5f * cluster.spread2, least2));
}

/// How much more a cluster shines towards x than to all sides on average, as in eval_fluence.
float towards(const LightCluster& cluster, Vec3 x, float distance2)
{
    if (cluster.facing == Vec3(0.0f)) return 1.0f;
    const float cos_theta = glm::dot(cluster.facing, x - cluster.centre) / std::sqrt(distance2);
    return std::max(0.05f, 1.0f + 2.0f * cos_theta);
}

}  // namespace

LightCells::Row LightCells::row_at(Vec3 x) const
{
    const Vec3 p = lattice_.to_lattice(x);
    if (lattice_.contains(p)) {
        const int32_t i = cell_at_[lattice_.index(Vec3i(p))];
        if (i >= 0) {
            const Cell& cell = cells_[static_cast<size_t>(i)];
            const Cut& cut = cuts_[cell.cut];
            return {cdf_.data() + cell.entry, nodes_.data() + cut.first, begins_.data() + cut.first,
                    cut.count};
        }
    }
    return {&whole, everywhere_nodes, everything_, 1};
}

double LightCells::left_share(const LightCluster& node, int index, Vec3 x) const
{
    const LightCluster& left = clusters_.nodes[static_cast<size_t>(index) + 1];
    const LightCluster& right = clusters_.nodes[static_cast<size_t>(node.right)];
    const float least2 = sqr(0.125f * lattice_.cell);
    const float left2 = effective_distance2(left, x, least2);
    const float right2 = effective_distance2(right, x, least2);
    // Powers over squared distances, on their common denominator.
    const float a = left.power * right2 * towards(left, x, left2);
    const float b = right.power * left2 * towards(right, x, right2);
    const float known = a + b > 0.0f && a + b < infinity ? a / (a + b) : 0.5f;
    return static_cast<double>(0.98f * known + 0.01f);  // both sides have as many lights
}

LightCells::Descent LightCells::enter(const Row& row, double u)
{
    const double scaled = 65536.0 * u;
    const uint32_t i = count_up_to(row.cdf, row.count, static_cast<uint16_t>(scaled));
    const Share share = share_of(row.cdf, row.count, i);
    return {row.nodes[i], (scaled - share.lo) / share.size, share.size * quantum};
}

void LightCells::step(const LightCluster& node, Vec3 x, Descent& d) const
{
    const double left = left_share(node, d.index, x);
    const bool goes_left = d.rest < left;
    // Without branches: which way it goes cannot be foretold.
    const double share = goes_left ? left : 1.0 - left;
    d.rest = (d.rest - (goes_left ? 0.0 : left)) / share;
    d.pmf *= share;
    d.index = goes_left ? d.index + 1 : node.right;
}

LightPick LightCells::pick_within(const LightCluster& leaf, const Descent& d) const
{
    auto place = static_cast<size_t>(leaf.begin);
    double pmf = d.pmf;
    if (leaf.end - leaf.begin > 1) {
        const double* sums = clusters_.share_sum.data();
        const double inside = sums[leaf.end] - sums[leaf.begin];
        const double goal = sums[leaf.begin] + d.rest * inside;
        const double* found = std::upper_bound(sums + leaf.begin + 1, sums + leaf.end, goal);
        place = static_cast<size_t>(found - sums - 1);
        pmf *= (sums[place + 1] - sums[place]) / inside;
    }
    return {static_cast<int>(place), static_cast<float>(pmf)};
}

void LightCells::sample(Vec3 x, std::span<const double> u, std::span<LightPick> out) const
{
    if (clusters_.ids.size() < 2) {
        const bool is_alone = clusters_.ids.size() == 1;
        std::fill(out.begin(), out.end(),
                  is_alone ? LightPick{clusters_.ids[0], 1.0f} : LightPick{});
        return;
    }
    const LightCluster* nodes = clusters_.nodes.data();
    const Row row = row_at(x);
    for (size_t count = 0; !out.empty(); u = u.subspan(count), out = out.subspan(count)) {
        count = std::min(side_by_side, out.size());
        Descent descents[side_by_side];
        for (size_t i = 0; i < count; ++i) descents[i] = enter(row, u[i]);
        // All a step each, so that the next nodes are on their way from memory meanwhile.
        for (bool goes_on = true; goes_on;) {
            goes_on = false;
            for (size_t i = 0; i < count; ++i) {
                Descent& d = descents[i];
                const LightCluster& node = nodes[d.index];
                if (node.is_leaf()) continue;
                goes_on = true;
                step(node, x, d);
                const LightCluster& next = nodes[d.index];
                __builtin_prefetch(&next + 1);
                if (!next.is_leaf()) __builtin_prefetch(nodes + next.right);
            }
        }
        const double* sums = clusters_.share_sum.data();
        constexpr int per_line = 64 / sizeof(double);
        for (size_t i = 0; i < count; ++i) {
            const LightCluster& leaf = nodes[descents[i].index];
            for (int k = leaf.begin; k <= leaf.end; k += per_line) __builtin_prefetch(sums + k);
        }
        for (size_t i = 0; i < count; ++i) {
            out[i] = pick_within(nodes[descents[i].index], descents[i]);
            __builtin_prefetch(clusters_.ids.data() + out[i].light);
        }
        for (size_t i = 0; i < count; ++i) {
            out[i].light = clusters_.ids[static_cast<size_t>(out[i].light)];
        }
    }
}

LightPick LightCells::sample(Vec3 x, double u) const
{
    LightPick pick;
    sample(x, {&u, 1}, {&pick, 1});
    return pick;
}

float LightCells::pmf(int light, Vec3 x) const
{
    const int place = clusters_.place(light);
    if (place < 0) return 0.0f;
    if (clusters_.ids.size() == 1) return 1.0f;
    const Row row = row_at(x);
    const uint32_t i = count_up_to(row.begins + 1, row.count, place);
    double pmf = share_of(row.cdf, row.count, i).size * quantum;
    int index = row.nodes[i];
    const LightCluster* node = &clusters_.nodes[static_cast<size_t>(index)];
    while (!node->is_leaf()) {
        const double left = left_share(*node, index, x);
        const bool goes_left = place < clusters_.nodes[static_cast<size_t>(node->right)].begin;
        pmf *= goes_left ? left : 1.0 - left;
        index = goes_left ? index + 1 : node->right;
        node = &clusters_.nodes[static_cast<size_t>(index)];
    }
    if (node->end - node->begin > 1) {
        const double* sums = clusters_.share_sum.data();
        pmf *= (sums[place + 1] - sums[place]) / (sums[node->end] - sums[node->begin]);
    }
    return static_cast<float>(pmf);
}

float LightCells::inscatter(Vec3 x) const
{
    if (clusters_.ids.empty()) return 0.0f;
    const Vec3 p = lattice_.to_lattice(x) - 0.5f;
    const Vec3 last(lattice_.count - 1);
    if (!(p.x >= 0.0f && p.y >= 0.0f && p.z >= 0.0f && p.x < last.x && p.y < last.y &&
          p.z < last.z))
        return least_inscatter_;
    const Vec3i c(p);
    const Vec3 f = p - Vec3(c);
    const auto row = static_cast<size_t>(lattice_.count.x);
    const size_t slice = row * static_cast<size_t>(lattice_.count.y);
    const float* v = inscatter_.data() + lattice_.index(c);
    const float v00 = v[0] + f.x * (v[1] - v[0]);
    const float v10 = v[row] + f.x * (v[row + 1] - v[row]);
    const float v01 = v[slice] + f.x * (v[slice + 1] - v[slice]);
    const float v11 = v[slice + row] + f.x * (v[slice + row + 1] - v[slice + row]);
    const float v0 = v00 + f.y * (v10 - v00);
    const float v1 = v01 + f.y * (v11 - v01);
    return v0 + f.z * (v1 - v0);
}

size_t LightCells::memory_bytes() const
{
    const auto bytes = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
    return bytes(clusters_.nodes) + bytes(clusters_.bounds) + bytes(clusters_.ids) +
           bytes(clusters_.place_of_id) + bytes(clusters_.share_sum) + bytes(cell_at_) +
           bytes(inscatter_) + bytes(cells_) + bytes(cuts_) + bytes(nodes_) + bytes(begins_) +
           bytes(fluence_) + bytes(cdf_) + bytes(scattered_);
}

}  // namespace mote
