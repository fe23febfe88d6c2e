#include "app/info_particles.h"

#include <fmt/format.h>

#include "core/text.h"

namespace mote {

namespace {

std::string range_line(const AttributeRange& range)
{
    std::string values;
    for (int c = 0; c < range.components; ++c) {
        values += fmt::format("{}{:.6g} .. {:.6g}", c > 0 ? ", " : "", range.lo[c], range.hi[c]);
    }
    return fmt::format("  {:<12} {} {}\n", range.name, values, range.unit);
}

std::string displacement_line(const ParticleInfo& info, double fps, float voxel_size)
{
    const double per_frame = static_cast<double>(info.largest_speed) / fps;
    const std::string in_voxels =
        voxel_size > 0.0f
            ? fmt::format(", {:.3g} voxels", per_frame / static_cast<double>(voxel_size))
            : std::string();
    return fmt::format(
        "  {:<12} {:.4g} m/s: largest displacement {:.4g} m{} per frame at {:g} fps\n",
        "speed up to", info.largest_speed, per_frame, in_voxels, fps);
}

}  // namespace

std::string particle_lines(const ParticleInfo& info, double fps, float voxel_size)
{
    std::string text =
        fmt::format("  {:<12} {}, {:.6g} kg, {} in memory\n", "particles", info.count,
                    info.total_mass, format_bytes(static_cast<double>(info.memory_bytes)));
    for (const AttributeRange& range : info.attributes) text += range_line(range);
    return text + displacement_line(info, fps, voxel_size);
}

}  // namespace mote
