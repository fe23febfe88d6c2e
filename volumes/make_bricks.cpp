#include "volumes/make_bricks.h"

#include <cmath>

#include <fmt/core.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "volumes/brick_builder.h"

namespace mote {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

std::string describe(const openvdb::GridBase& grid)
{
    return fmt::format("grid \"{}\"", printable(grid.getName()));
}

/// One value made safe: the third-party file decides nothing beyond this point.
float sanitize(float v, GridLoadReport& report)
{
    if (!std::isfinite(v)) {
        ++report.non_finite;
        return 0.0f;
    }
    if (v < 0.0f) {
        ++report.negative;
        return 0.0f;
    }
    return v;
}

float sanitized(float v)
{
    return v >= 0.0f && v <= std::numeric_limits<float>::max() ? v : 0.0f;
}

/// Active bits of the eight voxels of row x * 8 + y of a leaf.
unsigned active_row(const Leaf& leaf, openvdb::Index row)
{
    return leaf.getValueMask().getWord<uint8_t>(row);
}

struct LeafScan {
    unsigned faces = 0;  ///< as BlockTable::mark wants them
    float uniform = 0.0f;
    double sum = 0.0;
    GridLoadReport report;
};

LeafScan scan(const Leaf& leaf)
{
    LeafScan out;
    const float* data = leaf.buffer().data();
    const float first = leaf.isValueOn(0) ? sanitized(data[0]) : 0.0f;
    bool is_uniform = true;
    for (openvdb::Index row = 0; row < 64; ++row) {
        const unsigned active = active_row(leaf, row);
        bool any = false;
        bool low = false;  // the voxel with z = 0
        for (openvdb::Index z = 0; z < 8; ++z) {
            const bool on = (active >> z & 1u) != 0u;
            const float v = on ? sanitize(data[row * 8 + z], out.report) : 0.0f;
            is_uniform = is_uniform && v == first;
            out.sum += static_cast<double>(v);
            any = any || v != 0.0f;
            low = low || (z == 0 && v != 0.0f);
        }
        // Which lower neighbours the row reaches: every subset of its zero coordinates.
        unsigned faces = any ? 1u : 0u;
        if (low) faces |= 1u << 4;
        if (row % 8 == 0) faces |= faces << 2;
        if (row / 8 == 0) faces |= faces << 1;
        out.faces |= faces;
    }
    out.uniform = is_uniform ? first : BlockTable::varied;
    return out;
}

struct Tile {
    openvdb::CoordBBox box;
    float value;
};

void add(GridLoadReport& to, const GridLoadReport& from, int64_t times = 1)
{
    to.non_finite += from.non_finite * times;
    to.negative += from.negative * times;
}

void check_voxels(const openvdb::GridBase& grid, double voxels, const GridBudget& budget)
{
    if (voxels <= static_cast<double>(budget.max_voxels)) return;
    throw Error(ExitCode::Memory,
                fmt::format("{}: {:.3g} active voxels but the limit is {:.3g}", describe(grid),
                            voxels, static_cast<double>(budget.max_voxels)));
}

/// Range of the voxels that count; throws where index arithmetic could overflow.
openvdb::CoordBBox checked_bounds(const openvdb::GridBase& grid, const openvdb::CoordBBox& box)
{
    constexpr int limit = 1 << 30;
    const openvdb::Coord lo = box.min();
    const openvdb::Coord hi = box.max();
    if (lo.x() < -limit || lo.y() < -limit || lo.z() < -limit || hi.x() > limit || hi.y() > limit ||
        hi.z() > limit) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: voxels lie beyond index +-2^30; the file is damaged or needs "
                                "its origin moved",
                                describe(grid)));
    }
    return box;
}

void check_class(const openvdb::GridBase& grid)
{
    if (grid.getGridClass() != openvdb::GRID_LEVEL_SET) return;
    throw Error(ExitCode::Input,
                fmt::format("{} is a level set (signed distances), not a fog volume; convert it "
                            "first, e.g. with \"Convert VDB\" to fog or vdb_tool -sdf2fog",
                            describe(grid)));
}

Vec3i to_vec(const openvdb::Coord& c)
{
    return {c.x(), c.y(), c.z()};
}

/// The nodes of a float tree that hold anything, sanitised once.
struct Survey {
    std::vector<const Leaf*> leaves;
    std::vector<LeafScan> scans;
    std::vector<Tile> tiles;
    openvdb::CoordBBox box;
    double sum = 0.0;
};

Survey survey(const openvdb::FloatGrid& grid, const GridBudget& budget, GridLoadReport& report)
{
    Survey out;
    double voxels = 0.0;
    auto tile = grid.tree().cbeginValueOn();
    tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const openvdb::CoordBBox box = tile.getBoundingBox();
        const double volume = static_cast<double>(box.volume());
        voxels += volume;
        check_voxels(grid, voxels, budget);
        GridLoadReport one;
        const float value = sanitize(tile.getValue(), one);
        add(report, one, static_cast<int64_t>(volume));
        if (value == 0.0f) continue;
        out.tiles.push_back({box, value});
        out.box.expand(box);
        out.sum += static_cast<double>(value) * volume;
    }
    grid.tree().getNodes(out.leaves);
    check_voxels(grid, voxels + 512.0 * static_cast<double>(out.leaves.size()), budget);
    out.scans.resize(out.leaves.size());
    parallel_for(out.leaves.size(), 64, [&](size_t begin, size_t end) {
        for (size_t i = begin; i != end; ++i) out.scans[i] = scan(*out.leaves[i]);
    });
    for (size_t i = 0; i < out.leaves.size(); ++i) {
        add(report, out.scans[i].report);
        out.sum += out.scans[i].sum;
        if (out.scans[i].faces != 0u) out.box.expand(out.leaves[i]->getNodeBoundingBox());
    }
    return out;
}

