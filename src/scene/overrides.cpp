#include "scene/overrides.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "core/text.h"

namespace mote {
namespace {

/// Marks a tree as written by an override.
void set_positions(Node& node, const SourcePosition& where)
{
    node.where = where;
    node.key_where = where;
    for (Node& child : node.children) set_positions(child, where);
}

/// The value in TOML syntax, or the text itself where it is not TOML ("out/a.####.exr", plume).
/// Quotes and brackets announce TOML, so that a mistake inside them is told.
Node parse_value(const std::string& text)
{
    Node as_text;
    as_text.kind = Node::Kind::String;
    as_text.text = text;
    const bool is_quoted = !text.empty() && std::string("[{\"'").find(text[0]) != std::string::npos;
    if (!is_quoted && text.find_first_of("#\n\r") != std::string::npos) return as_text;
    try {
        Node table = parse_toml("value = " + text);
        if (table.children.size() == 1) return std::move(table.children.front());
        return as_text;
    } catch (const SyntaxError&) {
        if (is_quoted) throw;
        return as_text;
    }
}

bool is_index(const std::string& part, size_t& index)
{
    const auto result = std::from_chars(part.data(), part.data() + part.size(), index);
    return result.ec == std::errc() && result.ptr == part.data() + part.size();
}

/// Entry of a list by number or by its "name"; null after reporting what there is instead.
Node* find_entry(Node& list, const std::string& part, const std::string& list_path,
                 const SourcePosition& where, Problems& problems)
{
    size_t number = 0;
    if (is_index(part, number)) {
        if (number < list.children.size()) return &list.children[number];
        problems.add(where, fmt::format("\"{}\" has {} entries, counted from 0", list_path,
                                        list.children.size()));
        return nullptr;
    }
    std::vector<std::string> names;
    for (Node& entry : list.children) {
        const Node* name = entry.find("name");
        if (!name || name->kind != Node::Kind::String) continue;
        if (name->text == part) return &entry;
        names.push_back(name->text);
    }
    problems.add(where, fmt::format("no entry of [[{}]] is named \"{}\"{}", list_path,
                                    printable(part, 60), did_you_mean(part, names)));
    return nullptr;
}

}  // namespace

void apply_override(Node& root, const std::string& text, int index, Problems& problems)
{
    const SourcePosition where{0, 0, index};
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
        problems.add(where, "must look like key.key=value");
        return;
    }
    const std::string path = text.substr(0, equals);
    Node value;
    try {
        value = parse_value(text.substr(equals + 1));
    } catch (const SyntaxError& error) {
        problems.add(where, "value is not TOML: " + error.message);
        return;
    }
    set_positions(value, where);

    Node* node = &root;
    std::string walked;
    size_t begin = 0;
    int depth = 0;
    while (begin <= path.size()) {
        const size_t end = std::min(path.find('.', begin), path.size());
        const std::string part = path.substr(begin, end - begin);
        const bool is_last = end == path.size();
        begin = end + 1;
        if (part.empty() || ++depth > max_scene_depth) {
            problems.add(where, "must look like key.key=value");
            return;
        }
        if (node->kind == Node::Kind::Array) {
            node = find_entry(*node, part, walked, where, problems);
            if (!node) return;
        } else if (node->kind == Node::Kind::Table) {
            auto child = std::find_if(node->children.begin(), node->children.end(),
                                      [&](const Node& c) { return c.key == part; });
            if (child == node->children.end()) {
                Node made;
                made.kind = Node::Kind::Table;
                made.key = part;
                made.where = made.key_where = where;
                node->children.push_back(std::move(made));
                child = std::prev(node->children.end());
            }
            node = &*child;
        } else {
            problems.add(where, fmt::format("\"{}\" is {}, it has no \"{}\"", walked,
                                            kind_name(node->kind), printable(part, 60)));
            return;
        }
        walked += (walked.empty() ? "" : ".") + part;
        if (is_last) {
            value.key = std::move(node->key);
            *node = std::move(value);
            return;
        }
    }
}

}  // namespace mote
