#include "particles/attribute_map.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

struct UsualNames {
    const char* name;
    int components;
    std::vector<const char*> names;                   ///< besides `name`
    std::vector<std::array<const char*, 3>> triples;  ///< three scalar fields
};

const std::array<UsualNames, attribute_count>& usual_names()
{
    static const std::array<UsualNames, attribute_count> table{{
        {"position", 3, {"P", "pos", "positions"}, {{"x", "y", "z"}, {"px", "py", "pz"}}},
        {"velocity", 3, {"v", "vel"}, {{"vx", "vy", "vz"}}},
        {"radius", 1, {"pscale", "rad"}, {}},
        {"mass", 1, {"m"}, {}},
        {"density", 1, {}, {}},
        {"temperature", 1, {"temp", "T"}, {}},
        {"color", 3, {"Cd", "colour", "rgb"}, {{"red", "green", "blue"}, {"r", "g", "b"}}},
        {"id", 1, {"particle_id", "pid"}, {}},
        {"age", 1, {}, {}},
    }};
    return table;
}

bool same_name(const std::string& a, const std::string& b)
{
    if (a.size() != b.size()) return false;
    if (a.size() == 1) return a == b;  // "T" is a temperature, "t" a time
    return std::equal(a.begin(), a.end(), b.begin(), [](unsigned char x, unsigned char y) {
        return std::tolower(x) == std::tolower(y);
    });
}

/// Which field of the file holds each component of an attribute.
struct Found {
    std::array<size_t, 3> field{};
    std::array<int, 3> component{};
};

class Finder {
  public:
    explicit Finder(std::span<const FileField> fields) : fields_(fields) {}

    [[nodiscard]] std::optional<size_t> field(const std::string& name, int components) const
    {
        for (size_t i = 0; i < fields_.size(); ++i) {
            if (fields_[i].components == components && fields_[i].name == name) return i;
        }
        for (size_t i = 0; i < fields_.size(); ++i) {
            if (fields_[i].components == components && same_name(fields_[i].name, name)) return i;
        }
        return std::nullopt;
    }

    [[nodiscard]] std::optional<Found> triple(const std::array<std::string, 3>& names) const
    {
        Found found;
        for (size_t c = 0; c < 3; ++c) {
            const auto i = field(names[c], 1);
            if (!i) return std::nullopt;
            found.field[c] = *i;
        }
        return found;
    }