BlockTable block_table(const openvdb::FloatGrid& grid, const Survey& found,
                       const GridBudget& budget)
{
    const openvdb::CoordBBox box = checked_bounds(grid, found.box);
    BlockTable blocks =
        BlockTable::covering(to_vec(box.min()), to_vec(box.max()), budget, describe(grid));
    for (const Tile& tile : found.tiles) {
        const Vec3i first = (to_vec(tile.box.min()) - blocks.lo) / 8;
        const Vec3i last = (to_vec(tile.box.max()) - blocks.lo) / 8;
        for (int z = first.z - 1; z <= last.z; ++z) {
            for (int y = first.y - 1; y <= last.y; ++y) {
                for (int x = first.x - 1; x <= last.x; ++x) {
                    const size_t i = blocks.index(x, y, z);
                    blocks.needed[i] = 1;
                    if (x >= first.x && y >= first.y && z >= first.z) {
                        blocks.uniform[i] = tile.value;
                    }
                }
            }
        }
    }
    for (size_t i = 0; i < found.leaves.size(); ++i) {
        if (found.scans[i].faces == 0u) continue;
        const Vec3i at = (to_vec(found.leaves[i]->origin()) - blocks.lo) / 8;
        blocks.mark(at.x, at.y, at.z, found.scans[i].faces);
        blocks.uniform[blocks.index(at.x, at.y, at.z)] = found.scans[i].uniform;
    }
    return blocks;
}

/// Copies the part of one 8^3 node that a brick needs: everything, or only the low faces when the
/// node is one of the seven above.
void copy_node(const openvdb::FloatTree& tree, const openvdb::Coord& origin, Vec3i count,
               float* out)
{
    constexpr int y_step = BrickGrid::brick_stride;
    constexpr int x_step = y_step * y_step;
    const Leaf* leaf = tree.probeConstLeaf(origin);
    float value = 0.0f;
    if (!leaf && !tree.probeValue(origin, value)) value = 0.0f;
    value = sanitized(value);
    for (int x = 0; x < count.x; ++x) {
        for (int y = 0; y < count.y; ++y) {
            float* row = out + static_cast<ptrdiff_t>(x * x_step + y * y_step);
            if (!leaf) {
                std::fill_n(row, count.z, value);
                continue;
            }
            const auto row_number = static_cast<openvdb::Index>(x * 8 + y);
            const unsigned active = active_row(*leaf, row_number);
            const float* data = leaf->buffer().data() + size_t{8} * row_number;
            for (int z = 0; z < count.z; ++z) {
                row[z] = (active >> z & 1u) != 0u ? sanitized(data[z]) : 0.0f;
            }
        }
    }
}

}  // namespace

Mat4d object_from_index(const openvdb::GridBase& grid)
{
    if (!grid.transform().isLinear()) {
        throw Error(ExitCode::Input,
                    fmt::format("{} has a frustum transform; resample it into a linear grid first",
                                describe(grid)));
    }
    const auto map = grid.transform().baseMap()->getAffineMap();
    const openvdb::Mat4d m = map->getMat4();  // for row vectors, so rows are glm's columns
    Mat4d out(1.0);
    bool finite = true;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            out[i][j] = m(i, j);
            finite = finite && std::isfinite(m(i, j)) && std::abs(m(i, j)) < 1e15;
        }
    }
    const double volume = finite ? std::abs(glm::determinant(glm::dmat3(out))) : 0.0;
    if (!(volume > 1e-30)) {
        throw Error(ExitCode::Input,
                    fmt::format("{} has a degenerate transform (voxel volume {:.3g}); the file is "
                                "damaged",
                                describe(grid), volume));
    }
    return out;
}

std::shared_ptr<const BrickGrid> make_bricks(const openvdb::FloatGrid& grid,
                                             const GridBudget& budget, GridLoadReport& report)
{
    check_class(grid);
    const Affine index_from_object = to_affine(glm::inverse(object_from_index(grid)));
    const Survey found = survey(grid, budget, report);
    auto out = std::make_shared<BrickGrid>();
    if (!found.box.empty()) {
        const openvdb::FloatTree& tree = grid.tree();
        const FillBrick fill = [&tree](Vec3i origin, float* values) {
            for (int n = 0; n < 8; ++n) {
                const Vec3i d(n & 1, n >> 1 & 1, n >> 2 & 1);
                const openvdb::Coord node(origin.x + 8 * d.x, origin.y + 8 * d.y,
                                          origin.z + 8 * d.z);
                const Vec3i count = Vec3i(8) - 7 * d;
                copy_node(tree, node, count, values + ptrdiff_t{8} * (d.x * 81 + d.y * 9 + d.z));
            }
        };
        *out = build_bricks(block_table(grid, found, budget), fill, budget, describe(grid));
    }
    out->index_from_object = index_from_object;
    out->sum = found.sum;
    return out;
}

}  // namespace mote
