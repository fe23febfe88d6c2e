#include "restir/light_cells.h"

#include <algorithm>

#include "restir/light_cut.h"

namespace mote {
namespace {

/// Index of the first value above u; the last one is 1, so there always is one.
uint32_t first_above(const float* cdf, uint32_t count, double u)
{
    const float* found = std::upper_bound(
        cdf, cdf + count - 1, u, [](double a, float b) { return a < static_cast<double>(b); });
    return static_cast<uint32_t>(found - cdf);
}

constexpr float whole = 1.0f;
constexpr int everywhere_nodes[1] = {0};

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
                    cut.count, cell.sigma_t};
        }
    }
    return {&whole, everywhere_nodes, everything_, 1, 0.0f};
}

double LightCells::left_share(const LightCluster& node, int index, Vec3 x, float sigma_t) const
{
    const LightCluster& left = clusters_.nodes[static_cast<size_t>(index) + 1];
    const LightCluster& right = clusters_.nodes[static_cast<size_t>(node.right)];
    const float blur2 = sqr(0.125f * lattice_.cell);
    const float nearer = glm::length(x - right.centre) - glm::length(x - left.centre);
    const float fade = std::exp(std::clamp(0.0f * nearer, -10.0f, 10.0f));
    const float a = std::min(cluster_fluence(left, x, blur2) * fade, 1e37f);
    const float b = std::min(cluster_fluence(right, x, blur2), 1e37f);
    const float known = a + b > 0.0f ? a / (a + b) : 0.5f;
    const float by_count =
        static_cast<float>(left.end - left.begin) / static_cast<float>(node.end - node.begin);
    return static_cast<double>(0.98f * known + 0.02f * by_count);
}

LightPick LightCells::sample(Vec3 x, double u) const
{
    if (clusters_.ids.empty()) return {};
    if (clusters_.ids.size() == 1) return {clusters_.ids[0], 1.0f};
    const Row row = row_at(x);
    const uint32_t i = first_above(row.cdf, row.count, u);
    const float lo = i > 0 ? row.cdf[i - 1] : 0.0f;
    double pmf = static_cast<double>(row.cdf[i] - lo);
    double rest = (u - static_cast<double>(lo)) / pmf;
    // What is left of u goes down the tree from here.
    int index = row.nodes[i];
    const LightCluster* node = &clusters_.nodes[static_cast<size_t>(index)];
    while (!node->is_leaf()) {
        const double left = left_share(*node, index, x, row.sigma_t);
        const bool goes_left = rest < left;
        rest = goes_left ? rest / left : (rest - left) / (1.0 - left);
        pmf *= goes_left ? left : 1.0 - left;
        index = goes_left ? index + 1 : node->right;
        node = &clusters_.nodes[static_cast<size_t>(index)];
    }
    size_t place = static_cast<size_t>(node->begin);
    if (node->end - node->begin > 1) {
        const double* sums = clusters_.share_sum.data();
        const double inside = sums[node->end] - sums[node->begin];
        const double goal = sums[node->begin] + rest * inside;
        const double* found = std::upper_bound(sums + node->begin + 1, sums + node->end, goal);
        place = static_cast<size_t>(found - sums - 1);
        pmf *= (sums[place + 1] - sums[place]) / inside;
    }
    return {clusters_.ids[place], static_cast<float>(pmf)};
}

float LightCells::pmf(int light, Vec3 x) const
{
    const int place = clusters_.place(light);
    if (place < 0) return 0.0f;
    if (clusters_.ids.size() == 1) return 1.0f;
    const Row row = row_at(x);
    const int* found = std::upper_bound(row.begins + 1, row.begins + row.count, place);
    const auto i = static_cast<size_t>(found - row.begins - 1);
    double pmf = static_cast<double>(row.cdf[i] - (i > 0 ? row.cdf[i - 1] : 0.0f));
    int index = row.nodes[i];
    const LightCluster* node = &clusters_.nodes[static_cast<size_t>(index)];
    while (!node->is_leaf()) {
        const double left = left_share(*node, index, x, row.sigma_t);
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
    return std::max(v0 + f.z * (v1 - v0), least_inscatter_);
}

size_t LightCells::memory_bytes() const
{
    const auto bytes = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
    return bytes(clusters_.nodes) + bytes(clusters_.ids) + bytes(clusters_.place_of_id) +
           bytes(clusters_.share_sum) + bytes(cell_at_) + bytes(inscatter_) + bytes(cells_) +
           bytes(cuts_) + bytes(nodes_) + bytes(begins_) + bytes(fluence_) + bytes(cdf_) +
           bytes(scattered_);
}

}  // namespace mote
