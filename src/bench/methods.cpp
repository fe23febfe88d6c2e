#include "bench/methods.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

struct SamplerRow {
    const char* suffix;
    const char* doc;
    LightSamplerKind kind;
};

constexpr SamplerRow samplers[] = {
    {"", "light chosen by itself", LightSamplerKind::Auto},
    {"-power", "lights by power", LightSamplerKind::Power},
    {"-distance", "lights by power over squared distance", LightSamplerKind::PowerDistance},
    {"-tree", "light tree", LightSamplerKind::Tree},
};

Method path_method(const SamplerRow& sampler, bool equiangular, bool exact)
{
    Method method;
    method.name = fmt::format("path{}{}{}", sampler.suffix, equiangular ? "-equi" : "",
                              exact ? "-exact" : "");
    method.doc = fmt::format("path tracer, {}{}, {} shadow rays", sampler.doc,
                             equiangular ? ", equiangular distances" : "",
                             exact ? "exact" : "residual-ratio");
    method.is_reference = true;
    method.keeps_history = false;
    method.samples_per_frame = 0;
    const LightSamplerKind kind = sampler.kind;
    method.edit = [=](RenderDescription& render) {
        render.estimator = EstimatorKind::Path;
        render.path.light_sampler = kind;
        render.path.equiangular = equiangular;
        render.path.transmittance =
            exact ? TransmittanceKind::Exact : TransmittanceKind::ResidualRatio;
    };
    method.is_worthwhile = [=](const SceneTraits& traits) {
        const bool is_auto = kind == LightSamplerKind::Auto;
        return traits.several_lights != is_auto && (traits.local_lights || !equiangular);
    };
    return method;
}

struct RestirRow {
    const char* suffix;
    const char* doc;
    void (*edit)(RestirParams&);
    bool needs_local_lights;  ///< differs from the row above only for lamps and glowing media
};

constexpr RestirRow restir_rows[] = {
    {"", "as the scene says", [](RestirParams&) {}, false},
    {"-off", "no reuse", [](RestirParams& p) { p.reuse = ReuseMode::Off; }, true},
    {"-temporal", "history", [](RestirParams& p) { p.reuse = ReuseMode::Temporal; }, true},
    {"-spatial", "neighbours", [](RestirParams& p) { p.reuse = ReuseMode::Spatial; }, true},
    {"-both", "history and neighbours", [](RestirParams& p) { p.reuse = ReuseMode::Both; }, true},
    {"-textbook", "the papers' configuration",
     [](RestirParams& p) { p = make_restir_params(RestirPreset::Textbook); }, false},
    {"-preview", "closed forms without corrections, biased",
     [](RestirParams& p) { p.corrections = false; }, false},
};

Method restir_method(const RestirRow& row)
{
    Method method;
    method.name = fmt::format("restir{}", row.suffix);
    method.doc = fmt::format("volumetric ReSTIR, {}", row.doc);
    method.is_reference = false;
    method.keeps_history = true;
    method.samples_per_frame = 0;
    const RestirRow* own = &row;
    method.edit = [own](RenderDescription& render) {
        render.estimator = EstimatorKind::Restir;
        own->edit(render.restir);
    };
    method.is_worthwhile = [own](const SceneTraits& traits) {
        return traits.local_lights || !own->needs_local_lights;
    };
    return method;
}

std::vector<Method> make_table()
{
    std::vector<Method> table;
    for (const SamplerRow& sampler : samplers) {
        for (const bool equiangular : {false, true}) {
            for (const bool exact : {false, true}) {
                table.push_back(path_method(sampler, equiangular, exact));
            }
        }
    }
    for (const RestirRow& row : restir_rows) table.push_back(restir_method(row));
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
        if (!std::holds_alternative<DistantLight>(light)) traits.local_lights = true;
    }
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
