#include "scene/bind.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text.h"

namespace mote {
namespace {

/// More entries than any list of a scene needs; they bound the memory of hostile files.
constexpr size_t max_list_entries = 100'000;

bool contains_word(const std::string& blank_separated, const std::string& word)
{
    std::istringstream words(blank_separated);
    std::string each;
    while (words >> each) {
        if (each == word) return true;
    }
    return false;
}

std::string quoted(const std::string& text)
{
    return '"' + printable(text, 60) + '"';
}

std::vector<std::string> to_strings(std::span<const char* const> words)
{
    return {words.begin(), words.end()};
}

/// Files must be openable: a NUL ends a path early in the operating system.
bool is_clean_text(const std::string& text)
{
    return std::none_of(text.begin(), text.end(),
                        [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

}  // namespace

std::string suggest_key(const std::string& word, const std::vector<std::string>& known,
                        const std::vector<std::string>& also)
{
    for (size_t i = 0; i < known.size(); ++i) {
        if (contains_word(also[i], word)) return fmt::format(" (did you mean \"{}\"?)", known[i]);
    }
    if (std::string direct = did_you_mean(word, known); !direct.empty()) return direct;
    for (const std::string& key : known) {
        const size_t underscore = key.find('_');
        if (underscore == std::string::npos) continue;
        const std::vector<std::string> beginning{key.substr(0, underscore)};
        if (!did_you_mean(word, beginning).empty()) {
            return fmt::format(" (did you mean \"{}\"?)", key);
        }
    }
    return "";
}

NodeBinder::NodeBinder(const Node& root, Problems& problems) : problems_(problems)
{
    open(&root, "");
}

void NodeBinder::finish()
{
    close();
    for (const UnknownKey& unknown : unknown_) {
        const auto elsewhere = places_.find(unknown.node->key);
        const bool is_misplaced = unknown.hint.empty() && elsewhere != places_.end();
        problems_.add(unknown.node->key_where,
                      fmt::format("unknown key {} {}{}", quoted(unknown.node->key), unknown.label,
                                  is_misplaced ? fmt::format(" (it belongs {})", elsewhere->second)
                                               : unknown.hint));
    }
}

void NodeBinder::open(const Node* node, std::string path)
{
    Level level;
    level.node = node;
    level.label = path.empty() ? "at the top level" : fmt::format("in [{}]", path);
    level.path = std::move(path);
    levels_.push_back(std::move(level));
}

void NodeBinder::close()
{
    const Level level = std::move(levels_.back());
    levels_.pop_back();
    if (!level.node) return;
    std::vector<const Node*> members;
    for (const Node& member : level.node->children) members.push_back(&member);
    std::stable_sort(members.begin(), members.end(),
                     [](const Node* a, const Node* b) { return a->key < b->key; });
    for (size_t i = 0; i < members.size(); ++i) {
        const Node& member = *members[i];
        if (i > 0 && members[i - 1]->key == member.key) {
            problems_.add(member.key_where,
                          fmt::format("key {} {} is given twice", quoted(member.key), level.label));
            continue;
        }
        if (std::find(level.known.begin(), level.known.end(), member.key) != level.known.end()) {
            continue;
        }
        if (level.path.empty() && member.key == "$schema") continue;  // for editors
        if (unknown_.size() > 10'000) continue;                       // far more than are shown
        std::string hint =
            unknown_.size() < 100 ? suggest_key(member.key, level.known, level.also) : "";
        unknown_.push_back({&member, level.label, std::move(hint)});
    }
}

void NodeBinder::know(const Field& field)
{
    Level& level = levels_.back();
    level.known.emplace_back(field.key);
    level.also.emplace_back(field.also);
    places_.emplace(field.key, level.label);
}

/// The node of a field, if the file has one that may be read.
const Node* NodeBinder::take(const Field& field)
{
    know(field);
    const Level& level = levels_.back();
    const Node* node = level.node ? level.node->find(field.key) : nullptr;
    if (!node && field.required && level.node) {
        problems_.add(level.node->where, fmt::format("missing key \"{}\" {}", field.key, place()));
    }
    if (node && *field.used_by && !level.variant.empty() &&
        !contains_word(field.used_by, level.variant)) {
        problems_.add(node->key_where,
                      fmt::format("\"{}\" {} has no meaning with \"{}\"; it is for: {}", field.key,
                                  place(), level.variant, field.used_by));
        return nullptr;
    }
    return node;
}

void NodeBinder::wrong_kind(const Field& field, const Node& node, const std::string& wanted)
{
    problems_.add(node.where, fmt::format("\"{}\" {} must be {}, not {}", field.key, place(),
                                          wanted, kind_name(node.kind)));
}

bool NodeBinder::check_range(const Field& field, const Node& node, double value)
{
    if (!std::isfinite(value)) {
        problems_.add(node.where, fmt::format("\"{}\" {} must be finite", field.key, place()));
        return false;
    }
    const Range& range = field.range;
    const bool low = range.lo_open ? !(value > range.lo) : !(value >= range.lo);
    const bool high = range.hi_open ? !(value < range.hi) : !(value <= range.hi);
    if (!low && !high) return true;
    // What is documented leaves out limits that nobody meets; here one has been met.
    std::string allowed = describe_range(field);
    if (allowed.empty() || (high && value > 1e6)) {
        allowed = fmt::format("{} to {}", format_number(range.lo, field.is_float),
                              format_number(range.hi, field.is_float));
    }
    const std::string unit = *field.unit ? fmt::format(" [{}]", field.unit) : "";
    problems_.add(node.where, fmt::format("\"{}\" {} is {}, allowed: {}{}", field.key, place(),
                                          format_number(value, field.is_float), allowed, unit));
    return false;
}

void NodeBinder::flag(const Field& field, bool& value)
{
    const Node* node = take(field);
    if (!node) return;
    if (node->kind != Node::Kind::Bool) return wrong_kind(field, *node, "true or false");
    value = node->integer != 0;
}

void NodeBinder::integer(const Field& field, int64_t& value)
{
    const Node* node = take(field);
    if (!node) return;
    const bool is_whole =
        node->kind == Node::Kind::Integer ||
        (node->kind == Node::Kind::Float && std::isfinite(node->number) &&
         node->number == std::round(node->number) && std::abs(node->number) < 9e15);
    if (!is_whole) {
        if (node->kind == Node::Kind::Float) {
            problems_.add(node->where, fmt::format("\"{}\" {} must be a whole number, not {}",
                                                   field.key, place(), node->number));
            return;
        }
        return wrong_kind(field, *node, "a whole number");
    }
    const int64_t number =
        node->kind == Node::Kind::Integer ? node->integer : static_cast<int64_t>(node->number);
    if (check_range(field, *node, static_cast<double>(number))) value = number;
}

void NodeBinder::numbers(const Field& field, std::span<double> values)
{
    const Node* node = take(field);
    if (!node) return;
    const bool is_vector = values.size() > 1;
    const bool is_scalar = node->is_number() && (!is_vector || field.scalar_ok);
    const char* wanted = !is_vector        ? "a number"
                         : field.scalar_ok ? "a number or a list of 3 numbers"
                                           : "a list of 3 numbers";
    if (!is_scalar && (!is_vector || node->kind != Node::Kind::Array)) {
        return wrong_kind(field, *node, wanted);
    }
    if (!is_scalar && node->children.size() != values.size()) {
        problems_.add(node->where, fmt::format("\"{}\" {} must be {}, not of {}", field.key,
                                               place(), wanted, node->children.size()));
        return;
    }
    std::array<double, 3> read{};
    for (size_t i = 0; i < values.size(); ++i) {
        const Node& item = is_scalar ? *node : node->children[i];
        if (!item.is_number()) return wrong_kind(field, item, wanted);
        read[i] = item.as_number();
        if (field.is_float) read[i] = static_cast<double>(static_cast<float>(read[i]));
        if (!check_range(field, item, read[i])) return;
    }
    std::copy_n(read.begin(), values.size(), values.begin());
}

void NodeBinder::text(const Field& field, std::string& value)
{
    const Node* node = take(field);
    if (!node) return;
    if (node->kind != Node::Kind::String) return wrong_kind(field, *node, "text");
    if (!is_clean_text(node->text) || node->text.size() > 4096) {
        problems_.add(node->where,
                      fmt::format("\"{}\" {} has control characters or is longer than 4096 bytes",
                                  field.key, place()));
        return;
    }
    value = node->text;
}

void NodeBinder::words(const Field& field, std::vector<std::string>& value,
                       std::span<const char* const> allowed)
{
    const Node* node = take(field);
    if (!node) return;
    if (node->kind != Node::Kind::Array) return wrong_kind(field, *node, "a list of texts");
    value.clear();
    for (const Node& item : node->children) {
        if (item.kind != Node::Kind::String) {
            wrong_kind(field, item, "a list of texts");
        } else if (std::find(allowed.begin(), allowed.end(), item.text) == allowed.end()) {
            const std::vector<std::string> known = to_strings(allowed);
            const std::string hint = problems_.is_full() ? "" : did_you_mean(item.text, known);
            problems_.add(item.where,
                          fmt::format("unknown {} in \"{}\" {}{}; known: {}", quoted(item.text),
                                      field.key, place(), hint, fmt::join(known, ", ")));
        } else if (std::find(value.begin(), value.end(), item.text) != value.end()) {
            problems_.add(item.where, fmt::format("{} is twice in \"{}\" {}", quoted(item.text),
                                                  field.key, place()));
        } else {
            value.push_back(item.text);
        }
    }
}

void NodeBinder::names(const Field& field, std::map<std::string, std::string>& value,
                       std::span<const char* const> allowed)
{
    const Node* node = take(field);
    if (!node) return;
    if (node->kind != Node::Kind::Table) return wrong_kind(field, *node, "a table of texts");
    open(node, levels_.back().path.empty() ? field.key : levels_.back().path + "." + field.key);
    for (const char* key : allowed) {
        std::string name;
        text({.key = key, .doc = ""}, name);
        if (!name.empty()) value[key] = name;
    }
    close();
}

void NodeBinder::choice(const Field& field, int& index, std::span<const char* const> allowed)
{
    const Node* node = take(field);
    if (!node) return;
    if (node->kind != Node::Kind::String) return wrong_kind(field, *node, "text");
    for (size_t i = 0; i < allowed.size(); ++i) {
        if (node->text == allowed[i]) {
            index = static_cast<int>(i);
            return;
        }
    }
    const std::vector<std::string> known = to_strings(allowed);
    const std::string hint = problems_.is_full() ? "" : did_you_mean(node->text, known);
    problems_.add(node->where, fmt::format("\"{}\" {} is {}{}; known: {}", field.key, place(),
                                           quoted(node->text), hint, fmt::join(known, ", ")));
}

bool NodeBinder::has(const Field& field, bool)
{
    const Level& level = levels_.back();
    const Node* node = level.node ? level.node->find(field.key) : nullptr;
    if (node) return true;
    know(field);
    return false;
}

void NodeBinder::begin_table(const Field& field)
{
    const Node* node = take(field);
    const std::string& outer = levels_.back().path;
    const std::string path = outer.empty() ? field.key : outer + "." + field.key;
    if (node && node->kind != Node::Kind::Table) {
        const bool is_value = node->kind == Node::Kind::String || node->is_number();
        if (is_value && *field.shorthand) {
            Node table;
            table.kind = Node::Kind::Table;
            table.where = node->where;
            table.children.push_back(*node);
            table.children.back().key = field.shorthand;
            shorthand_tables_.push_back(std::move(table));
            node = &shorthand_tables_.back();
        } else {
            wrong_kind(field, *node, "a table");
            node = nullptr;
        }
    }
    open(node, path);
}

void NodeBinder::end_table()
{
    close();
}

size_t NodeBinder::begin_list(const Field& field, size_t)
{
    const Node* node = take(field);
    const std::string& outer = levels_.back().path;
    List list;
    list.path = outer.empty() ? field.key : outer + "." + field.key;
    if (node && node->kind == Node::Kind::Table && field.single_ok) {
        list.items.push_back(node);
    } else if (node && node->kind != Node::Kind::Array) {
        wrong_kind(field, *node, fmt::format("a list of tables ([[{}]])", list.path));
    } else if (node && node->children.size() > max_list_entries) {
        problems_.add(node->where, fmt::format("\"{}\" has {} entries, allowed: at most {}",
                                               field.key, node->children.size(), max_list_entries));
    } else if (node) {
        for (const Node& item : node->children) {
            if (item.kind == Node::Kind::Table) {
                list.items.push_back(&item);
            } else {
                wrong_kind(field, item, fmt::format("a list of tables ([[{}]])", list.path));
            }
        }
    }
    lists_.push_back(std::move(list));
    return lists_.back().items.size();
}

void NodeBinder::begin_item(size_t index)
{
    open(lists_.back().items[index], lists_.back().path);
}

void NodeBinder::end_item()
{
    close();
}

void NodeBinder::end_list()
{
    lists_.pop_back();
}

}  // namespace mote
