#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/fields.h"
#include "scene/scene_io.h"

namespace mote {
namespace {

/// Writes one table of documentation per table of a scene file.
class ReferenceVisitor : public FieldVisitor {
  public:
    ReferenceVisitor() { open("Top level", ""); }

    void flag(const Field& field, bool& value) override
    {
        row(field, "true or false", "", value ? "true" : "false");
    }
    void integer(const Field& field, int64_t& value) override
    {
        row(field, "whole number", describe_range(field), std::to_string(value));
    }
    void numbers(const Field& field, std::span<double> values) override
    {
        std::vector<std::string> parts;
        for (const double value : values) parts.push_back(format_number(value, field.is_float));
        const bool is_vector = values.size() > 1;
        const char* type = !is_vector ? "number" : field.scalar_ok ? "number or 3" : "3 numbers";
        row(field, type, describe_range(field),
            is_vector ? fmt::format("[{}]", fmt::join(parts, ", ")) : parts[0]);
    }
    void text(const Field& field, std::string& value) override
    {
        row(field, "text", "", value.empty() ? "" : '"' + value + '"');
    }
    void words(const Field& field, std::vector<std::string>&,
               std::span<const char* const> allowed) override
    {
        row(field, "list of texts", fmt::format("{}", fmt::join(allowed, ", ")), "[]");
    }
    void names(const Field& field, std::map<std::string, std::string>&,
               std::span<const char* const> allowed) override
    {
        row(field, "table of texts", fmt::format("{}", fmt::join(allowed, ", ")), "");
    }
    void choice(const Field& field, int& index, std::span<const char* const> allowed) override
    {
        row(field, "text", fmt::format("{}", fmt::join(allowed, ", ")),
            fmt::format("\"{}\"", allowed[static_cast<size_t>(index)]));
    }
    bool has(const Field&, bool) override
    {
        is_optional_ = true;
        return true;
    }
    void begin_table(const Field& field) override
    {
        row(field, *field.shorthand ? "table or value" : "table", "", "");
        open(fmt::format("[{}]", join(field.key)), field.key, field.doc);
    }
    void end_table() override { close(); }
    size_t begin_list(const Field& field, size_t) override
    {
        row(field, field.single_ok ? "table or list" : "list of tables", "", "");
        open(fmt::format("[[{}]]", join(field.key)), field.key, field.doc);
        return 1;
    }
    void begin_item(size_t) override {}
    void end_item() override {}
    void end_list() override { close(); }

    [[nodiscard]] std::string finish()
    {
        close();
        return fmt::format("{}", fmt::join(sections_, "\n"));
    }

  private:
    struct Section {
        size_t index;
        std::string key;
        std::string text;
    };
    std::string join(const char* key) const
    {
        std::string path;
        for (const Section& section : open_) {
            if (!section.key.empty()) path += section.key + ".";
        }
        return path + key;
    }
    void open(const std::string& title, const std::string& key, const std::string& doc = "")
    {
        Section section{sections_.size(), key, "### `" + title + "`\n\n"};
        if (key.empty()) section.text = "### " + title + "\n\n";
        if (!doc.empty()) section.text += doc + ".\n\n";
        section.text +=
            "| key | type | unit | allowed | default | meaning |\n"
            "|---|---|---|---|---|---|\n";
        open_.push_back(std::move(section));
        sections_.emplace_back();  // outer tables come before the inner ones
    }
    void close()
    {
        const bool is_transform = open_.back().key == "transform";
        if (is_transform && has_transform_) {
            sections_.erase(sections_.begin() + static_cast<long>(open_.back().index));
        } else {
            sections_[open_.back().index] = open_.back().text;
        }
        has_transform_ = has_transform_ || is_transform;  // one table serves all of them
        open_.pop_back();
    }
    void row(const Field& field, const std::string& type, const std::string& allowed,
             const std::string& initial)
    {
        std::string shown = initial.empty() || is_optional_ ? "" : "`" + initial + "`";
        if (field.required) shown = "required";
        is_optional_ = false;
        std::string doc = field.doc;
        if (*field.used_by) doc += fmt::format(" ({})", field.used_by);
        open_.back().text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", field.key, type,
                                         field.unit, allowed, shown, doc);
    }

    std::vector<Section> open_;
    std::vector<std::string> sections_;
    bool is_optional_ = false;
    bool has_transform_ = false;
};

}  // namespace

std::string scene_reference_markdown()
{
    ReferenceVisitor visitor;
    SceneDescription scene;
    describe(visitor, scene);
    return visitor.finish();
}

}  // namespace mote