    /// A name of one field, or the stem of three.
    [[nodiscard]] std::optional<Found> named(const std::string& name, int components) const
    {
        if (const auto i = field(name, components)) return Found{{*i, *i, *i}, {0, 1, 2}};
        if (components == 1) return std::nullopt;
        for (const char* form : {"{}.{}", "{}_{}", "{}{}", "{}[{}]", "{}:{}"}) {
            for (const std::array<const char*, 3>& letters :
                 {std::array{"x", "y", "z"}, std::array{"r", "g", "b"},
                  std::array{"0", "1", "2"}}) {
                std::array<std::string, 3> names;
                for (size_t c = 0; c < 3; ++c) {
                    names[c] = fmt::format(fmt::runtime(form), name, letters[c]);
                }
                if (const auto found = triple(names)) return found;
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] std::optional<Found> usual(const UsualNames& names) const
    {
        if (const auto found = named(names.name, names.components)) return found;
        for (const char* name : names.names) {
            if (const auto found = named(name, names.components)) return found;
        }
        for (const auto& t : names.triples) {
            if (const auto found = triple({t[0], t[1], t[2]})) return found;
        }
        return std::nullopt;
    }

    /// A user's name: as `named`, or three names with commas between.
    [[nodiscard]] std::optional<Found> given(const std::string& name, int components) const
    {
        const size_t first = name.find(',');
        const size_t second = first == std::string::npos ? first : name.find(',', first + 1);
        if (components == 1 || second == std::string::npos) return named(name, components);
        const auto trim = [](std::string s) {
            s.erase(0, s.find_first_not_of(' '));
            s.erase(s.find_last_not_of(' ') + 1);
            return s;
        };
        return triple({trim(name.substr(0, first)),
                       trim(name.substr(first + 1, second - first - 1)),
                       trim(name.substr(second + 1))});
    }

    [[nodiscard]] std::vector<std::string> names() const
    {
        std::vector<std::string> names;
        for (const FileField& field : fields_) names.push_back(field.name);
        return names;
    }

    [[nodiscard]] std::string list() const
    {
        std::string text;
        for (const FileField& field : fields_) {
            if (text.size() > 300) return text + ", ...";
            text += fmt::format("{}{}", text.empty() ? "" : ", ", printable(field.name, 40));
            if (field.components > 1) text += fmt::format(" ({} numbers)", field.components);
        }
        return text.empty() ? "none" : text;
    }

  private:
    std::span<const FileField> fields_;
};

void check_keys(const CacheParams& params)
{
    std::vector<std::string> known;
    for (const UsualNames& names : usual_names()) known.emplace_back(names.name);
    for (const auto& [key, name] : params.attributes) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        throw Error(ExitCode::Input,
                    fmt::format("attributes: unknown attribute \"{}\"{}; known are {}",
                                printable(key), did_you_mean(key, known), fmt::join(known, ", ")));
    }
}

bool is_wanted(ParticleAttribute attribute, const AttributeMask& mask)
{
    switch (attribute) {
        case ParticleAttribute::Velocity:
            return mask.velocity;
        case ParticleAttribute::Temperature:
            return mask.temperature;
        case ParticleAttribute::Color:
            return mask.color;
        case ParticleAttribute::Id:
            return mask.id;
        case ParticleAttribute::Age:
            return mask.age;
        default:
            return true;
    }
}

std::optional<Found> find(const std::string& file, const Finder& finder, const CacheParams& params,
                          const UsualNames& names)
{
    const auto given = params.attributes.find(names.name);
    if (given == params.attributes.end()) return finder.usual(names);
    if (given->second.empty()) return std::nullopt;  // the user wants to do without
    const auto found = finder.given(given->second, names.components);
    if (found) return found;
    throw Error(ExitCode::Input,
                fmt::format("{}: no attribute \"{}\" of {} to read as {}{}; the file has {}", file,
                            printable(given->second),
                            names.components == 1 ? "one number" : "three numbers", names.name,
                            did_you_mean(given->second, finder.names()), finder.list()));
}

}  // namespace

const char* attribute_name(ParticleAttribute attribute)
{
    return usual_names()[static_cast<size_t>(attribute)].name;
}

int attribute_components(ParticleAttribute attribute)
{
    return usual_names()[static_cast<size_t>(attribute)].components;
}

std::vector<Binding> bind_attributes(const std::string& file, std::span<const FileField> fields,
                                     const CacheParams& params, const AttributeMask& mask)
{
    check_keys(params);
    const Finder finder(fields);
    std::vector<Binding> bindings;
    bool has_mass = false;
    for (int a = 0; a < attribute_count; ++a) {
        const auto attribute = static_cast<ParticleAttribute>(a);
        const UsualNames& names = usual_names()[static_cast<size_t>(a)];
        const auto found = find(file, finder, params, names);
        if (!found && attribute == ParticleAttribute::Position) {
            throw Error(ExitCode::Input,
                        fmt::format("{}: no positions; name them with attributes.position (three "
                                    "numbers); the file has {}",
                                    file, finder.list()));
        }
        const bool is_spare = attribute == ParticleAttribute::Density && has_mass;
        if (!found || is_spare || !is_wanted(attribute, mask)) continue;
        has_mass = has_mass || attribute == ParticleAttribute::Mass;
        for (int c = 0; c < names.components; ++c) {
            const auto at = static_cast<size_t>(c);
            bindings.push_back({attribute, c, found->field[at], found->component[at]});
        }
    }
    return bindings;
}

}  // namespace mote
