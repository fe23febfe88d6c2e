#include "volumes/grid_io.h"

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <set>

#include <fmt/core.h>
#include <openvdb/io/File.h>

#include "core/error.h"
#include "core/guarded_child.h"
#include "core/memory_cap.h"
#include "core/text.h"
#include "volumes/make_bricks.h"

namespace mote {
namespace {

namespace fs = std::filesystem;

void initialize_openvdb()
{
    static std::once_flag once;
    std::call_once(once, [] { openvdb::initialize(); });
}

std::string describe(const std::string& path, const std::string& name)
{
    return fmt::format("{}: grid \"{}\"", path, printable(name));
}

/// Size of an existing, regular, affordable file.
int64_t checked_size(const std::string& path, const GridBudget& budget)
{
    std::error_code error;
    if (!fs::exists(path, error)) {
        throw Error(ExitCode::Input, fmt::format("{}: no such file", path));
    }
    if (!fs::is_regular_file(path, error)) {
        throw Error(ExitCode::Input, fmt::format("{}: not a file", path));
    }
    const auto size = static_cast<int64_t>(fs::file_size(path, error));
    if (error) throw Error(ExitCode::Input, fmt::format("{}: {}", path, error.message()));
    if (size > budget.max_file_bytes) {
        throw Error(
            ExitCode::Memory,
            fmt::format("{}: {} but the limit is {}", path, format_bytes(static_cast<double>(size)),
                        format_bytes(static_cast<double>(budget.max_file_bytes))));
    }
    return size;
}

/// An open file. Its grids are read whole, never lazily: the file may be replaced at any time.
class OpenFile {
  public:
    explicit OpenFile(const std::string& path) : file_(path)
    {
        file_.setCopyMaxBytes(0);
        file_.open(/*delayLoad=*/false);
    }
    [[nodiscard]] openvdb::io::File& operator*() { return file_; }
    [[nodiscard]] openvdb::io::File* operator->() { return &file_; }

    [[nodiscard]] std::vector<std::string> names()
    {
        std::vector<std::string> out;
        for (auto name = file_.beginName(); name != file_.endName(); ++name) {
            out.push_back(name.gridName());
        }
        return out;
    }

  private:
    openvdb::io::File file_;
};

/// Converts what OpenVDB throws into one Error that names the file.
template <class F>
auto guarded(const std::string& what, F&& f) -> decltype(f())
{
    try {
        return f();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::Memory, fmt::format("{}: not enough memory to read it", what));
    } catch (const std::exception& e) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: damaged or of another format ({}); copy or write it again",
                                what, printable(e.what())));
    }
}

std::string grid_class_name(openvdb::GridClass grid_class)
{
    switch (grid_class) {
        case openvdb::GRID_LEVEL_SET:
            return "level set";
        case openvdb::GRID_FOG_VOLUME:
            return "fog volume";
        case openvdb::GRID_STAGGERED:
            return "staggered";
        default:
            return "unknown";
    }
}

GridInfo info_of(const std::string& name, const openvdb::GridBase& grid)
{
    GridInfo info;
    info.name = name;
    info.value_type = printable(grid.valueType());
    info.grid_class = grid_class_name(grid.getGridClass());
    using openvdb::GridBase;
    if (const auto m = grid.getMetadata<openvdb::Int64Metadata>(GridBase::META_FILE_VOXEL_COUNT)) {
        info.active_voxels = m->value();
    }
    if (const auto m = grid.getMetadata<openvdb::Int64Metadata>(GridBase::META_FILE_MEM_BYTES)) {
        info.memory_bytes = m->value();
    }
    const auto lo = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MIN);
    const auto hi = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MAX);
    if (lo && hi) {
        info.bbox_lo = {lo->value().x(), lo->value().y(), lo->value().z()};
        info.bbox_hi = {hi->value().x(), hi->value().y(), hi->value().z()};
    }
    if (grid.transform().isLinear()) {
        const openvdb::Vec3d size = grid.voxelSize();
        info.voxel_size = Vec3(Vec3d(size.x(), size.y(), size.z()));
    }
    return info;
}

