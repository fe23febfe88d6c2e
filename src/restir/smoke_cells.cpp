#include "restir/smoke_cells.h"

#include <algorithm>
#include <cmath>

namespace mote {
namespace {

/// Empty positions of the table cost memory and time too, only less.
constexpr double most_positions_per_cell = 32.0;

Mat4d world_from_local(const Volume& volume, float time)
{
    const Affine local = object_from_local(volume);
    Mat4d m(glm::dmat3(local.linear));
    m[3] = glm::dvec4(Vec3d(local.offset), 1.0);
    return matrix(volume.world_from_object.at(time)) * m;
}

bool has_smoke(const Volume& volume)
{
    return volume.density && !volume.density->index_bounds.is_empty() &&
           volume.density_scale > 0.0f;
}

Bounds3 transformed(const Mat4d& m, Vec3 lo, Vec3 hi)
{
    Bounds3 out;
    for (int n = 0; n < 8; ++n) {
        const glm::dvec4 p(n & 1 ? hi.x : lo.x, n & 2 ? hi.y : lo.y, n & 4 ? hi.z : lo.z, 1.0);
        out.extend(Vec3(m * p));
    }
    return out;
}

/// Whether any of the 5^3 values around a half brick's cells is not 0.
bool half_brick_has_smoke(const BrickGrid& grid, int brick, Vec3i half)
{
    for (int x = 0; x <= 4; ++x) {
        for (int y = 0; y <= 4; ++y) {
            const float* row = grid.corner(brick, 4 * half.x + x, 4 * half.y + y, 4 * half.z);
            float sum = 0.0f;
            for (int z = 0; z <= 4; ++z) sum += row[z];
            if (sum > 0.0f) return true;
        }
    }
    return false;
}

/// Calls f(local corner, edge) for boxes of 4^3 voxels (8^3 if `coarse`) with smoke.
template <class F>
void for_each_smoke_box(const BrickGrid& grid, bool coarse, F&& f)
{
    for (int z = 0; z < grid.brick_count.z; ++z) {
        for (int y = 0; y < grid.brick_count.y; ++y) {
            for (int x = 0; x < grid.brick_count.x; ++x) {
                const int brick = grid.table[grid.table_index(x, y, z)];
                if (brick <= 0) continue;
                const BrickRange& range = grid.ranges[static_cast<size_t>(brick)];
                if (!(range.max > 0.0f)) continue;
                const Vec3 corner = 8.0f * Vec3(x, y, z);
                if (coarse || range.min > 0.0f) {
                    f(corner, 8.0f);
                    continue;
                }
                for (int n = 0; n < 8; ++n) {
                    const Vec3i half(n & 1, n >> 1 & 1, n >> 2);
                    if (half_brick_has_smoke(grid, brick, half))
                        f(corner + 4.0f * Vec3(half), 4.0f);
                }
            }
        }
    }
}

/// Size of a voxel's shortest edge in the world [m].
float voxel_size(const Volume& volume)
{
    const Mat4d m = world_from_local(volume, 0.5f);
    double size = glm::length(Vec3d(m[0]));
    for (int axis = 1; axis < 3; ++axis) size = std::min(size, glm::length(Vec3d(m[axis])));
    return static_cast<float>(size);
}

void mark_box(const Bounds3& box, SmokeCells& cells)
{
    const Lattice& lattice = cells.lattice;
    // A hair smaller: boxes that touch a cell's face from outside do not count.
    const Vec3 lo = lattice.to_lattice(box.lo) + 1e-3f;
    const Vec3 hi = lattice.to_lattice(box.hi) - 1e-3f;
    const Vec3i last = lattice.count - 2;
    const Vec3i first = glm::clamp(Vec3i(glm::floor(lo)), Vec3i(1), last);
    const Vec3i end = glm::clamp(Vec3i(glm::floor(hi)), Vec3i(1), last);
    for (int z = first.z; z <= end.z; ++z) {
        for (int y = first.y; y <= end.y; ++y) {
            for (int x = first.x; x <= end.x; ++x) {
                SmokeCells::Mark& mark = cells.marks[lattice.index({x, y, z})];
                cells.smoke_count += mark == SmokeCells::Smoke ? 0 : 1;
                mark = SmokeCells::Smoke;
            }
        }
    }
}

void mark_borders(SmokeCells& cells)
{
    const Lattice& lattice = cells.lattice;
    for (int z = 1; z + 1 < lattice.count.z; ++z) {
        for (int y = 1; y + 1 < lattice.count.y; ++y) {
            for (int x = 1; x + 1 < lattice.count.x; ++x) {
                if (cells.marks[lattice.index({x, y, z})] != SmokeCells::Smoke) continue;
                for (int n = 0; n < 27; ++n) {
                    const Vec3i c(x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1);
                    SmokeCells::Mark& mark = cells.marks[lattice.index(c)];
                    if (mark != SmokeCells::Empty) continue;
                    mark = SmokeCells::Border;
                    ++cells.border_count;
                }
            }
        }
    }
}

/// Lattice over `bounds` with a margin of one cell, whose planes go through `anchor`.
Lattice lattice_over(const Bounds3& bounds, Vec3 anchor, float cell)
{
    Lattice lattice;
    lattice.cell = cell;
    const Vec3 below = glm::ceil((anchor - bounds.lo) * (1.0f / cell) - 1e-3f) + 1.0f;
    lattice.lo = anchor - cell * below;
    lattice.count = Vec3i(glm::ceil((bounds.hi - lattice.lo) * (1.0f / cell) - 1e-3f)) + 1;
    return lattice;
}

void mark_cells(const Media& media, SmokeCells& cells)
{
    cells.marks.assign(cells.lattice.size(), SmokeCells::Empty);
    for (const Volume& volume : media.volumes) {
        if (!has_smoke(volume)) continue;
        const bool coarse = cells.lattice.cell > 6.0f * voxel_size(volume);
        const int instants = volume.world_from_object.is_moving() ? 5 : 1;
        for (int i = 0; i < instants; ++i) {
            const float time = instants > 1 ? 0.25f * static_cast<float>(i) : 0.5f;
            const Mat4d m = world_from_local(volume, time);
            for_each_smoke_box(*volume.density, coarse, [&](Vec3 corner, float edge) {
                mark_box(transformed(m, corner, corner + edge), cells);
            });
        }
    }
    mark_borders(cells);
}

}  // namespace

SmokeCells find_smoke_cells(const Media& media, float edge_voxels, size_t most_cells)
{
    Bounds3 bounds;
    const Volume* first = nullptr;
    float voxel = infinity;
    for (const Volume& volume : media.volumes) {
        if (!has_smoke(volume)) continue;
        if (!first) first = &volume;
        bounds.extend(world_bounds(volume));
        voxel = std::min(voxel, voxel_size(volume));
    }
    SmokeCells cells;
    if (!first || bounds.is_empty() || !is_finite(bounds.lo) || !is_finite(bounds.hi)) return cells;
    const Vec3d extent(bounds.extent());
    const double most = static_cast<double>(std::max<size_t>(most_cells, 64));
    double edge = static_cast<double>(edge_voxels) * static_cast<double>(voxel);
    edge = std::max(edge,
                    std::cbrt(extent.x * extent.y * extent.z / (most * most_positions_per_cell)));
    edge = std::max(edge, std::max(extent.x, std::max(extent.y, extent.z)) / 4096.0);
    const Vec3 anchor(world_from_local(*first, 0.5f)[3]);
    for (int round = 0;; ++round) {
        cells = {};
        cells.lattice = lattice_over(bounds, anchor, static_cast<float>(edge));
        mark_cells(media, cells);
        const double excess = static_cast<double>(cells.smoke_count + cells.border_count) / most;
        if (excess <= 1.0 || round == 4) return cells;
        edge *= std::cbrt(excess) * 1.02;
    }
}

}  // namespace mote
