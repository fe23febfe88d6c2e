#pragma once

#include <deque>

#include "scene/fields.h"
#include "scene/node.h"
#include "scene/problems.h"

namespace mote {

/// Reads the values of a node tree into a description. Whatever is wrong goes to the problem list
/// and leaves the default in place, so that one run finds everything.
class NodeBinder : public FieldVisitor {
  public:
    /// `root` must be a table and outlive the binder.
    NodeBinder(const Node& root, Problems& problems);

    /// Reports the keys that no field asked for.
    void finish();

    void flag(const Field& field, bool& value) override;
    void integer(const Field& field, int64_t& value) override;
    void numbers(const Field& field, std::span<double> values) override;
    void text(const Field& field, std::string& value) override;
    void words(const Field& field, std::vector<std::string>& value,
               std::span<const char* const> allowed) override;
    void names(const Field& field, std::map<std::string, std::string>& value,
               std::span<const char* const> allowed) override;
    void choice(const Field& field, int& index, std::span<const char* const> allowed) override;
    bool has(const Field& field, bool present) override;
    void begin_table(const Field& field) override;
    void end_table() override;
    size_t begin_list(const Field& field, size_t count) override;
    void begin_item(size_t index) override;
    void end_item() override;
    void end_list() override;
    void select(const std::string& variant) override { levels_.back().variant = variant; }
    [[nodiscard]] bool assigns() const override { return true; }

  private:
    struct Level {
        const Node* node = nullptr;  ///< null: the table is not in the file
        std::string label;           ///< "[volumes]" in messages
        std::string path;            ///< "volumes"
        std::string variant;
        std::vector<std::string> known;
        std::vector<std::string> also;  ///< per known key
    };
    struct List {
        std::vector<const Node*> items;
        std::string path;
    };

    struct UnknownKey {
        const Node* node;
        std::string label;
        std::string hint;
    };

    const Node* take(const Field& field);
    void open(const Node* node, std::string path);
    void close();
    void wrong_kind(const Field& field, const Node& node, const std::string& wanted);
    bool check_range(const Field& field, const Node& node, double value);
    void know(const Field& field);
    [[nodiscard]] std::string place() const { return levels_.back().label; }

    Problems& problems_;
    std::vector<Level> levels_;
    std::vector<List> lists_;
    std::deque<Node> shorthand_tables_;
    std::map<std::string, std::string> places_;  ///< label of a table that has this key
    std::vector<UnknownKey> unknown_;            ///< told at the end, when all places are known
};

/// did_you_mean() that also knows words of other tools and beginnings of keys: "densty" suggests
/// density_scale. `also` holds blank-separated words per key.
[[nodiscard]] std::string suggest_key(const std::string& word,
                                      const std::vector<std::string>& known,
                                      const std::vector<std::string>& also);

}  // namespace mote
