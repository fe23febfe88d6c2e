#pragma once

#include "particles/ply_header.h"
#include "particles/text_row.h"

/// The rows below a PLY header, for particles and meshes alike.
namespace mote {

/// Throws Error(Input) if the rest of the file cannot hold what the header claims.
void check_ply_claim(const InputFile& file, const PlyElement& element, PlyFormat format);

/// Steps over all rows of an element.
void skip_ply_element(InputFile& file, const PlyElement& element, PlyFormat format);

/// Length of a binary list, which stands at `bytes`. Throws Error(Input) if that many entries
/// cannot follow.
[[nodiscard]] uint64_t ply_list_length(const InputFile& file, const PlyElement& element,
                                       const PlyProperty& property, const unsigned char* bytes,
                                       bool is_big_endian);

/// Error for a file that ends after `count` rows of an element.
[[noreturn]] void fail_ply_truncated(const InputFile& file, const PlyElement& element,
                                     uint64_t count);

/// One binary row in order: on_number(property, bytes), and on_list(property, length), which must
/// step over the list's entries.
template <class OnNumber, class OnList>
void walk_ply_row(InputFile& file, const PlyElement& element, bool is_big_endian,
                  OnNumber&& on_number, OnList&& on_list)
{
    for (size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (!property.list_count) {
            on_number(i, file.take(scalar_size(property.type)));
            continue;
        }
        const unsigned char* bytes = file.take(scalar_size(*property.list_count));
        on_list(i, ply_list_length(file, element, property, bytes, is_big_endian));
    }
}

/// One ascii row in order: on_number(property, value), for a list its length, and then
/// on_entry(property, value) for each of its entries.
template <class OnNumber, class OnEntry>
void walk_ply_line(TextRow& row, const PlyElement& element, OnNumber&& on_number,
                   OnEntry&& on_entry)
{
    std::string_view token;
    for (size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (!row.next(token)) {
            row.fail(
                fmt::format("the row ends before property \"{}\"", printable(property.name, 40)));
        }
        const double value = row.number(token);
        on_number(i, value);
        if (!property.list_count) continue;
        for (double entries = value; entries > 0.0; entries -= 1.0) {
            if (!row.next(token)) row.fail("the row ends inside a list");
            on_entry(i, row.number(token));
        }
    }
    if (row.next(token)) row.fail("more numbers than the header names");
}

/// Calls on_line(row number, line) for every row of an ascii element; blank lines do not count.
template <class OnLine>
void for_each_ply_line(InputFile& file, const PlyElement& element, OnLine&& on_line)
{
    std::string_view line;
    for (uint64_t i = 0; i < element.count;) {
        if (!file.next_line(line)) fail_ply_truncated(file, element, i);
        if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
        TextRow row(file.path(), file.line_number(), line);
        on_line(i, row);
        ++i;
    }
}

}  // namespace mote
