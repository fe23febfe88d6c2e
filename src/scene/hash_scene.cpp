#include "scene/hash_scene.h"

#include "scene/fields.h"
#include "scene/hash.h"

namespace mote {
namespace {

class HashVisitor : public FieldVisitor {
  public:
    void flag(const Field& field, bool& value) override { add(field, uint64_t{value}); }
    void integer(const Field& field, int64_t& value) override
    {
        add(field, static_cast<uint64_t>(value));
    }
    void numbers(const Field& field, std::span<double> values) override
    {
        for (const double value : values) add(field, value);
    }
    void text(const Field& field, std::string& value) override
    {
        add(field, std::string_view(value));
    }
    void words(const Field& field, std::vector<std::string>& value,
               std::span<const char* const>) override
    {
        add(field, static_cast<uint64_t>(value.size()));
        for (const std::string& word : value) hasher_.add(std::string_view(word));
    }
    void names(const Field& field, std::map<std::string, std::string>& value,
               std::span<const char* const>) override
    {
        add(field, static_cast<uint64_t>(value.size()));
        for (const auto& [key, name] : value) {
            hasher_.add(std::string_view(key));
            hasher_.add(std::string_view(name));
        }
    }
    void choice(const Field& field, int& index, std::span<const char* const>) override
    {
        add(field, static_cast<uint64_t>(index));
    }
    bool has(const Field& field, bool present) override
    {
        add(field, uint64_t{present});
        return present;
    }
    void begin_table(const Field& field) override { hasher_.add(std::string_view(field.key)); }
    void end_table() override {}
    size_t begin_list(const Field& field, size_t count) override
    {
        add(field, static_cast<uint64_t>(count));
        return count;
    }
    void begin_item(size_t) override {}
    void end_item() override {}
    void end_list() override {}

    [[nodiscard]] uint64_t value() const { return hasher_.value(); }

  private:
    template <class T>
    void add(const Field& field, T value)
    {
        if (!field.changes_picture) return;
        hasher_.add(std::string_view(field.key));
        hasher_.add(value);
    }

    Hasher hasher_;
};

}  // namespace

uint64_t hash_scene(const SceneDescription& scene)
{
    SceneDescription copy = scene;  // visitors of the field list may write, this one does not
    HashVisitor visitor;
    describe(visitor, copy);
    return visitor.value();
}

}  // namespace mote
