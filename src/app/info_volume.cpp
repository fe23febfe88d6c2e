#include "app/info_volume.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text.h"
#include "volumes/grid_io.h"

namespace mote {

namespace {

constexpr const char* float_types[] = {"float", "double"};
constexpr const char* vector_types[] = {"vec3s", "vec3d"};
constexpr const char* velocity_names[] = {"velocity", "vel", "v"};

template <size_t N>
bool is_one_of(const std::string& word, const char* const (&words)[N])
{
    return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

/// Smallest and largest finite active value of a grid under `measure`, and how many are not finite.
template <class Grid, class Measure>
std::string range_text(const Grid& grid, Measure&& measure, float& largest)
{
    float low = infinity;
    float high = -infinity;
    int64_t non_finite = 0;
    for (auto it = grid.cbeginValueOn(); it; ++it) {
        const float value = measure(*it);
        if (!std::isfinite(value)) {
            ++non_finite;
            continue;
        }
        low = std::min(low, value);
        high = std::max(high, value);
    }
    largest = std::max(high, 0.0f);
    if (low > high) return "no finite value";
    return fmt::format("{:.6g} .. {:.6g}{}", low, high,
                       non_finite > 0 ? fmt::format(", {} not finite", non_finite) : "");
}

std::string count_text(int64_t count, const char* unknown = "?")
{
    return count < 0 ? unknown : std::to_string(count);
}

std::string header_lines(const GridInfo& grid)
{
    std::string text = fmt::format(
        "grid \"{}\": {}, {}, {} active voxels, {} in memory\n", printable(grid.name),
        printable(grid.value_type, 40), printable(grid.grid_class, 40),
        count_text(grid.active_voxels),
        grid.memory_bytes < 0 ? "?" : format_bytes(static_cast<double>(grid.memory_bytes)));
    const Vec3 voxel = grid.voxel_size;
    if (voxel.x > 0.0f) {
        text += fmt::format("  voxel        {:.5g}x{:.5g}x{:.5g} m\n", voxel.x, voxel.y, voxel.z);
    } else {
        text += "  voxel        the transform is not linear\n";
    }
    const Vec3i lo = grid.bbox_lo;
    const Vec3i hi = grid.bbox_hi;
    if (lo.x <= hi.x) {
        text += fmt::format("  bounds       ({}, {}, {}) .. ({}, {}, {}) in voxels\n", lo.x, lo.y,
                            lo.z, hi.x, hi.y, hi.z);
    }
    return text;
}

}  // namespace

bool is_point_grid(const GridInfo& grid)
{
    return grid.value_type.rfind("ptdataidx", 0) == 0;
}

std::string describe_grid(const std::string& path, const GridInfo& grid, double fps)
{
    std::string text = header_lines(grid);
    float largest = 0.0f;
    if (is_one_of(grid.value_type, float_types) && grid.grid_class != "level set") {
        const auto values = read_float_grid(path, grid.name);
        text +=
            fmt::format("  values       {}\n", range_text(
                                                   *values, [](float v) { return v; }, largest));
    } else if (is_one_of(grid.value_type, vector_types)) {
        const auto values = read_vec3_grid(path, grid.name);
        text +=
            fmt::format("  lengths      {}\n",
                        range_text(
                            *values, [](const openvdb::Vec3f& v) { return v.length(); }, largest));
        const float edge = std::min({grid.voxel_size.x, grid.voxel_size.y, grid.voxel_size.z});
        if (edge > 0.0f && is_one_of(grid.name, velocity_names)) {
            text += fmt::format(
                "  speed        largest displacement {:.3g} voxels per frame at {:g} fps\n",
                static_cast<double>(largest) / fps / static_cast<double>(edge), fps);
        }
    } else {
        text += "  values       not read: neither a fog volume nor a vector grid\n";
    }
    return text;
}

}  // namespace mote