std::vector<GridInfo> read_infos(const std::string& path)
{
    OpenFile file(path);
    std::vector<GridInfo> infos;
    for (const std::string& name : file.names()) {
        GridInfo info;
        info.name = name;
        info.value_type = "unreadable";
        try {
            info = info_of(name, *file->readGridMetadata(name));
        } catch (const openvdb::Exception&) {  // of a type that this OpenVDB does not know
        }
        infos.push_back(std::move(info));
    }
    return infos;
}

std::string list(const std::vector<GridInfo>& infos)
{
    std::string out;
    for (const GridInfo& info : infos) {
        if (out.size() > 300) return out + ", ...";
        out += fmt::format("{}\"{}\" ({})", out.empty() ? "" : ", ", printable(info.name, 40),
                           printable(info.value_type, 20));
    }
    return out.empty() ? "no grids" : out;
}

bool is_scalar(const std::string& type)
{
    return type == "float" || type == "double";
}

bool is_vector(const std::string& type)
{
    return type == "vec3s" || type == "vec3d";
}

std::vector<GridInfo>::const_iterator find_grid(const std::vector<GridInfo>& infos,
                                                const std::string& name)
{
    return std::find_if(infos.begin(), infos.end(),
                        [&](const GridInfo& info) { return info.name == name; });
}

/// Refuses by metadata alone: unknown names, kinds that cannot be rendered, claims over budget.
void check_choice(const std::string& path, const std::vector<GridInfo>& infos,
                  const std::string& wanted, const GridBudget& budget)
{
    require_grid(path, infos, wanted);
    const auto found = find_grid(infos, wanted);
    const std::string what = describe(path, wanted);
    if (found->grid_class == "level set") {
        throw Error(ExitCode::Input, what +
                                         " is a level set (signed distances); convert it to a "
                                         "fog volume first, e.g. with vdb_tool -sdf2fog");
    }
    if (!is_scalar(found->value_type) && !is_vector(found->value_type)) {
        const bool points = found->value_type.starts_with("ptdata");
        throw Error(
            ExitCode::Input,
            fmt::format("{} is of type {}, which is not a volume of float, double, vec3s or "
                        "vec3d{}; the file holds {}",
                        what, found->value_type,
                        points ? " (use the file as a [[particles]] cache)" : "", list(infos)));
    }
    if (found->active_voxels > budget.max_voxels) {
        throw Error(ExitCode::Memory,
                    fmt::format("{} has {:.3g} active voxels but the limit is {:.3g}", what,
                                static_cast<double>(found->active_voxels),
                                static_cast<double>(budget.max_voxels)));
    }
}

openvdb::GridPtrVec read_raw(const std::string& path, const std::vector<std::string>& names)
{
    OpenFile file(path);
    openvdb::GridPtrVec grids;
    for (const std::string& name : names) grids.push_back(file->readGrid(name));
    return grids;
}

/// Files that a child has read without trouble, by path, size, time of change and grid names.
bool already_checked(const std::string& key, bool remember)
{
    static std::mutex mutex;
    static std::set<std::string> keys;
    const std::lock_guard lock(mutex);
    if (remember) keys.insert(key);
    return keys.count(key) > 0;
}

/// A leaf of one value takes about 100 bytes in the file and 2.3 kB in memory; no encoding of
/// OpenVDB packs denser than that.
int64_t memory_for(int64_t file_bytes)
{
    return std::max<int64_t>(1'000'000'000, 64 * file_bytes);
}

/// Lets a child process read the file under limits before this process does.
void check_in_child(const std::string& path, int64_t size, const std::vector<std::string>& names,
                    const std::function<void()>& read)
{
    std::error_code error;
    const auto time = fs::last_write_time(path, error).time_since_epoch().count();
    std::string key = fmt::format("{}\n{}\n{}", path, size, time);
    for (const std::string& name : names) key += "\n" + name;
    if (already_checked(key, false)) return;
    ChildLimits limits;
    limits.memory_bytes = memory_for(size);
    // Whole files read at 50 MB/s or more; the rest of the allowance is for busy machines.
    limits.cpu_seconds = 1 + static_cast<int>(size / 5'000'000);
    limits.wall_seconds = 120 + static_cast<int>(size / 1'000'000);
    run_in_child(path, limits, read);
    already_checked(key, true);
}

openvdb::GridBase::Ptr to_single_precision(openvdb::GridBase::Ptr grid)
{
    if (const auto scalar = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid)) {
        return openvdb::FloatGrid::Ptr(new openvdb::FloatGrid(*scalar));
    }
    if (const auto vector = openvdb::gridPtrCast<openvdb::Vec3DGrid>(grid)) {
        return openvdb::Vec3SGrid::Ptr(new openvdb::Vec3SGrid(*vector));
    }
    return grid;
}

}  // namespace

