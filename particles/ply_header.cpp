#include "particles/ply_header.h"

#include <array>
#include <utility>

#include "particles/text_row.h"

namespace mote {

namespace {

constexpr int max_lines = 10'000;
constexpr size_t max_properties = 1'000;

ScalarType parse_type(const TextRow& row, std::string_view name)
{
    static constexpr std::array<std::pair<std::string_view, ScalarType>, 16> types{{
        {"char", ScalarType::I8},
        {"int8", ScalarType::I8},
        {"uchar", ScalarType::U8},
        {"uint8", ScalarType::U8},
        {"short", ScalarType::I16},
        {"int16", ScalarType::I16},
        {"ushort", ScalarType::U16},
        {"uint16", ScalarType::U16},
        {"int", ScalarType::I32},
        {"int32", ScalarType::I32},
        {"uint", ScalarType::U32},
        {"uint32", ScalarType::U32},
        {"float", ScalarType::F32},
        {"float32", ScalarType::F32},
        {"double", ScalarType::F64},
        {"float64", ScalarType::F64},
    }};
    for (const auto& [known, type] : types) {
        if (known == name) return type;
    }
    row.fail(
        fmt::format("unknown property type \"{}\"; PLY has char, uchar, short, ushort, int, "
                    "uint, float and double",
                    printable(name, 40)));
}

std::string_view word(TextRow& row, const char* what)
{
    std::string_view token;
    if (!row.next(token)) row.fail(fmt::format("{} is missing", what));
    return token;
}

PlyFormat parse_format(TextRow& row)
{
    const std::string_view name = word(row, "the format");
    PlyFormat format = PlyFormat::Ascii;
    if (name == "binary_little_endian")
        format = PlyFormat::LittleEndian;
    else if (name == "binary_big_endian")
        format = PlyFormat::BigEndian;
    else if (name != "ascii")
        row.fail(fmt::format("unknown format \"{}\"", printable(name, 40)));
    const std::string_view version = word(row, "the version");
    if (version != "1.0") row.fail(fmt::format("unknown version \"{}\"", printable(version, 40)));
    return format;
}

PlyElement parse_element(TextRow& row)
{
    PlyElement element;
    element.name = word(row, "the element's name");
    const std::string_view count = word(row, "the element's count");
    if (!TextRow::parse(count, element.count)) {
        row.fail(fmt::format("\"{}\" is not a count", printable(count, 40)));
    }
    return element;
}

PlyProperty parse_property(TextRow& row)
{
    PlyProperty property;
    std::string_view type = word(row, "the property's type");
    if (type == "list") {
        property.list_count = parse_type(row, word(row, "the type of the list's length"));
        type = word(row, "the type of the list's entries");
    }
    property.type = parse_type(row, type);
    property.name = word(row, "the property's name");
    return property;
}

}  // namespace

bool PlyElement::has_lists() const
{
    for (const PlyProperty& property : properties) {
        if (property.list_count) return true;
    }
    return false;
}

size_t PlyElement::smallest_row() const
{
    size_t size = 0;
    for (const PlyProperty& property : properties) {
        size += scalar_size(property.list_count.value_or(property.type));
    }
    return size;
}

PlyHeader read_ply_header(InputFile& file)
{
    PlyHeader header;
    bool has_format = false;
    std::string_view line;
    while (file.next_line(line)) {
        TextRow row(file.path(), file.line_number(), line);
        std::string_view key;
        if (file.line_number() == 1) {
            if (line != "ply") row.fail("not a PLY file: the first line must be \"ply\"");
            continue;
        }
        if (file.line_number() > max_lines) row.fail("no \"end_header\" so far: not a PLY file");
        if (!row.next(key) || key == "comment" || key == "obj_info") continue;
        if (key == "end_header") {
            if (!has_format) row.fail("the header has no \"format\" line");
            return header;
        }
        if (key == "format") {
            header.format = parse_format(row);
            has_format = true;
        } else if (key == "element") {
            header.elements.push_back(parse_element(row));
        } else if (key == "property") {
            if (header.elements.empty()) row.fail("a property before the first element");
            auto& properties = header.elements.back().properties;
            if (properties.size() >= max_properties) row.fail("too many properties");
            properties.push_back(parse_property(row));
        } else {
            row.fail(fmt::format("unknown keyword \"{}\"", printable(key, 40)));
        }
    }
    throw Error(ExitCode::Input,
                fmt::format("{}: truncated: the header has no \"end_header\"", file.path()));
}

}  // namespace mote
