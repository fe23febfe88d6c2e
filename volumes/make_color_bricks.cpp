#include <cmath>

#include <fmt/core.h>

#include "core/error.h"
#include "core/text.h"
#include "volumes/brick_builder.h"
#include "volumes/make_bricks.h"

namespace mote {
namespace {

using Tree = openvdb::Vec3STree;
/// Accessors that are not registered with the tree: cheap to make, the tree does not change.
using Accessor = openvdb::tree::ValueAccessor<const Tree, false>;

float finite_or_zero(float v)
{
    return std::isfinite(v) ? v : 0.0f;
}

/// One channel at a voxel: its value if active, else the mean of its active neighbours, else 0.
float extended_value(Accessor& accessor, const openvdb::Coord& c, int channel)
{
    openvdb::Vec3s value;
    if (accessor.probeValue(c, value)) return finite_or_zero(value[channel]);
    float sum = 0.0f;
    int count = 0;
    for (int n = 0; n < 27; ++n) {
        if (!accessor.probeValue(c.offsetBy(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1), value)) continue;
        sum += finite_or_zero(value[channel]);
        ++count;
    }
    return count > 0 ? sum / static_cast<float>(count) : 0.0f;
}

/// Marks every brick that an active box of voxels, grown by one voxel, touches.
void mark_box(BlockTable& blocks, const openvdb::CoordBBox& box)
{
    const auto block = [&](const openvdb::Coord& c, int offset) {
        return (Vec3i(c.x(), c.y(), c.z()) + offset - blocks.lo) / 8;
    };
    const Vec3i first = block(box.min(), -2);  // one voxel of growth, one of reconstruction
    const Vec3i last = block(box.max(), 1);
    for (int z = first.z; z <= last.z; ++z) {
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) blocks.needed[blocks.index(x, y, z)] = 1;
        }
    }
}

int64_t count_non_finite(const openvdb::Vec3s& v)
{
    int64_t count = 0;
    for (int i = 0; i < 3; ++i) count += std::isfinite(v[i]) ? 0 : 1;
    return count;
}

}  // namespace

std::shared_ptr<const ColorGrid> make_color_bricks(const openvdb::Vec3SGrid& grid,
                                                   const GridBudget& budget, GridLoadReport& report)
{
    const std::string what = fmt::format("grid \"{}\"", printable(grid.getName()));
    const Affine index_from_object = to_affine(glm::inverse(object_from_index(grid)));
    std::vector<openvdb::CoordBBox> boxes;
    openvdb::CoordBBox all;
    double voxels = 0.0;
    const auto add_box = [&](const openvdb::CoordBBox& box) {
        voxels += static_cast<double>(box.volume());
        if (voxels > static_cast<double>(budget.max_voxels)) {
            throw Error(ExitCode::Memory, fmt::format("{}: more than {:.3g} active voxels", what,
                                                      static_cast<double>(budget.max_voxels)));
        }
        boxes.push_back(box);
        all.expand(box);
    };
    auto tile = grid.tree().cbeginValueOn();
    tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        add_box(tile.getBoundingBox());
        report.non_finite += count_non_finite(tile.getValue());
    }
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        openvdb::CoordBBox box;
        leaf->evalActiveBoundingBox(box);
        if (box.empty()) continue;
        add_box(box);
        for (auto v = leaf->cbeginValueOn(); v; ++v) report.non_finite += count_non_finite(*v);
    }
    auto out = std::make_shared<ColorGrid>();
    if (!all.empty()) {
        constexpr int limit = 1 << 30;
        const openvdb::Coord lo = all.min();
        const openvdb::Coord hi = all.max();
        if (std::min({lo.x(), lo.y(), lo.z()}) < -limit ||
            std::max({hi.x(), hi.y(), hi.z()}) > limit) {
            throw Error(ExitCode::Input, what + ": voxels lie beyond index +-2^30");
        }
        BlockTable blocks =
            BlockTable::covering({lo.x() - 1, lo.y() - 1, lo.z() - 1},
                                 {hi.x() + 1, hi.y() + 1, hi.z() + 1}, budget, what);
        for (const openvdb::CoordBBox& box : boxes) mark_box(blocks, box);
        // Never shared: the three channels must get the same brick numbers.
        blocks.uniform.assign(blocks.uniform.size(), BlockTable::varied);
        GridBudget third = budget;
        third.max_brick_bytes /= 3;
        for (int channel = 0; channel < 3; ++channel) {
            const FillBrick fill = [&grid, channel](Vec3i origin, float* values) {
                Accessor accessor(grid.tree());
                const openvdb::Coord first(origin.x, origin.y, origin.z);
                for (int i = 0; i < 729; ++i) {
                    const openvdb::Coord c = first.offsetBy(i / 81, i / 9 % 9, i % 9);
                    values[i] = extended_value(accessor, c, channel);
                }
            };
            out->channel[channel] = build_bricks(blocks, fill, third, what);
        }
    }
    for (BrickGrid& channel : out->channel) channel.index_from_object = index_from_object;
    return out;
}

}  // namespace mote
