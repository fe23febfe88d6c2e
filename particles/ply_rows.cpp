#include "particles/ply_rows.h"

#include <algorithm>

namespace mote {

void check_ply_claim(const InputFile& file, const PlyElement& element, PlyFormat format)
{
    // An ascii number takes two bytes with what separates it; the last one may end the file.
    const uint64_t row = format == PlyFormat::Ascii
                             ? 2 * std::max<uint64_t>(1, element.properties.size())
                             : element.smallest_row();
    const uint64_t there = file.remaining() + 1;
    if (row == 0 || element.count <= there / row) return;
    throw Error(ExitCode::Input,
                fmt::format("{}: the header claims {} of element \"{}\", at least {} bytes each, "
                            "but only {} bytes follow",
                            file.path(), element.count, printable(element.name, 40), row,
                            file.remaining()));
}

uint64_t ply_list_length(const InputFile& file, const PlyElement& element,
                         const PlyProperty& property, const unsigned char* bytes,
                         bool is_big_endian)
{
    const double count = load_scalar(bytes, *property.list_count, is_big_endian);
    const double size = count * static_cast<double>(scalar_size(property.type));
    if (size >= 0.0 && size <= static_cast<double>(file.remaining())) {
        return static_cast<uint64_t>(count);
    }
    throw Error(ExitCode::Input,
                fmt::format("{}: list \"{}\" of element \"{}\" claims {} entries, but only {} "
                            "bytes follow",
                            file.path(), printable(property.name, 40), printable(element.name, 40),
                            count, file.remaining()));
}

void fail_ply_truncated(const InputFile& file, const PlyElement& element, uint64_t count)
{
    const char* rows = element.name == "vertex" ? "vertices" : "rows";
    throw Error(ExitCode::Input, fmt::format("{}: truncated: it ends after {} of {} {}",
                                             file.path(), count, element.count, rows));
}

void skip_ply_element(InputFile& file, const PlyElement& element, PlyFormat format)
{
    if (format == PlyFormat::Ascii) {
        std::string_view line;
        for (uint64_t i = 0; i < element.count && file.next_line(line); ++i) continue;
        return;
    }
    if (!element.has_lists()) {
        file.skip(element.count * element.smallest_row());
        return;
    }
    for (uint64_t i = 0; i < element.count; ++i) {
        walk_ply_row(
            file, element, format == PlyFormat::BigEndian, [](size_t, const unsigned char*) {},
            [&](size_t property, uint64_t entries) {
                file.skip(entries * scalar_size(element.properties[property].type));
            });
    }
}

}  // namespace mote
