#include <algorithm>

#include "particles/ply_header.h"
#include "particles/readers.h"
#include "particles/text_row.h"

namespace mote {

namespace {

/// Refuses counts that the rest of the file cannot hold.
void check_claim(const InputFile& file, const PlyElement& element, PlyFormat format)
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

/// Skips the lists and numbers of one binary row, calling on_number(property, bytes).
template <class OnNumber>
void walk_binary_row(InputFile& file, const PlyElement& element, bool is_big_endian,
                     OnNumber&& on_number)
{
    for (size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (!property.list_count) {
            on_number(i, file.take(scalar_size(property.type)));
            continue;
        }
        const size_t size = scalar_size(*property.list_count);
        const double count = load_scalar(file.take(size), *property.list_count, is_big_endian);
        const double bytes = count * static_cast<double>(scalar_size(property.type));
        if (!(bytes >= 0.0 && bytes <= static_cast<double>(file.remaining()))) {
            throw Error(ExitCode::Input,
                        fmt::format("{}: list \"{}\" of element \"{}\" claims {} entries, but only "
                                    "{} bytes follow",
                                    file.path(), printable(property.name, 40),
                                    printable(element.name, 40), count, file.remaining()));
        }
        file.skip(static_cast<uint64_t>(bytes));
    }
}

void skip_element(InputFile& file, const PlyElement& element, PlyFormat format)
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
        walk_binary_row(file, element, format == PlyFormat::BigEndian,
                        [](size_t, const unsigned char*) {});
    }
}

RowLayout layout_of(const PlyElement& element, PlyFormat format)
{
    RowLayout layout;
    for (const PlyProperty& property : element.properties) {
        layout.fields.push_back({property.type, layout.size, format == PlyFormat::BigEndian});
        layout.size += scalar_size(property.type);
    }
    return layout;
}

/// Lists are no attributes: their names are hidden, so that nothing binds to them.
std::vector<FileField> fields_of(const PlyElement& element)
{
    std::vector<FileField> fields;
    for (const PlyProperty& property : element.properties) {
        fields.push_back({property.name, property.list_count ? 0 : 1});
    }
    return fields;
}

void read_binary(InputFile& file, const PlyElement& element, PlyFormat format, PointBuffer& buffer)
{
    const RowLayout layout = layout_of(element, format);
    const auto count = static_cast<size_t>(element.count);
    if (!element.has_lists()) {
        read_rows(file, layout, count, buffer);
        return;
    }
    std::vector<unsigned char> row(layout.size);
    for (size_t i = 0; i < count; ++i) {
        walk_binary_row(file, element, format == PlyFormat::BigEndian,
                        [&](size_t property, const unsigned char* bytes) {
                            const RowField& field = layout.fields[property];
                            std::copy_n(bytes, scalar_size(field.type), &row[field.offset]);
                        });
        store_row(layout, row.data(), i, buffer);
    }
}

/// One ascii row as numbers, one per property (0 for lists, which are stepped over).
void parse_ascii_row(TextRow& row, const PlyElement& element, std::vector<double>& values)
{
    std::string_view token;
    for (size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (!row.next(token)) {
            row.fail(
                fmt::format("the row ends before property \"{}\"", printable(property.name, 40)));
        }
        values[i] = row.number(token);
        if (!property.list_count) continue;
        for (double entries = values[i]; entries > 0.0; entries -= 1.0) {
            if (!row.next(token)) row.fail("the row ends inside a list");
        }
    }
    if (row.next(token)) row.fail("more numbers than the header names");
}

NumberKind number_kind(const Binding& binding, const PlyProperty& property)
{
    if (binding.attribute != ParticleAttribute::Color) return NumberKind::Plain;
    if (property.type == ScalarType::U8) return NumberKind::Color8;
    return property.type == ScalarType::U16 ? NumberKind::Color16 : NumberKind::Plain;
}

void read_ascii(InputFile& file, const PlyElement& element, PointBuffer& buffer)
{
    std::vector<double> values(element.properties.size());
    std::string_view line;
    for (uint64_t i = 0; i < element.count;) {
        if (!file.next_line(line)) {
            throw Error(ExitCode::Input,
                        fmt::format("{}: truncated: it ends after {} of {} vertices", file.path(),
                                    i, element.count));
        }
        if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
        TextRow row(file.path(), file.line_number(), line);
        parse_ascii_row(row, element, values);
        for (const Binding& binding : buffer.bindings) {
            buffer.store(binding, static_cast<size_t>(i), values[binding.field],
                         number_kind(binding, element.properties[binding.field]));
        }
        ++i;
    }
}

}  // namespace

PointBuffer read_ply(const std::string& path, const PointRequest& request)
{
    InputFile file(path);
    const PlyHeader header = read_ply_header(file);
    for (const PlyElement& element : header.elements) {
        check_claim(file, element, header.format);
        if (element.name != "vertex") {
            skip_element(file, element, header.format);
            continue;
        }
        check_count(path, element.count, request.params);
        PointBuffer buffer;
        buffer.fields = fields_of(element);
        buffer.bindings = bind_attributes(path, buffer.fields, request.params, request.mask);
        if (request.header_only) return buffer;
        buffer.resize(static_cast<size_t>(element.count));
        if (header.format == PlyFormat::Ascii)
            read_ascii(file, element, buffer);
        else
            read_binary(file, element, header.format, buffer);
        return buffer;
    }
    throw Error(ExitCode::Input, fmt::format("{}: no element \"vertex\"", path));
}

}  // namespace mote
