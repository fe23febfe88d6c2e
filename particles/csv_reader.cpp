#include <algorithm>

#include "particles/input_file.h"
#include "particles/readers.h"
#include "particles/text_row.h"

namespace mote {

namespace {

constexpr size_t max_columns = 1'000;

bool is_blank_line(std::string_view line)
{
    return line.find_first_not_of(" \t") == std::string_view::npos;
}

bool is_comment(std::string_view line)
{
    const size_t first = line.find_first_not_of(" \t");
    return first != std::string_view::npos && line[first] == '#';
}

char find_separator(std::string_view names)
{
    for (const char separator : {'\t', ';', ','}) {
        if (names.find(separator) != std::string_view::npos) return separator;
    }
    return ' ';
}

std::vector<FileField> parse_names(const InputFile& file, int line_number, std::string_view line,
                                   char separator)
{
    std::vector<FileField> fields;
    TextRow row(file.path(), line_number, line, separator);
    std::string_view name;
    while (row.next(name)) {
        if (name.size() >= 2 && name.front() == '"' && name.back() == '"') {
            name = name.substr(1, name.size() - 2);
        }
        if (fields.size() >= max_columns) row.fail("too many columns");
        fields.push_back({std::string(name), 1});
    }
    return fields;
}

bool all_numbers(const InputFile& file, std::string_view line)
{
    TextRow row(file.path(), 1, line, find_separator(line));
    std::string_view token;
    double value = 0.0;
    bool any = false;
    while (row.next(token)) {
        if (!TextRow::parse(token, value)) return false;
        any = true;
    }
    return any;
}

/// The names, and the first line of numbers if it has been read already.
struct CsvHeader {
    std::vector<FileField> fields;
    char separator = ',';
    std::string first_row;  ///< not empty: the names stood in a comment
};

CsvHeader read_header(InputFile& file)
{
    CsvHeader header;
    std::string comment;
    int comment_line = 0;
    std::string_view line;
    while (file.next_line(line)) {
        if (file.line_number() == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
        if (is_blank_line(line)) continue;
        if (is_comment(line)) {
            comment = line.substr(line.find('#') + 1);
            comment_line = file.line_number();
            continue;
        }
        if (!all_numbers(file, line)) {
            header.separator = find_separator(line);
            header.fields = parse_names(file, file.line_number(), line, header.separator);
            return header;
        }
        if (comment.empty()) {
            throw Error(ExitCode::Input,
                        fmt::format("{}:{}:1: numbers without names; the first row must name the "
                                    "columns, e.g. x,y,z,vx,vy,vz",
                                    file.path(), file.line_number()));
        }
        header.separator = find_separator(comment);
        header.fields = parse_names(file, comment_line, comment, header.separator);
        header.first_row = line;
        return header;
    }
    throw Error(ExitCode::Input, fmt::format("{}: no row of column names", file.path()));
}

void store_row(TextRow& row, size_t index, const std::vector<std::vector<Binding>>& by_column,
               PointBuffer& buffer)
{
    std::string_view token;
    for (const auto& bindings : by_column) {
        if (!row.next(token)) {
            row.fail(fmt::format("the row has fewer than {} columns", by_column.size()));
        }
        for (const Binding& binding : bindings) {
            int64_t id = 0;
            if (binding.attribute == ParticleAttribute::Id && TextRow::parse(token, id)) {
                buffer.store_id(index, id);
            } else {
                buffer.store(binding, index, row.number(token), NumberKind::Plain);
            }
        }
    }
    if (row.next(token)) row.fail(fmt::format("more than {} columns", by_column.size()));
}

}  // namespace

PointBuffer read_csv(const std::string& path, const PointRequest& request)
{
    InputFile file(path);
    const CsvHeader header = read_header(file);
    PointBuffer buffer;
    buffer.fields = header.fields;
    buffer.bindings = bind_attributes(path, buffer.fields, request.params, request.mask);
    if (request.header_only) return buffer;
    std::vector<std::vector<Binding>> by_column(buffer.fields.size());
    for (const Binding& binding : buffer.bindings) by_column[binding.field].push_back(binding);

    size_t count = 0;
    size_t room = 0;
    std::string_view line = header.first_row;
    for (bool more = !line.empty() || file.next_line(line); more; more = file.next_line(line)) {
        if (is_blank_line(line) || is_comment(line)) continue;
        if (count == room) {
            // Two bytes a number is the least a row takes: an upper bound for what can follow.
            const size_t most = count + 1 + static_cast<size_t>(file.remaining()) / 2;
            room = std::min(most, std::max<size_t>(1024, 2 * room));
            buffer.resize(room);
        }
        check_count(path, count + 1, request.params);
        TextRow row(path, file.line_number(), line, header.separator);
        store_row(row, count, by_column, buffer);
        ++count;
    }
    buffer.resize(count);
    return buffer;
}

}  // namespace mote