std::vector<GridInfo> list_grids(const std::string& path, const GridBudget& budget)
{
    initialize_openvdb();
    const int64_t size = checked_size(path, budget);
    check_in_child(path, size, {}, [&] { static_cast<void>(read_infos(path)); });
    return guarded(path, [&] {
        const MemoryCap cap(memory_for(size));
        return read_infos(path);
    });
}

void require_grid(const std::string& path, const std::vector<GridInfo>& held,
                  const std::string& name, const std::string& advice)
{
    if (find_grid(held, name) != held.end()) return;
    std::vector<std::string> names;
    bool only_points = !held.empty();
    for (const GridInfo& info : held) {
        names.push_back(info.name);
        only_points &= info.value_type.starts_with("ptdata");
    }
    throw Error(ExitCode::Input,
                fmt::format("{}: no grid \"{}\"{}; it holds {}{}{}{}", path, printable(name),
                            did_you_mean(name, names), list(held),
                            only_points ? ". Points belong into a [[particles]] entry" : "",
                            advice.empty() ? "" : ". ", advice));
}

openvdb::GridPtrVec read_grids(const std::string& path, const std::vector<std::string>& names,
                               const GridBudget& budget)
{
    const std::vector<GridInfo> infos = list_grids(path, budget);
    for (const std::string& name : names) check_choice(path, infos, name, budget);
    // Never destroyed: freeing a tree is a parallel loop, and the child ends right after this.
    check_in_child(path, checked_size(path, budget), names,
                   [&] { static_cast<void>(new openvdb::GridPtrVec(read_raw(path, names))); });
    openvdb::GridPtrVec grids = guarded(path, [&] {
        const MemoryCap cap(memory_for(checked_size(path, budget)));
        return read_raw(path, names);
    });
    for (size_t i = 0; i < grids.size(); ++i) {
        const std::string what = describe(path, names[i]);
        guarded(what, [&] {
            static_cast<void>(object_from_index(*grids[i]));
            const auto voxels = static_cast<double>(grids[i]->activeVoxelCount());
            if (voxels > static_cast<double>(budget.max_voxels)) {
                throw Error(ExitCode::Memory,
                            fmt::format("{} has {:.3g} active voxels but the limit is {:.3g}", what,
                                        voxels, static_cast<double>(budget.max_voxels)));
            }
            grids[i] = to_single_precision(grids[i]);
        });
    }
    return grids;
}

openvdb::FloatGrid::Ptr read_float_grid(const std::string& path, const std::string& name,
                                        const GridBudget& budget)
{
    auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(read_grids(path, {name}, budget)[0]);
    if (grid) return grid;
    throw Error(ExitCode::Input,
                describe(path, name) + " is a vector grid; a scalar is needed here");
}

openvdb::Vec3SGrid::Ptr read_vec3_grid(const std::string& path, const std::string& name,
                                       const GridBudget& budget)
{
    auto grid = openvdb::gridPtrCast<openvdb::Vec3SGrid>(read_grids(path, {name}, budget)[0]);
    if (grid) return grid;
    throw Error(ExitCode::Input,
                describe(path, name) + " is a scalar grid; a vector is needed here");
}

void write_vdb(const std::string& path, const openvdb::GridPtrVec& grids)
{
    initialize_openvdb();
    try {
        openvdb::io::File file(path);
        file.setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
        file.write(grids);
        file.close();
    } catch (const std::exception& e) {
        throw Error(ExitCode::Output,
                    fmt::format("{}: cannot write: {}", path, printable(e.what())));
    }
}

}  // namespace mote
