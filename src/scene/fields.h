#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/description.h"

namespace mote {

/// Allowed values of a number.
struct Range {
    double lo = -std::numeric_limits<double>::infinity();
    double hi = std::numeric_limits<double>::infinity();
    bool lo_open = false;  ///< lo itself is not allowed
    bool hi_open = false;
};

[[nodiscard]] constexpr Range at_least(double lo)
{
    return {lo};
}
[[nodiscard]] constexpr Range above(double lo)
{
    return {lo, std::numeric_limits<double>::infinity(), true, false};
}
[[nodiscard]] constexpr Range between(double lo, double hi)
{
    return {lo, hi};
}
[[nodiscard]] constexpr Range inside(double lo, double hi)
{
    return {lo, hi, true, true};
}

/// Frame numbers are kept as doubles and as 32-bit numbers.
inline constexpr Range frame_range = between(-1e7, 1e7);
/// Beyond this, single precision leaves less than a metre.
inline constexpr Range length_range = between(-1e7, 1e7);
inline constexpr Range size_range{0.0, 1e7, true, false};

/// One key of a scene file: everything that reading, the JSON Schema and the tables need to know.
struct Field {
    const char* key;
    const char* doc;
    const char* unit = "";
    Range range{};
    bool required = false;
    bool changes_picture = true;  ///< counts for the scene hash
    const char* also = "";        ///< words of other tools, blank separated, that suggest this key
    const char* used_by = "";     ///< variants, blank separated; with others it is an error
    const char* shorthand = "";   ///< table: its key that a plain value in its place sets
    bool scalar_ok = false;       ///< vector: one number sets all three
    bool carries = false;         ///< list: an entry starts from the one before it
    bool single_ok = false;       ///< list: one table may stand for a list of one
    bool is_float = false;        ///< stored in single precision; set by the wrappers below
};

/// Something done to every field of a description: reading, hashing, documenting. The functions
/// `describe` below hold the one list of fields and call these.
class FieldVisitor {
  public:
    virtual ~FieldVisitor() = default;

    virtual void flag(const Field& field, bool& value) = 0;
    virtual void integer(const Field& field, int64_t& value) = 0;
    /// One number, or a vector of three.
    virtual void numbers(const Field& field, std::span<double> values) = 0;
    virtual void text(const Field& field, std::string& value) = 0;
    /// A list of words out of `allowed`.
    virtual void words(const Field& field, std::vector<std::string>& value,
                       std::span<const char* const> allowed) = 0;
    /// A table of names with text values; keys out of `allowed`.
    virtual void names(const Field& field, std::map<std::string, std::string>& value,
                       std::span<const char* const> allowed) = 0;
    virtual void choice(const Field& field, int& index, std::span<const char* const> allowed) = 0;

