#include "restir/smoke_lattice.h"

#include "volumes/media_extent.h"

namespace mote {
namespace {

/// World-space boxes around all stored bricks.
std::vector<Bounds3> brick_boxes(const Media& media)
{
    std::vector<Bounds3> boxes;
    for (const Volume& volume : media.volumes) {
        if (is_void(volume)) continue;
        const BrickGrid& grid = *volume.density;
        const Bounds3 used = local_bounds(grid);
        std::vector<float> times = {cache_time};
        if (volume.world_from_object.is_moving()) times = {0.0f, cache_time, 1.0f};
        for (const float time : times) {
            const Mat4d m = world_from_local(volume, time);
            const glm::dmat3 linear(m);
            // Half extents of a transformed box: absolute values of the matrix.
            const glm::dmat3 reach(glm::abs(linear[0]), glm::abs(linear[1]), glm::abs(linear[2]));
            for (int z = 0; z < grid.brick_count.z; ++z) {
                for (int y = 0; y < grid.brick_count.y; ++y) {
                    for (int x = 0; x < grid.brick_count.x; ++x) {
                        if (grid.table[grid.table_index(x, y, z)] <= 0) continue;
                        const Vec3 lo(Vec3i(x, y, z) * BrickGrid::brick_size);
                        const Vec3 hi = lo + Vec3(BrickGrid::brick_size);
                        const Bounds3 local{glm::max(lo, used.lo), glm::min(hi, used.hi)};
                        if (local.is_empty()) continue;
                        const Vec3d centre = linear * Vec3d(local.centre()) + Vec3d(m[3]);
                        const Vec3d half = reach * Vec3d(0.5f * local.extent());
                        const Bounds3 box{Vec3(centre - half), Vec3(centre + half)};
                        if (is_finite(box.lo) && is_finite(box.hi)) boxes.push_back(box);
                    }
                }
            }
        }
    }
    return boxes;
}

/// False if this spacing takes more than the budget.
bool fill(SmokeLattice& lattice, const std::vector<Bounds3>& boxes, const Bounds3& bounds,
          int64_t budget)
{
    double total = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double cells = std::ceil(static_cast<double>(bounds.extent()[axis]) /
                                       static_cast<double>(lattice.spacing));
        total *= cells + 3.0;
        if (!(total <= 64.0 * static_cast<double>(budget))) return false;
        lattice.count[axis] = static_cast<int>(cells) + 3;
    }
    // One node to spare on either side, against rounding.
    lattice.origin = bounds.lo - Vec3(lattice.spacing);
    lattice.nodes.assign(1, Vec3i(0));
    lattice.slots.assign(static_cast<size_t>(total), 0);
    constexpr float margin = 1e-3f;  // of a spacing, against rounding
    for (const Bounds3& box : boxes) {
        const Vec3 p0 = (box.lo - lattice.origin) / lattice.spacing - Vec3(margin);
        const Vec3 p1 = (box.hi - lattice.origin) / lattice.spacing + Vec3(margin);
        const Vec3i lo = glm::clamp(Vec3i(glm::floor(p0)), Vec3i(0), lattice.count - 1);
        const Vec3i hi = glm::clamp(Vec3i(glm::ceil(p1)), Vec3i(0), lattice.count - 1);
        for (int z = lo.z; z <= hi.z; ++z) {
            for (int y = lo.y; y <= hi.y; ++y) {
                for (int x = lo.x; x <= hi.x; ++x) lattice.slots[lattice.index({x, y, z})] = 1;
            }
        }
    }
    // Numbered in the order of the lattice, so that neighbours in space are near in memory.
    for (int z = 0; z < lattice.count.z; ++z) {
        for (int y = 0; y < lattice.count.y; ++y) {
            for (int x = 0; x < lattice.count.x; ++x) {
                int32_t& slot = lattice.slots[lattice.index({x, y, z})];
                if (slot == 0) continue;
                if (lattice.active_count() >= budget) return false;
                slot = static_cast<int32_t>(lattice.nodes.size());
                lattice.nodes.emplace_back(x, y, z);
            }
        }
    }
    return true;
}

}  // namespace

SmokeLattice make_smoke_lattice(const Media& media, float spacing, int node_budget)
{
    const std::vector<Bounds3> boxes = brick_boxes(media);
    Bounds3 bounds;
    for (const Bounds3& box : boxes) bounds.extend(box);
    // A lattice of one cell has at most 64 nodes with those to spare.
    const int64_t budget = std::max(node_budget, 64);
    SmokeLattice lattice;
    if (boxes.empty() || !is_finite(bounds.extent()) || !(spacing > 0.0f)) return lattice;
    lattice.spacing = spacing;
    while (!fill(lattice, boxes, bounds, budget)) lattice.spacing *= 1.1f;
    return lattice;
}

}  // namespace mote
