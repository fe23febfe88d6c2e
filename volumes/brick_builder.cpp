#include "volumes/brick_builder.h"

#include <sys/mman.h>

#include <cmath>
#include <map>
#include <memory>

#include <fmt/core.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "volumes/skip_distance.h"

namespace mote {
namespace {

constexpr int stride = BrickGrid::brick_stride;

void check_bytes(double bytes, const GridBudget& budget, const std::string& what)
{
    if (bytes <= static_cast<double>(budget.max_brick_bytes)) return;
    throw Error(ExitCode::Memory,
                fmt::format("{}: bricks would take {} but the limit is {}; crop the grid or use "
                            "larger voxels",
                            what, format_bytes(bytes),
                            format_bytes(static_cast<double>(budget.max_brick_bytes))));
}

/// The one value of all 9^3 values of a brick, or varied: its own block and the seven above it.
float uniform_value(const BlockTable& blocks, int x, int y, int z)
{
    const float value = blocks.uniform[blocks.index(x, y, z)];
    for (int n = 1; n < 8; ++n) {
        const int bx = x + (n & 1);
        const int by = y + (n >> 1 & 1);
        const int bz = z + (n >> 2 & 1);
        const bool outside = bx >= blocks.count.x || by >= blocks.count.y || bz >= blocks.count.z;
        const float other = outside ? 0.0f : blocks.uniform[blocks.index(bx, by, bz)];
        if (!(other == value)) return BlockTable::varied;
    }
    return value;
}

/// Bounds and mean of the reconstruction over the brick. Trapezoid weights (1/2 on the faces)
/// integrate a trilinear function exactly.
BrickRange range_of(const float* v)
{
    // Nine columns side by side, so that the compiler can use vectors.
    float min[stride];
    float max[stride];
    double sum[stride] = {};
    std::copy_n(v, stride, min);
    std::copy_n(v, stride, max);
    for (int x = 0; x < stride; ++x) {
        for (int y = 0; y < stride; ++y) {
            const double edge = (x % 8 == 0 ? 0.5 : 1.0) * (y % 8 == 0 ? 0.5 : 1.0);
            const float* row = v + ptrdiff_t{stride} * (x * stride + y);
            for (int z = 0; z < stride; ++z) {
                min[z] = std::min(min[z], row[z]);
                max[z] = std::max(max[z], row[z]);
                sum[z] += edge * static_cast<double>(row[z]);
            }
        }
    }
    BrickRange range{min[0], max[0], 0.0f};
    double total = 0.0;
    for (int z = 0; z < stride; ++z) {
        range.min = std::min(range.min, min[z]);
        range.max = std::max(range.max, max[z]);
        total += (z % 8 == 0 ? 0.5 : 1.0) * sum[z];
    }
    range.mean = std::clamp(static_cast<float>(total / 512.0), range.min, range.max);
    return range;
}

/// Rays touch bricks all over the grid; with 4 kB pages, address translation is 10 % of walks in
/// all directions. To be called while memory is reserved but not yet touched. Only a hint.
void prefer_huge_pages(std::vector<float>& reserved)
{
    constexpr size_t page = 4096;
    void* begin = reserved.data();
    size_t bytes = reserved.capacity() * sizeof(float);
    if (std::align(page, page, begin, bytes) != nullptr) {
        madvise(begin, bytes / page * page, MADV_HUGEPAGE);
    }
}

struct Numbering {
    std::vector<Vec3i> varied;                        ///< brick positions to fill, by brick number
    std::vector<std::pair<int32_t, float>> constant;  ///< shared bricks
};

Numbering number_bricks(const BlockTable& blocks, BrickGrid& grid, const GridBudget& budget,
                        const std::string& what)
{
    Numbering numbers;
    std::map<float, int32_t> shared;
    int32_t last = 0;
    const double brick_bytes = sizeof(float) * BrickGrid::brick_values + sizeof(BrickRange);
    const double table_bytes = 8.0 * static_cast<double>(grid.table.size());
    for (int z = 0; z < blocks.count.z; ++z) {
        for (int y = 0; y < blocks.count.y; ++y) {
            for (int x = 0; x < blocks.count.x; ++x) {
                const size_t i = blocks.index(x, y, z);
                if (!blocks.needed[i]) continue;
                const float value = uniform_value(blocks, x, y, z);
                if (std::isnan(value)) {
                    grid.table[i] = ++last;
                    numbers.varied.push_back({x, y, z});
                } else {
                    const auto [entry, is_new] = shared.try_emplace(value, last + 1);
                    if (is_new) {
                        numbers.constant.emplace_back(++last, value);
                        numbers.varied.push_back({-1, -1, -1});
                    }
                    grid.table[i] = entry->second;
                }
                check_bytes(table_bytes + brick_bytes * last, budget, what);
            }
        }
    }
    return numbers;
}

}  // namespace

BlockTable BlockTable::covering(Vec3i voxel_lo, Vec3i voxel_hi, const GridBudget& budget,
                                const std::string& what)
{
    const auto block_of = [](int64_t i) { return i >= 0 ? i / 8 : -((-i + 7) / 8); };
    BlockTable blocks;
    double positions = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        // A voxel reaches one cell below itself.
        const int64_t first = block_of(static_cast<int64_t>(voxel_lo[axis]) - 1);
        const int64_t count = block_of(voxel_hi[axis]) - first + 1;
        positions *= static_cast<double>(count);
        blocks.lo[axis] = static_cast<int>(first * 8);
        blocks.count[axis] = static_cast<int>(count);
    }
    check_bytes(9.0 * positions, budget, what);
    blocks.needed.assign(static_cast<size_t>(positions), 0);
    blocks.uniform.assign(static_cast<size_t>(positions), 0.0f);
    return blocks;
}