    /// Whether an optional value is to be visited; `present` says whether there is one.
    virtual bool has(const Field& field, bool present) = 0;
    virtual void begin_table(const Field& field) = 0;
    virtual void end_table() = 0;
    /// Number of entries to visit, `count` now. Each is between begin_item and end_item.
    virtual size_t begin_list(const Field& field, size_t count) = 0;
    virtual void begin_item(size_t index) = 0;
    virtual void end_item() = 0;
    virtual void end_list() = 0;
    /// Says which variant of the open table is at hand, for the fields' used_by.
    virtual void select(const std::string& variant) { (void)variant; }
    /// Whether values are written to rather than read from.
    [[nodiscard]] virtual bool assigns() const { return false; }
};

/// "above 0, at most 1" from a field's range; "" if there are no limits worth telling.
[[nodiscard]] std::string describe_range(const Field& field);

/// Shortest text of a number, in the precision that the field stores.
[[nodiscard]] std::string format_number(double value, bool is_float);

// The one field list: fields_scene.cpp and fields_content.cpp.
void describe(FieldVisitor& visitor, SceneDescription& scene);
void describe(FieldVisitor& visitor, CameraDescription& camera);
void describe(FieldVisitor& visitor, CameraFile& file);
void describe(FieldVisitor& visitor, CameraKey& key);
void describe(FieldVisitor& visitor, RenderDescription& render);
void describe(FieldVisitor& visitor, PathTracerParams& path);
void describe(FieldVisitor& visitor, RestirParams& restir);
void describe(FieldVisitor& visitor, TemporalParams& temporal);
void describe(FieldVisitor& visitor, SpatialParams& spatial);
void describe(FieldVisitor& visitor, SurfaceRestirParams& surface);
void describe(FieldVisitor& visitor, OutputDescription& output);
void describe(FieldVisitor& visitor, VolumeDescription& volume);
void describe(FieldVisitor& visitor, SequenceParams& sequence);
void describe(FieldVisitor& visitor, ProceduralParams& procedural);
void describe(FieldVisitor& visitor, Phase& phase);
void describe(FieldVisitor& visitor, Emission& emission);
void describe(FieldVisitor& visitor, ParticlesDescription& particles);
void describe(FieldVisitor& visitor, LightDescription& light);
void describe(FieldVisitor& visitor, LightKey& key);
void describe(FieldVisitor& visitor, MaterialDescription& material);
void describe(FieldVisitor& visitor, ObjectDescription& object);
void describe(FieldVisitor& visitor, TransformKey& key);
/// The "transform" of volumes, lights and objects.
void visit_transform(FieldVisitor& visitor, std::vector<TransformKey>& keys);

// Wrappers that bring a member to one of the forms above.

inline void visit(FieldVisitor& v, const Field& field, bool& value)
{
    v.flag(field, value);
}
inline void visit(FieldVisitor& v, const Field& field, std::string& value)
{
    v.text(field, value);
}
inline void visit(FieldVisitor& v, const Field& field, double& value)
{
    v.numbers(field, {&value, 1});
}
void visit(FieldVisitor& v, const Field& field, float& value);
void visit(FieldVisitor& v, const Field& field, Vec3& value);
void visit(FieldVisitor& v, const Field& field, Vec3d& value);

/// Integers of any width; the field's range is narrowed to what the type holds.
template <std::integral T>
void visit(FieldVisitor& v, Field field, T& value)
{
    field.range.lo = std::max(field.range.lo, static_cast<double>(std::numeric_limits<T>::min()));
    field.range.hi = std::min(field.range.hi, static_cast<double>(std::numeric_limits<T>::max()));
    auto wide = static_cast<int64_t>(value);
    v.integer(field, wide);
    if (v.assigns()) value = static_cast<T>(wide);
}

/// Enumerators count from 0 in the order of `allowed`.
template <class Enum>
void visit_choice(FieldVisitor& v, const Field& field, Enum& value,
                  std::span<const char* const> allowed)
{
    int index = static_cast<int>(value);
    v.choice(field, index, allowed);
    if (v.assigns()) value = static_cast<Enum>(index);
}

template <class T>
void visit_optional(FieldVisitor& v, const Field& field, std::optional<T>& value)
{
    if (!v.has(field, value.has_value())) return;
    T content = value.value_or(T{});
    visit(v, field, content);
    if (v.assigns()) value = content;
}

template <class T>
void visit_table(FieldVisitor& v, const Field& field, T& value)
{
    v.begin_table(field);
    describe(v, value);
    v.end_table();
}

template <class T>
void visit_optional_table(FieldVisitor& v, const Field& field, std::optional<T>& value)
{
    if (!v.has(field, value.has_value())) return;
    T content = value.value_or(T{});
    visit_table(v, field, content);
    if (v.assigns()) value = content;
}

template <class T>
void visit_list(FieldVisitor& v, const Field& field, std::vector<T>& items)
{
    const size_t count = v.begin_list(field, items.size());
    if (v.assigns()) items.assign(count, T{});
    for (size_t i = 0; i < count; ++i) {
        if (v.assigns() && field.carries && i > 0) items[i] = items[i - 1];
        T documented{};  // stands in where a list is documented rather than visited
        T& item = i < items.size() ? items[i] : documented;
        v.begin_item(i);
        describe(v, item);
        v.end_item();
    }
    v.end_list();
}

}  // namespace mote
