#include <algorithm>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/AttributeArray.h>
#include <openvdb/points/PointDataGrid.h>

#include "core/error.h"
#include "core/guarded_child.h"
#include "core/text.h"
#include "particles/readers.h"
#include "particles/shared_columns.h"

namespace mote {

namespace {

using openvdb::points::AttributeArray;
using openvdb::points::PointDataGrid;
using openvdb::points::PointDataTree;

[[noreturn]] void fail(const std::string& what)
{
    throw Error(ExitCode::Input, what);
}

/// Names of the grids of points; fails if there are none.
std::vector<std::string> point_grid_names(openvdb::io::File& file)
{
    std::vector<std::string> names;
    std::string others;
    for (auto name = file.beginName(); name != file.endName(); ++name) {
        const auto metadata = file.readGridMetadata(name.gridName());
        if (!metadata->isType<PointDataGrid>()) {
            others += fmt::format("{}\"{}\" ({})", others.empty() ? "" : ", ",
                                  printable(name.gridName(), 40), metadata->valueType());
            continue;
        }
        names.push_back(name.gridName());
    }
    if (!names.empty()) return names;
    fail(fmt::format("no points; the file holds {}. Fog volumes belong into a [[volumes]] entry",
                     others.empty() ? "no grids" : others));
}

std::vector<PointDataGrid::Ptr> read_point_grids(const std::string& path, bool header_only)
{
    openvdb::io::File file(path);
    file.setCopyMaxBytes(0);
    file.open(/*delayLoad=*/false);
    std::vector<PointDataGrid::Ptr> grids;
    for (const std::string& name : point_grid_names(file)) {
        if (header_only) continue;
        grids.push_back(openvdb::gridPtrCast<PointDataGrid>(file.readGrid(name)));
    }
    return grids;
}

int components_of(const std::string& type)
{
    for (const char* vector : {"vec3s", "vec3d", "vec3i"}) {
        if (type == vector) return 3;
    }
    for (const char* number : {"float", "double", "int8", "int16", "int32", "int64", "bool"}) {
        if (type == number) return 1;
    }
    return 0;  // strings, groups, matrices: not for us
}

std::vector<FileField> fields_of(const openvdb::points::AttributeSet& set)
{
    std::vector<FileField> fields;
    for (const auto& [name, index] : set.descriptor().map()) {
        fields.push_back({name, components_of(set.descriptor().valueType(index))});
    }
    return fields;
}

/// Attributes that every grid has: particles without a value would have to be made up.
std::vector<FileField> common_fields(const std::vector<PointDataGrid::Ptr>& grids)
{
    std::vector<FileField> common;
    bool is_first = true;
    for (const PointDataGrid::Ptr& grid : grids) {
        const auto leaf = grid->tree().cbeginLeaf();
        if (!leaf) continue;
        const std::vector<FileField> fields = fields_of(leaf->attributeSet());
        if (is_first) common = fields;
        is_first = false;
        const auto is_missing = [&](const FileField& field) {
            return std::none_of(fields.begin(), fields.end(), [&](const FileField& other) {
                return other.name == field.name && other.components == field.components;
            });
        };
        common.erase(std::remove_if(common.begin(), common.end(), is_missing), common.end());
    }
    return common;
}

const AttributeArray& array_of(const PointDataTree::LeafNodeType& leaf, const std::string& name)
{
    const size_t index = leaf.attributeSet().find(name);
    if (index == openvdb::points::AttributeSet::INVALID_POS) {
        fail(fmt::format("damaged: attribute \"{}\" is missing in a part of the grid",
                         printable(name, 40)));
    }
    return leaf.constAttributeArray(index);
}

/// OpenVDB believes the file: offsets into attribute arrays are checked here before use.
size_t checked_point_count(const PointDataTree::LeafNodeType& leaf)
{
    const size_t count = array_of(leaf, "P").size();
    size_t previous = 0;
    for (openvdb::Index voxel = 0; voxel < PointDataTree::LeafNodeType::SIZE; ++voxel) {
        const auto end = static_cast<size_t>(leaf.getValue(voxel));
        if (end < previous || end > count) fail("damaged: voxels point outside the attributes");
        previous = end;
    }
    if (previous != count) fail("damaged: voxels do not account for all points");
    return count;
}

size_t count_points(const std::vector<PointDataGrid::Ptr>& grids, size_t capacity,
                    uint64_t file_bytes)
{
    size_t count = 0;
    for (const PointDataGrid::Ptr& grid : grids) {
        for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
            count += checked_point_count(*leaf);
            if (count > capacity) {
                throw Error(ExitCode::Memory,
                            fmt::format("more than {} particles in {}: over max_particles, or "
                                        "damaged",
                                        capacity, format_bytes(static_cast<double>(file_bytes))));
            }
        }
    }
    return count;
}

template <class Value, class Store>
void for_each_value(const AttributeArray& array, Store&& store)
{
    const openvdb::points::AttributeHandle<Value> handle(array);
    for (openvdb::Index i = 0; i < array.size(); ++i) store(i, handle.get(i));
}

/// Calls store(i, value) with every value as double or Vec3d, ids as int64_t.
template <class Store>
void visit_values(const AttributeArray& array, Store&& store)
{
    const std::string type = array.type().first;
    const auto number = [&](openvdb::Index i, auto value) {
        using Value = decltype(value);
        if constexpr (std::is_integral_v<Value>)
            store(i, static_cast<int64_t>(value));
        else
            store(i, static_cast<double>(value));
    };
    const auto vector = [&](openvdb::Index i, const auto& v) { store(i, openvdb::Vec3d(v)); };
    if (type == "float")
        for_each_value<float>(array, number);
    else if (type == "double")
        for_each_value<double>(array, number);
    else if (type == "int8")
        for_each_value<int8_t>(array, number);
    else if (type == "int16")
        for_each_value<int16_t>(array, number);
    else if (type == "int32")
        for_each_value<int32_t>(array, number);
    else if (type == "int64")
        for_each_value<int64_t>(array, number);
    else if (type == "bool")
        for_each_value<bool>(array, number);
    else if (type == "vec3s")
        for_each_value<openvdb::Vec3s>(array, vector);
    else if (type == "vec3d")
        for_each_value<openvdb::Vec3d>(array, vector);
    else if (type == "vec3i")
        for_each_value<openvdb::Vec3i>(array, vector);
    else
        fail(fmt::format("damaged: an attribute changes its type to \"{}\"", printable(type, 40)));
}

/// Writes one attribute of a leaf into its column, from row `first` on.
void fill_attribute(const AttributeArray& array, ParticleAttribute attribute, char* column,
                    size_t first)
{
    auto* ids = reinterpret_cast<int64_t*>(column);
    auto* floats = reinterpret_cast<float*>(column);
    const auto components = static_cast<size_t>(attribute_components(attribute));
    visit_values(array, [&](openvdb::Index i, const auto& value) {
        using Value = std::decay_t<decltype(value)>;
        const size_t row = first + i;
        if constexpr (std::is_same_v<Value, openvdb::Vec3d>) {
            if (components != 3) fail("damaged: a vector where a number was");
            for (size_t c = 0; c < 3; ++c) {
                floats[3 * row + c] = static_cast<float>(value[static_cast<int>(c)]);
            }
        } else {
            if (components != 1) fail("damaged: a number where a vector was");
            if (attribute != ParticleAttribute::Id)
                floats[row] = static_cast<float>(value);
            else if constexpr (std::is_same_v<Value, int64_t>)
                ids[row] = value;
            else
                ids[row] = std::abs(value) < 0x1p62 ? static_cast<int64_t>(value) : 0;
        }
    });
}

/// Positions are stored as offsets from the centres of voxels.
void fill_positions(const PointDataTree::LeafNodeType& leaf, const openvdb::math::Transform& world,
                    char* column, size_t first)
{
    auto* floats = reinterpret_cast<float*>(column);
    const openvdb::points::AttributeHandle<openvdb::Vec3s> offsets(array_of(leaf, "P"));
    openvdb::Index i = 0;
    for (openvdb::Index voxel = 0; voxel < PointDataTree::LeafNodeType::SIZE; ++voxel) {
        const openvdb::Vec3d centre = leaf.offsetToGlobalCoord(voxel).asVec3d();
        for (const auto end = static_cast<openvdb::Index>(leaf.getValue(voxel)); i < end; ++i) {
            const openvdb::Vec3d p = world.indexToWorld(centre + openvdb::Vec3d(offsets.get(i)));
            for (size_t c = 0; c < 3; ++c) {
                floats[3 * (first + i) + c] = static_cast<float>(p[static_cast<int>(c)]);
            }
        }
    }
}

void fill_leaf(const PointDataTree::LeafNodeType& leaf, const openvdb::math::Transform& world,
               const std::vector<FileField>& fields, const std::vector<Binding>& bindings,
               const SharedColumns& columns, size_t first)
{
    const size_t count = array_of(leaf, "P").size();
    for (const Binding& binding : bindings) {
        if (binding.component != 0) continue;  // vectors are copied whole
        const std::string& name = fields[binding.field].name;
        const AttributeArray& array = array_of(leaf, name);
        if (array.size() != count || !array.hasConstantStride() || array.stride() != 1) {
            fail(fmt::format("attribute \"{}\" has {} values for {} points", printable(name, 40),
                             array.dataSize(), count));
        }
        char* column = columns.column(binding.attribute);
        if (binding.attribute == ParticleAttribute::Position && name == "P") {
            if (array.type().first != "vec3s") fail("positions are not of type vec3s");
            fill_positions(leaf, world, column, first);
        } else {
            fill_attribute(array, binding.attribute, column, first);
        }
    }
}

/// The child's work. One thread: TBB's workers do not exist in a forked process.
void read_into(const std::string& path, const PointRequest& request, uint64_t file_bytes,
               const SharedColumns& columns)
{
    // Never destroyed: freeing a tree is a parallel loop, and the process ends right after this.
    const auto& grids =
        *new std::vector<PointDataGrid::Ptr>(read_point_grids(path, request.header_only));
    const size_t count = count_points(grids, columns.capacity(), file_bytes);
    SharedHeader& header = columns.header();
    header.count = count;
    if (count == 0) return;
    const std::vector<FileField> fields = common_fields(grids);
    const auto bindings = bind_attributes(path, fields, request.params, request.mask);
    for (const Binding& binding : bindings) {
        const auto a = static_cast<size_t>(binding.attribute);
        const bool is_split = binding.field_component != binding.component;
        if (is_split) fail("vectors must be one attribute of three numbers in .vdb points");
        header.is_present[a] = true;
        const std::string name = printable(fields[binding.field].name, 63);
        std::memcpy(header.field_names[a], name.c_str(), std::min<size_t>(name.size() + 1, 63));
    }
    size_t first = 0;
    for (const PointDataGrid::Ptr& grid : grids) {
        for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
            fill_leaf(*leaf, grid->transform(), fields, bindings, columns, first);
            first += array_of(*leaf, "P").size();
        }
    }
}

}  // namespace

// The file is untrusted and OpenVDB 10 checks little of it, so only a child process under limits
// ever opens it: it hands over plain arrays through shared memory.
PointBuffer read_vdb_points(const std::string& path, const PointRequest& request)
{
    openvdb::initialize();
    std::error_code error;
    const auto file_bytes = static_cast<uint64_t>(std::filesystem::file_size(path, error));
    if (error) fail(fmt::format("{}: {}", path, error.message()));
    // Points with positions of their own take more than a byte, however well they compress.
    const uint64_t most = std::min(
        static_cast<uint64_t>(std::max(0.0f, request.params.max_particles)), 4096 + 2 * file_bytes);
    const SharedColumns columns(path, static_cast<size_t>(most));
    ChildLimits limits;
    limits.memory_bytes = std::max<int64_t>(1'000'000'000, 64 * static_cast<int64_t>(file_bytes));
    limits.cpu_seconds = 5 + static_cast<int>(file_bytes / 5'000'000);
    limits.wall_seconds = 120 + static_cast<int>(file_bytes / 1'000'000);
    run_in_child(path, limits, [&] { read_into(path, request, file_bytes, columns); });
    return columns.to_buffer();
}

}  // namespace mote
