#include "particles/write_points.h"

#include <cmath>

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/PointIndexGrid.h>

#include "core/error.h"
#include "core/math.h"
#include "core/text.h"

namespace mote {

namespace {

using openvdb::points::NullCodec;
using openvdb::points::PointDataGrid;
using openvdb::tools::PointIndexGrid;

openvdb::Vec3s to_vdb(Vec3 v)
{
    return {v.x, v.y, v.z};
}
float to_vdb(float x)
{
    return x;
}
int64_t to_vdb(int64_t x)
{
    return x;
}

/// A vector of ours in the form in which OpenVDB's point tools want lists.
template <class T>
struct ValueList {
    using value_type = decltype(to_vdb(T{}));
    using PosType = value_type;

    const std::vector<T>& values;

    [[nodiscard]] size_t size() const { return values.size(); }
    void getPos(size_t n, value_type& value) const { value = to_vdb(values[n]); }
    void get(value_type& value, size_t n) const { value = to_vdb(values[n]); }
    void get(value_type& value, size_t n, openvdb::Index) const { value = to_vdb(values[n]); }
};

/// About eight particles to a voxel of the bounds, coarse enough for 32-bit voxel coordinates.
double choose_voxel_size(const ParticleSet& particles)
{
    Bounds3 bounds;
    for (const Vec3& p : particles.position) bounds.extend(p);
    const Vec3d extent(bounds.extent());
    const double widest = std::max(extent.x, std::max(extent.y, extent.z));
    const double least = 1e-3 * widest;  // flat clouds
    const double volume =
        std::max(extent.x, least) * std::max(extent.y, least) * std::max(extent.z, least);
    const double size = std::cbrt(8.0 * volume / static_cast<double>(particles.size()));
    constexpr double finest = 1e-4;  // OpenVDB takes voxels below 2e-5 for singular
    const Vec3 farthest = glm::max(glm::abs(bounds.lo), glm::abs(bounds.hi));
    return std::max({size, 1e-6 * double{max_component(farthest)}, finest});
}

template <class T>
void add_attribute(PointDataGrid& grid, const PointIndexGrid& index, const char* name,
                   const std::vector<T>& values)
{
    if (values.empty()) return;
    using Value = typename ValueList<T>::value_type;
    openvdb::points::appendAttribute<Value, NullCodec>(grid.tree(), name);
    openvdb::points::populateAttribute(grid.tree(), index.tree(), name, ValueList<T>{values});
}

PointDataGrid::Ptr make_grid(const ParticleSet& particles)
{
    if (particles.size() == 0) return PointDataGrid::create();
    const auto transform =
        openvdb::math::Transform::createLinearTransform(choose_voxel_size(particles));
    const ValueList<Vec3> positions{particles.position};
    const auto index = openvdb::tools::createPointIndexGrid<PointIndexGrid>(positions, *transform);
    auto grid = openvdb::points::createPointDataGrid<NullCodec, PointDataGrid>(*index, positions,
                                                                               *transform);
    add_attribute(*grid, *index, "v", particles.velocity);
    add_attribute(*grid, *index, "pscale", particles.radius);
    add_attribute(*grid, *index, "mass", particles.mass);
    add_attribute(*grid, *index, "temperature", particles.temperature);
    add_attribute(*grid, *index, "Cd", particles.color);
    add_attribute(*grid, *index, "id", particles.id);
    add_attribute(*grid, *index, "age", particles.age);
    return grid;
}

}  // namespace

void write_points(const std::string& path, const ParticleSet& particles)
{
    openvdb::initialize();
    try {
        const PointDataGrid::Ptr grid = make_grid(particles);
        grid->setName("particles");
        openvdb::io::File file(path);
        file.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC);
        file.write({grid});
        file.close();
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::Memory, fmt::format("{}: not enough memory to write {} particles",
                                                  path, particles.size()));
    } catch (const std::exception& e) {
        throw Error(ExitCode::Output, fmt::format("{}: {}", path, printable(e.what())));
    }
}

}  // namespace mote
