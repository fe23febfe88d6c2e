// OpenVDB's point framework costs minutes of compile time: kept in a file of its own.
#include <openvdb/openvdb.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointTransfer.h>
#include <openvdb/tools/Morphology.h>

#include "bench_rasterize.h"
#include "core/parallel.h"
#include "particles/kernel.h"

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
        densities_ = std::make_unique<Densities>(leaf.constAttributeArray("density"));
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
        const float density = densities_->get(id);
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
                    out[row + static_cast<openvdb::Index>(z & 7)] += density * root * root;
                }
            }
        }
    }
    bool endPointLeaf(const PointLeaf&) { return true; }
    /// True ends the leaf; false would process it again, for ever.
    bool finalize(const Coord&, size_t) { return true; }

  private:
    using Positions = openvdb::points::AttributeHandle<Vec3f>;
    using Densities = openvdb::points::AttributeHandle<float>;

    float support_;
    std::unique_ptr<Positions> positions_;
    std::unique_ptr<Densities> densities_;
};

/// Density at the centre of each point's kernel for a mass of 1 per point.
std::vector<float> normalised_densities(const std::vector<Vec3>& points, float support)
{
    std::vector<float> densities(points.size());
    parallel_for(points.size(), 8192, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i += 8) {
            KernelCentres centres;
            for (size_t k = 0; k < 8; ++k) {
                const Vec3 p = points[std::min(i + k, end - 1)];
                const Vec3 in_cell = p - glm::floor(p);
                centres.x[k] = in_cell.x;
                centres.y[k] = in_cell.y;
                centres.z[k] = in_cell.z;
                centres.support[k] = support;
            }
            float sums[8];
            kernel_lattice_sums(centres, sums);
            for (size_t k = 0; k < std::min<size_t>(8, end - i); ++k) {
                densities[i + k] = 1.0f / sums[k];
            }
        }
    });
    return densities;
}

}  // namespace

openvdb::FloatGrid::Ptr rasterize_with_openvdb(const std::vector<Vec3>& points, float support)
{
    namespace vp = openvdb::points;
    openvdb::initialize();
    std::vector<Vec3f> positions(points.size());
    for (size_t i = 0; i < points.size(); ++i) positions[i] = Vec3f(&points[i].x);
    const std::vector<float> densities = normalised_densities(points, support);

    const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    const vp::PointAttributeVector<Vec3f> position_list(positions);
    const auto index = openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(
        position_list, *transform);
    const auto grid = vp::createPointDataGrid<vp::NullCodec, vp::PointDataGrid>(
        *index, position_list, *transform);
    vp::appendAttribute<float>(grid->tree(), "density");
    const vp::PointAttributeVector<float> density_list(densities);
    vp::populateAttribute(grid->tree(), index->tree(), "density", density_list);

    openvdb::MaskTree topology(grid->tree(), false, true, openvdb::TopologyCopy());
    openvdb::tools::dilateActiveValues(topology, static_cast<int>(std::ceil(support)),
                                       openvdb::tools::NN_FACE_EDGE_VERTEX,
                                       openvdb::tools::IGNORE_TILES);
    auto result = openvdb::FloatGrid::create(
        std::make_shared<FloatTree>(topology, 0.0f, openvdb::TopologyCopy()));
    KernelTransfer transfer(result->tree(), support);
    vp::rasterize(*grid, transfer);
    return result;
}

}  // namespace mote::bench
