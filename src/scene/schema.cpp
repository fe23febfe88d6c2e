#include <nlohmann/json.hpp>

#include "scene/fields.h"
#include "scene/scene_io.h"

namespace mote {
namespace {

using Json = nlohmann::ordered_json;

/// Turns the field list into a JSON Schema, one object per table.
class SchemaVisitor : public FieldVisitor {
  public:
    SchemaVisitor() { open(); }

    void flag(const Field& field, bool& value) override
    {
        Json schema{{"type", "boolean"}};
        schema["default"] = value;
        add(field, std::move(schema));
    }
    void integer(const Field& field, int64_t& value) override
    {
        Json schema{{"type", "integer"}};
        add_range(field, schema);
        schema["default"] = value;
        add(field, std::move(schema));
    }
    void numbers(const Field& field, std::span<double> values) override
    {
        Json number{{"type", "number"}};
        add_range(field, number);
        const auto plain = [&](double value) {
            return Json::parse(format_number(value, field.is_float));
        };
        if (values.size() == 1) {
            number["default"] = plain(values[0]);
            return add(field, std::move(number));
        }
        Json vector{{"type", "array"}, {"items", number}, {"minItems", 3}, {"maxItems", 3}};
        Json schema = field.scalar_ok ? Json{{"anyOf", Json::array({number, vector})}} : vector;
        schema["default"] = {plain(values[0]), plain(values[1]), plain(values[2])};
        add(field, std::move(schema));
    }
    void text(const Field& field, std::string& value) override
    {
        Json schema{{"type", "string"}, {"maxLength", 4096}};
        if (!field.required) schema["default"] = value;
        add(field, std::move(schema));
    }
    void words(const Field& field, std::vector<std::string>&,
               std::span<const char* const> allowed) override
    {
        add(field,
            {{"type", "array"}, {"items", {{"enum", list(allowed)}}}, {"uniqueItems", true}});
    }
    void names(const Field& field, std::map<std::string, std::string>&,
               std::span<const char* const> allowed) override
    {
        add(field, {{"type", "object"},
                    {"propertyNames", {{"enum", list(allowed)}}},
                    {"additionalProperties", {{"type", "string"}}}});
    }
    void choice(const Field& field, int& index, std::span<const char* const> allowed) override
    {
        Json schema{{"enum", list(allowed)}};
        if (!field.required) schema["default"] = allowed[static_cast<size_t>(index)];
        add(field, std::move(schema));
    }
    bool has(const Field&, bool) override { return true; }
    void begin_table(const Field& field) override
    {
        fields_.push_back(field);
        open();
    }
    void end_table() override
    {
        Json table = close();
        const Field field = fields_.back();
        fields_.pop_back();
        if (*field.shorthand) {
            const Json value = table["properties"][field.shorthand];
            table = {{"anyOf", Json::array({value, table})}};
        }
        add(field, std::move(table));
    }
    size_t begin_list(const Field& field, size_t) override
    {
        fields_.push_back(field);
        return 1;
    }
    void begin_item(size_t) override { open(); }
    void end_item() override
    {
        const Json item = close();
        const Field field = fields_.back();
        Json list{{"type", "array"}, {"items", item}};
        if (field.single_ok) list = {{"anyOf", Json::array({item, list})}};
        add(field, std::move(list));
    }
    void end_list() override { fields_.pop_back(); }

    Json close()
    {
        Json table = std::move(tables_.back());
        tables_.pop_back();
        return table;
    }

  private:
    void open()
    {
        tables_.push_back(
            {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}});
    }
    static Json list(std::span<const char* const> words)
    {
        Json out = Json::array();
        for (const char* word : words) out.push_back(word);
        return out;
    }
    static void add_range(const Field& field, Json& schema)
    {
        const Range& range = field.range;
        if (std::isfinite(range.lo)) {
            schema[range.lo_open ? "exclusiveMinimum" : "minimum"] = range.lo;
        }
        if (std::isfinite(range.hi)) {
            schema[range.hi_open ? "exclusiveMaximum" : "maximum"] = range.hi;
        }
    }
    void add(const Field& field, Json schema)
    {
        std::string doc = field.doc;
        if (*field.unit) doc += std::string(" [") + field.unit + "]";
        schema["description"] = doc;
        tables_.back()["properties"][field.key] = std::move(schema);
        if (field.required) tables_.back()["required"].push_back(field.key);
    }

    std::vector<Json> tables_;
    std::vector<Field> fields_;
};

}  // namespace

std::string scene_schema_json()
{
    SchemaVisitor visitor;
    SceneDescription scene;
    describe(visitor, scene);
    Json schema = visitor.close();
    schema["properties"]["$schema"] = {{"type", "string"}};
    Json out{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
             {"title", "mote scene"},
             {"description", "A scene of mote; the same schema serves TOML and JSON."}};
    out.update(schema);
    return out.dump(1, ' ') + "\n";
}

}  // namespace mote
