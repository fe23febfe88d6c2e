// OpenVDB's point framework costs minutes of compile time: kept in a file of its own.
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointTransfer.h>
#include <openvdb/tools/Morphology.h>

#include "bench_rasterize.h"

namespace mote::bench {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatTree;
using openvdb::Vec3f;
using PointLeaf = openvdb::points::PointDataTree::LeafNodeType;

/// Gathers, for each leaf of the target, the kernels of the points around it.
class KernelTransfer : public openvdb::points::VolumeTransfer<FloatTree> {
  public:
    KernelTransfer(FloatTree& tree, float support)
        : openvdb::points::VolumeTransfer<FloatTree>(tree), support_(support)
    {
    }
    KernelTransfer(const KernelTransfer& other)
        : openvdb::points::VolumeTransfer<FloatTree>(other), support_(other.support_)
    {
    }
    [[nodiscard]] openvdb::Int32 range(const Coord&, size_t) const
    {
        return static_cast<openvdb::Int32>(std::ceil(support_));
    }
    bool startPointLeaf(const PointLeaf& leaf)
    {
        positions_ = std::make_unique<Positions>(leaf.constAttributeArray("P"));
        return true;
    }
    void rasterizePoint(const Coord& ijk, const openvdb::Index id, const CoordBBox& bounds)
    {
        const Vec3f p = ijk.asVec3s() + positions_->get(id);
        const auto lo = [&](float c) { return static_cast<int>(std::ceil(c - support_)); };
        const auto hi = [&](float c) { return static_cast<int>(std::floor(c + support_)); };
        CoordBBox box(Coord(lo(p[0]), lo(p[1]), lo(p[2])), Coord(hi(p[0]), hi(p[1]), hi(p[2])));
        box.intersect(bounds);
        const float falloff = 1.0f / (support_ * support_);
        float* out = this->buffer();
        for (int x = box.min()[0]; x <= box.max()[0]; ++x) {
            for (int y = box.min()[1]; y <= box.max()[1]; ++y) {
                const float dx = static_cast<float>(x) - p[0];
                const float dy = static_cast<float>(y) - p[1];
                const openvdb::Index row =
                    FloatTree::LeafNodeType::coordToOffset(Coord(x, y, 0)) & ~7u;
                for (int z = box.min()[2]; z <= box.max()[2]; ++z) {
                    const float dz = static_cast<float>(z) - p[2];
                    const float root =
                        std::max(0.0f, 1.0f - (dx * dx + dy * dy + dz * dz) * falloff);
                    out[row + static_cast<openvdb::Index>(z & 7)] += root * root;
                }
            }
        }
    }
    bool endPointLeaf(const PointLeaf&) { return true; }
    /// True ends the leaf; false would process it again, for ever.
    bool finalize(const Coord&, size_t) { return true; }

  private:
    using Positions = openvdb::points::AttributeHandle<Vec3f>;

    float support_;
    std::unique_ptr<Positions> positions_;
};

}  // namespace

size_t rasterize_with_openvdb(const std::vector<Vec3>& points, float support)
{
    namespace vdb_points = openvdb::points;
    static_assert(sizeof(Vec3f) == sizeof(Vec3));
    openvdb::initialize();
    std::vector<Vec3f> positions(points.size());
    for (size_t i = 0; i < points.size(); ++i) {
        positions[i] = Vec3f(points[i].x, points[i].y, points[i].z);
    }
    const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    const auto grid =
        vdb_points::createPointDataGrid<vdb_points::NullCodec, vdb_points::PointDataGrid>(
            positions, *transform);
    openvdb::MaskTree topology(grid->tree(), false, true, openvdb::TopologyCopy());
    openvdb::tools::dilateActiveValues(topology, static_cast<int>(std::ceil(support)),
                                       openvdb::tools::NN_FACE_EDGE_VERTEX,
                                       openvdb::tools::IGNORE_TILES);
    FloatTree density(topology, 0.0f, openvdb::TopologyCopy());
    KernelTransfer transfer(density, support);
    vdb_points::rasterize(*grid, transfer);
    return density.activeVoxelCount();
}

}  // namespace mote::bench
