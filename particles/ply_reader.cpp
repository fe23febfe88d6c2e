#include <algorithm>

#include "particles/ply_rows.h"
#include "particles/readers.h"

namespace mote {

namespace {

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
        walk_ply_row(
            file, element, format == PlyFormat::BigEndian,
            [&](size_t property, const unsigned char* bytes) {
                const RowField& field = layout.fields[property];
                std::copy_n(bytes, scalar_size(field.type), &row[field.offset]);
            },
            [&](size_t property, uint64_t entries) {
                file.skip(entries * scalar_size(element.properties[property].type));
            });
        store_row(layout, row.data(), i, buffer);
    }
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
    for_each_ply_line(file, element, [&](uint64_t i, TextRow& line) {
        walk_ply_line(
            line, element, [&](size_t property, double value) { values[property] = value; },
            [](size_t, double) {});
        for (const Binding& binding : buffer.bindings) {
            buffer.store(binding, static_cast<size_t>(i), values[binding.field],
                         number_kind(binding, element.properties[binding.field]));
        }
    });
}

}  // namespace

PointBuffer read_ply(const std::string& path, const PointRequest& request)
{
    InputFile file(path);
    const PlyHeader header = read_ply_header(file);
    for (const PlyElement& element : header.elements) {
        check_ply_claim(file, element, header.format);
        if (element.name != "vertex") {
            skip_ply_element(file, element, header.format);
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
