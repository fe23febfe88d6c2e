#include "particles/npy_header.h"

#include <algorithm>
#include <cstring>

#include "particles/text_row.h"

namespace mote {

namespace {

constexpr size_t max_item_size = size_t{1} << 16;
constexpr size_t max_header = size_t{1} << 20;

[[noreturn]] void fail(const InputFile& file, const std::string& what)
{
    throw Error(ExitCode::Input, fmt::format("{}: {}", file.path(), what));
}

/// The few Python literals that NumPy writes: a dictionary of strings, booleans, tuples, lists.
class Literal {
  public:
    Literal(const InputFile& file, std::string_view text) : file_(file), text_(text) {}

    [[nodiscard]] bool accept(char c)
    {
        skip_blanks();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    void expect(char c)
    {
        if (!accept(c)) wrong(fmt::format("'{}' expected", c));
    }

    std::string string()
    {
        skip_blanks();
        const char quote = at_ < text_.size() ? text_[at_] : ' ';
        if (quote != '\'' && quote != '"') wrong("a string expected");
        const size_t end = text_.find(quote, at_ + 1);
        if (end == std::string_view::npos) wrong("a string without end");
        const std::string_view inside = text_.substr(at_ + 1, end - at_ - 1);
        if (inside.find('\\') != std::string_view::npos) wrong("escaped characters in a name");
        at_ = end + 1;
        return std::string(inside);
    }

    bool boolean()
    {
        skip_blanks();
        for (const bool value : {true, false}) {
            const std::string_view word = value ? "True" : "False";
            if (text_.substr(at_, word.size()) != word) continue;
            at_ += word.size();
            return value;
        }
        wrong("True or False expected");
    }

    /// "(1, 2)", "(3,)", "()" or a plain number.
    std::vector<uint64_t> numbers()
    {
        if (!accept('(')) return {number()};
        std::vector<uint64_t> values;
        while (!accept(')')) {
            if (values.size() >= 8) wrong("too many dimensions");
            values.push_back(number());
            if (!accept(',')) {
                expect(')');
                break;
            }
        }
        return values;
    }

    [[noreturn]] void wrong(const std::string& what) const
    {
        fail(file_, fmt::format("damaged NumPy header: {} at character {}", what, at_));
    }

  private:
    uint64_t number()
    {
        skip_blanks();
        uint64_t value = 0;
        const char* begin = text_.data() + at_;
        const auto [stop, error] = std::from_chars(begin, text_.data() + text_.size(), value);
        if (error != std::errc()) wrong("a number expected");
        at_ += static_cast<size_t>(stop - begin);
        return value;
    }

    void skip_blanks()
    {
        while (at_ < text_.size() && std::strchr(" \t\r\n", text_[at_])) ++at_;
    }

    const InputFile& file_;
    std::string_view text_;
    size_t at_ = 0;
};

/// "<f4" and the like; components 0 for padding ("|V4"), which is stepped over.
NpyField parse_type(const InputFile& file, const std::string& code, size_t& size)
{
    NpyField field;
    const char order = code.empty() ? ' ' : code[0];
    const std::string kind = code.size() > 1 ? code.substr(1) : "";
    field.layout.is_big_endian = order == '>';
    const bool has_order = order == '<' || order == '>' || order == '|' || order == '=';
    if (has_order && kind.size() > 1 && kind[0] == 'V' && TextRow::parse(kind.substr(1), size)) {
        field.components = 0;
        return field;
    }
    static constexpr std::pair<const char*, ScalarType> types[] = {
        {"i1", ScalarType::I8},  {"u1", ScalarType::U8},  {"b1", ScalarType::U8},
        {"i2", ScalarType::I16}, {"u2", ScalarType::U16}, {"i4", ScalarType::I32},
        {"u4", ScalarType::U32}, {"i8", ScalarType::I64}, {"u8", ScalarType::U64},
        {"f4", ScalarType::F32}, {"f8", ScalarType::F64},
    };
    for (const auto& [name, type] : types) {
        if (!has_order || kind != name) continue;
        field.layout.type = type;
        size = scalar_size(type);
        return field;
    }
    fail(file, fmt::format("dtype \"{}\" cannot be read; save numbers as float32, float64 or "
                           "integers, e.g. array.astype(numpy.float32)",
                           printable(code, 40)));
}

void add_field(const InputFile& file, NpyHeader& header, NpyField field, uint64_t bytes)
{
    if (bytes > max_item_size || header.item_size + bytes > max_item_size) {
        fail(file, fmt::format("an element of the array has more than {} bytes", max_item_size));
    }
    field.layout.offset = header.item_size;
    header.item_size += static_cast<size_t>(bytes);
    header.fields.push_back(std::move(field));
}

/// [('P', '<f4', (3,)), ('pscale', '<f4'), ...]
void parse_structure(const InputFile& file, Literal& literal, NpyHeader& header)
{
    header.is_structured = true;
    while (!literal.accept(']')) {
        literal.expect('(');
        if (literal.accept('(')) literal.wrong("field titles are not supported: a name expected");
        const std::string name = literal.string();
        literal.expect(',');
        if (literal.accept('[')) {
            fail(file, fmt::format("field \"{}\" is itself a structure; save flat fields",
                                   printable(name, 40)));
        }
        size_t size = 0;
        NpyField field = parse_type(file, literal.string(), size);
        field.name = name;
        uint64_t entries = 1;
        if (!literal.accept(',')) {
            literal.expect(')');
        } else if (!literal.accept(')')) {
            for (const uint64_t n : literal.numbers()) {
                entries = std::min<uint64_t>(entries * std::min<uint64_t>(n, max_item_size + 1),
                                             max_item_size + 1);
            }
            literal.expect(')');
        }
        const bool is_readable = field.components == 1 && (entries == 1 || entries == 3);
        field.components = is_readable ? static_cast<int>(entries) : 0;
        add_field(file, header, std::move(field),
                  entries * std::min<size_t>(size, max_item_size + 1));
        if (!literal.accept(',')) {
            literal.expect(']');
            break;
        }
    }
}

void parse_dictionary(const InputFile& file, std::string_view text, NpyHeader& header)
{
    Literal literal(file, text);
    bool has_descr = false;
    bool has_shape = false;
    bool has_order = false;
    literal.expect('{');
    while (!literal.accept('}')) {
        const std::string key = literal.string();
        literal.expect(':');
        if (key == "descr" && !has_descr) {
            has_descr = true;
            if (literal.accept('[')) {
                parse_structure(file, literal, header);
            } else {
                size_t size = 0;
                NpyField field = parse_type(file, literal.string(), size);
                add_field(file, header, std::move(field), size);
            }
        } else if (key == "fortran_order" && !has_order) {
            has_order = true;
            header.is_fortran = literal.boolean();
        } else if (key == "shape" && !has_shape) {
            has_shape = true;
            header.shape = literal.numbers();
        } else {
            literal.wrong(fmt::format("unexpected key \"{}\"", printable(key, 40)));
        }
        if (!literal.accept(',')) {
            literal.expect('}');
            break;
        }
    }
    if (!has_descr || !has_shape || !has_order) {
        fail(file, "damaged NumPy header: \"descr\", \"fortran_order\" or \"shape\" is missing");
    }
}

}  // namespace

NpyHeader read_npy_header(InputFile& file)
{
    static constexpr unsigned char magic[] = {0x93, 'N', 'U', 'M', 'P', 'Y'};
    if (file.remaining() < 10 || std::memcmp(file.take(6), magic, 6) != 0) {
        fail(file, "not a NumPy .npy file");
    }
    const int version = *file.take(2);
    if (version < 1 || version > 3) {
        fail(file,
             fmt::format("NumPy format version {} is unknown; versions 1 to 3 are read", version));
    }
    const ScalarType length_type = version == 1 ? ScalarType::U16 : ScalarType::U32;
    const auto length =
        static_cast<size_t>(load_scalar(file.take(scalar_size(length_type)), length_type, false));
    if (length > file.remaining() || length > max_header) {
        fail(file, fmt::format("the header claims {} bytes, but only {} follow", length,
                               file.remaining()));
    }
    const auto* text = reinterpret_cast<const char*>(file.take(length));
    const std::string copy(text, length);
    NpyHeader header;
    parse_dictionary(file, copy, header);
    return header;
}

}  // namespace mote
