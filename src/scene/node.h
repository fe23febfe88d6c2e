#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mote {

/// Where a value was written: line and column (from 1) of the scene file, or the number of the
/// `--set` override that brought it.
struct SourcePosition {
    int line = 0;
    int column = 0;
    int override_index = -1;
};

/// A value of a scene file, TOML or JSON, with its position: what both readers make and what the
/// field list reads.
struct Node {
    enum class Kind { Null, Bool, Integer, Float, String, Date, Array, Table };

    Kind kind = Kind::Null;
    SourcePosition where;
    std::string key;  ///< in a table
    SourcePosition key_where;
    int64_t integer = 0;         ///< Integer and Bool
    double number = 0.0;         ///< Float
    std::string text;            ///< String
    std::vector<Node> children;  ///< Array: entries; Table: members

    [[nodiscard]] bool is_number() const { return kind == Kind::Integer || kind == Kind::Float; }
    [[nodiscard]] double as_number() const
    {
        return kind == Kind::Integer ? static_cast<double>(integer) : number;
    }
    /// Member of a table; null if there is none.
    [[nodiscard]] const Node* find(std::string_view name) const;
};

/// "a table", "text", ... for messages.
[[nodiscard]] const char* kind_name(Node::Kind kind);

/// Limits on scene files: they are written by hand or by small scripts, and bigger ones are damage
/// or malice. They bound the memory that reading takes to a few hundred megabytes.
inline constexpr size_t max_scene_bytes = 4'000'000;
inline constexpr size_t max_scene_values = 500'000;
inline constexpr int max_scene_depth = 32;

/// A syntax error: where, and what the parser says.
struct SyntaxError {
    SourcePosition where;
    std::string message;
};

/// Parses a whole file. Throws SyntaxError.
[[nodiscard]] Node parse_toml(std::string_view text);
[[nodiscard]] Node parse_json(std::string_view text);

}  // namespace mote
