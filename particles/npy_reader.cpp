#include "particles/npy_header.h"
#include "particles/readers.h"
#include "particles/text_row.h"

namespace mote {

namespace {

std::string shape_text(const NpyHeader& header)
{
    return fmt::format("({}{})", fmt::join(header.shape, ", "),
                       header.shape.size() == 1 ? "," : "");
}

void check_claim(const InputFile& file, uint64_t count, size_t row)
{
    if (row > 0 && count <= file.remaining() / row) return;
    throw Error(ExitCode::Input,
                fmt::format("{}: the header claims {} rows of {} bytes, but only {} bytes follow",
                            file.path(), count, row, file.remaining()));
}

/// An (N, 3) array: its columns become the fields x, y, z.
RowLayout positions_only(const NpyHeader& header, PointBuffer& buffer)
{
    RowLayout layout;
    RowField field = header.fields[0].layout;
    for (const char* name : {"x", "y", "z"}) {
        buffer.fields.push_back({name, 1});
        layout.fields.push_back(field);
        field.offset += header.item_size;
    }
    layout.size = 3 * header.item_size;
    return layout;
}

RowLayout structured(const NpyHeader& header, PointBuffer& buffer)
{
    RowLayout layout;
    layout.size = header.item_size;
    for (const NpyField& field : header.fields) {
        buffer.fields.push_back({field.name, field.components});
        layout.fields.push_back(field.layout);
    }
    return layout;
}

/// Fortran order: all x, then all y, then all z.
void read_columns(InputFile& file, const RowLayout& layout, size_t count, PointBuffer& buffer)
{
    const std::vector<Binding> all = buffer.bindings;
    for (size_t column = 0; column < layout.fields.size(); ++column) {
        RowLayout single;
        single.size = scalar_size(layout.fields[column].type);
        single.fields = {layout.fields[column]};
        single.fields[0].offset = 0;
        buffer.bindings.clear();
        for (Binding binding : all) {
            if (binding.field != column) continue;
            binding.field = 0;
            buffer.bindings.push_back(binding);
        }
        read_rows(file, single, count, buffer);
    }
    buffer.bindings = all;
}

}  // namespace

PointBuffer read_npy(const std::string& path, const PointRequest& request)
{
    InputFile file(path);
    const NpyHeader header = read_npy_header(file);
    const bool is_table = header.shape.size() == 2 && header.shape[1] == 3;
    if (header.is_structured ? header.shape.size() != 1 : !is_table) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: shape {} is not a list of particles; it must be (N, 3) for "
                                "positions alone, or (N,) with named fields, e.g. dtype [('P', "
                                "'<f4', (3,)), ('v', '<f4', (3,)), ('pscale', '<f4')]",
                                path, shape_text(header)));
    }
    PointBuffer buffer;
    const RowLayout layout =
        header.is_structured ? structured(header, buffer) : positions_only(header, buffer);
    if (!header.is_structured && header.fields[0].components != 1) {
        throw Error(ExitCode::Input, fmt::format("{}: the array holds no numbers", path));
    }
    check_claim(file, header.shape[0], layout.size);
    check_count(path, header.shape[0], request.params);
    buffer.bindings = bind_attributes(path, buffer.fields, request.params, request.mask);
    if (request.header_only) return buffer;
    const auto count = static_cast<size_t>(header.shape[0]);
    buffer.resize(count);
    if (header.is_fortran && !header.is_structured)
        read_columns(file, layout, count, buffer);
    else
        read_rows(file, layout, count, buffer);
    return buffer;
}

}  // namespace mote