void BlockTable::mark(int x, int y, int z, unsigned faces)
{
    for (int n = 0; n < 8; ++n) {
        if ((faces >> n & 1u) == 0u) continue;
        needed[index(x - (n & 1), y - (n >> 1 & 1), z - (n >> 2 & 1))] = 1;
    }
}

BrickGrid build_bricks(const BlockTable& blocks, const FillBrick& fill, const GridBudget& budget,
                       const std::string& what)
{
    BrickGrid grid;
    grid.lo = blocks.lo;
    grid.brick_count = blocks.count;
    grid.table.assign(blocks.needed.size(), 0);
    const Numbering numbers = number_bricks(blocks, grid, budget, what);
    const size_t brick_count = numbers.varied.size() + 1;
    grid.values.reserve(brick_count * BrickGrid::brick_values);
    prefer_huge_pages(grid.values);
    grid.values.resize(brick_count * BrickGrid::brick_values);
    grid.ranges.resize(brick_count);
    parallel_for(numbers.varied.size(), 64, [&](size_t begin, size_t end) {
        for (size_t i = begin; i != end; ++i) {
            const Vec3i position = numbers.varied[i];
            if (position.x < 0) continue;
            float* values = grid.values.data() + (i + 1) * BrickGrid::brick_values;
            fill(blocks.lo + 8 * position, values);
            grid.ranges[i + 1] = range_of(values);
        }
    });
    for (const auto& [brick, value] : numbers.constant) {
        float* values = grid.values.data() + static_cast<size_t>(brick) * BrickGrid::brick_values;
        std::fill_n(values, BrickGrid::brick_values, value);
        grid.ranges[static_cast<size_t>(brick)] = {value, value, value};
    }
    for (const BrickRange& range : grid.ranges)
        grid.max_value = std::max(grid.max_value, range.max);
    for (int z = 0; z < blocks.count.z; ++z) {
        for (int y = 0; y < blocks.count.y; ++y) {
            for (int x = 0; x < blocks.count.x; ++x) {
                if (grid.table[blocks.index(x, y, z)] == 0) continue;
                const Vec3 corner(blocks.lo + 8 * Vec3i(x, y, z));
                grid.index_bounds.extend(corner);
                grid.index_bounds.extend(corner + Vec3(8.0f));
            }
        }
    }
    set_skip_distances(grid);
    return grid;
}

}  // namespace mote
