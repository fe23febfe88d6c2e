#include "scene/fields.h"

#include <fmt/format.h>

namespace mote {
namespace {

template <class T>
void visit_vector(FieldVisitor& v, Field field, T& value)
{
    std::array<double, 3> wide{};
    for (int i = 0; i < 3; ++i) wide[static_cast<size_t>(i)] = static_cast<double>(value[i]);
    field.is_float = std::is_same_v<typename T::value_type, float>;
    v.numbers(field, wide);
    if (!v.assigns()) return;
    for (int i = 0; i < 3; ++i) {
        value[i] = static_cast<typename T::value_type>(wide[static_cast<size_t>(i)]);
    }
}

/// Limits that only come from the type are not worth telling.
bool is_limit(double value)
{
    return std::abs(value) < 2e9;
}

}  // namespace

std::string format_number(double value, bool is_float)
{
    const double power = std::log10(std::abs(value));
    if (power >= 6.0 && power == std::round(power)) {
        return fmt::format("{}1e{:.0f}", value < 0.0 ? "-" : "", power);
    }
    return is_float ? fmt::format("{}", static_cast<float>(value)) : fmt::format("{}", value);
}

std::string describe_range(const Field& field)
{
    const Range& range = field.range;
    std::string lower;
    std::string upper;
    if (is_limit(range.lo)) {
        lower = (range.lo_open ? "above " : "at least ") + format_number(range.lo, field.is_float);
    }
    if (is_limit(range.hi)) {
        upper = (range.hi_open ? "below " : "at most ") + format_number(range.hi, field.is_float);
    }
    if (!lower.empty() && !upper.empty() && !range.lo_open && !range.hi_open) {
        return fmt::format("{} to {}", format_number(range.lo, field.is_float),
                           format_number(range.hi, field.is_float));
    }
    return lower + (!lower.empty() && !upper.empty() ? ", " : "") + upper;
}

void visit(FieldVisitor& v, const Field& field, float& value)
{
    Field single = field;
    single.is_float = true;
    auto wide = static_cast<double>(value);
    v.numbers(single, {&wide, 1});
    if (v.assigns()) value = static_cast<float>(wide);
}

void visit(FieldVisitor& v, const Field& field, Vec3& value)
{
    visit_vector(v, field, value);
}

void visit(FieldVisitor& v, const Field& field, Vec3d& value)
{
    visit_vector(v, field, value);
}

}  // namespace mote
