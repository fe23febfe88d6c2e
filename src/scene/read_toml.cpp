#include <toml++/toml.h>

#include "core/text.h"
#include "scene/node.h"

namespace mote {
namespace {

SourcePosition to_position(const toml::source_region& source)
{
    return {static_cast<int>(source.begin.line), static_cast<int>(source.begin.column), -1};
}

/// Refuses keys of many parts ("a.a.a.a..."): the library nests a table per part without limit,
/// and deep trees overflow the stack when they are destroyed.
void check_dotted_keys(std::string_view text)
{
    int line = 1;
    int dots = 0;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"' || c == '\'') {
            const std::string triple(3, c);
            const bool multi_line = text.substr(i, 3) == triple;
            i += multi_line ? 3 : 1;
            for (; i < text.size(); ++i) {
                if (c == '"' && text[i] == '\\') {
                    ++i;
                } else if (multi_line ? text.substr(i, 3) == triple : text[i] == c) {
                    i += multi_line ? 2 : 0;
                    break;
                } else if (text[i] == '\n') {
                    ++line;
                    if (!multi_line) break;
                }
            }
        } else if (c == '#') {
            while (i + 1 < text.size() && text[i + 1] != '\n') ++i;
        } else if (c == '.') {
            if (++dots > max_scene_depth) throw SyntaxError{{line, 1, -1}, "key of too many parts"};
        } else if (c == '\n' || c == ',' || c == '=' || c == '[' || c == '{') {
            dots = 0;
            if (c == '\n') ++line;
        }
    }
}

class TomlConverter {
  public:
    Node convert(const toml::node& from, int depth)
    {
        Node node;
        node.where = to_position(from.source());
        if (depth > max_scene_depth) throw SyntaxError{node.where, "nested too deeply"};
        if (++count_ > max_scene_values) throw SyntaxError{node.where, "too many values"};
        if (const auto* table = from.as_table()) {
            node.kind = Node::Kind::Table;
            node.children.reserve(table->size());
            for (const auto& [key, value] : *table) {
                Node child = convert(value, depth + 1);
                child.key = std::string(key.str());
                child.key_where = to_position(key.source());
                node.children.push_back(std::move(child));
            }
        } else if (const auto* array = from.as_array()) {
            node.kind = Node::Kind::Array;
            node.children.reserve(array->size());
            for (const toml::node& item : *array) node.children.push_back(convert(item, depth + 1));
        } else if (const auto* text = from.as_string()) {
            node.kind = Node::Kind::String;
            node.text = text->get();
        } else if (const auto* integer = from.as_integer()) {
            node.kind = Node::Kind::Integer;
            node.integer = integer->get();
        } else if (const auto* number = from.as_floating_point()) {
            node.kind = Node::Kind::Float;
            node.number = number->get();
        } else if (const auto* flag = from.as_boolean()) {
            node.kind = Node::Kind::Bool;
            node.integer = flag->get() ? 1 : 0;
        } else {
            node.kind = Node::Kind::Date;
        }
        return node;
    }

  private:
    size_t count_ = 0;
};

}  // namespace

Node parse_toml(std::string_view text)
{
    check_dotted_keys(text);
    try {
        const toml::table table = toml::parse(text);
        return TomlConverter().convert(table, 0);
    } catch (const toml::parse_error& error) {
        throw SyntaxError{to_position(error.source()), printable(error.description())};
    }
}

}  // namespace mote
