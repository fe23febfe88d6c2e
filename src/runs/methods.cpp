#include "runs/methods.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "runs/method_rows.h"

namespace mote {

namespace {

std::vector<Method> make_table()
{
    std::vector<Method> table = path_methods();
    for (Method& method : restir_methods()) table.push_back(std::move(method));
    table.push_back(march_method());
    return table;
}

bool matches(const std::string& name, const std::string& pattern)
{
    if (pattern.empty() || pattern.back() != '*') return name == pattern;
    return name.compare(0, pattern.size() - 1, pattern, 0, pattern.size() - 1) == 0;
}

[[noreturn]] void throw_unknown(const std::string& name)
{
    std::vector<std::string> known;
    for (const Method& method : all_methods()) known.push_back(method.name);
    throw Error(ExitCode::Usage,
                fmt::format("no method \"{}\"{}; the methods are {}", printable(name),
                            did_you_mean(name, known), fmt::join(known, ", ")));
}

}  // namespace

SceneTraits traits_of(const Scene& scene)
{
    SceneTraits traits;
    // A constant sky is found by scattered rays, not chosen (LightStrategy::Auto).
    const bool chosen_sky = scene.environment && scene.environment->map;
    traits.several_lights = scene.lights.size() + (chosen_sky ? 1 : 0) > 1;
    for (const Light& light : scene.lights) {
        const bool is_infinite = std::holds_alternative<DistantLight>(light);
        (is_infinite ? traits.infinite_lights : traits.local_lights) = true;
    }
    if (scene.environment) traits.infinite_lights = true;
    traits.surfaces = scene.surfaces != nullptr;
    traits.glowing_media =
        std::any_of(scene.media.volumes.begin(), scene.media.volumes.end(),
                    [](const Volume& volume) { return volume.emission_params.is_on(); });
    traits.light_count = static_cast<int>(scene.lights.size());
    return traits;
}

std::span<const Method> all_methods()
{
    static const std::vector<Method> table = make_table();
    return table;
}

std::vector<Method> choose_methods(const std::string& list, const SceneTraits& traits)
{
    std::vector<Method> chosen;
    const auto add = [&](const Method& method) {
        const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](const Method& other) {
            return other.name == method.name;
        });
        if (is_new) chosen.push_back(method);
    };
    for (const std::string& pattern : split_list(list)) {
        bool found = false;
        for (const Method& method : all_methods()) {
            if (!matches(method.name, pattern)) continue;
            add(method);
            found = true;
        }
        if (!found) throw_unknown(pattern);
    }
    if (!chosen.empty()) return chosen;
    for (const Method& method : all_methods()) {
        if (method.is_worthwhile(traits)) chosen.push_back(method);
    }
    return chosen;
}

const Method& find_method(const std::string& name)
{
    for (const Method& method : all_methods()) {
        if (method.name == name) return method;
    }
    throw_unknown(name);
}

}  // namespace mote
