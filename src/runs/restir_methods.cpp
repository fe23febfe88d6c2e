#include "runs/method_rows.h"

namespace mote {

namespace {

/// One pass per frame: what history and light caches are made for.
Method restir_method(const char* name, const char* doc, void (*edit)(RestirParams&))
{
    Method method;
    method.name = name;
    method.doc = doc;
    method.is_reference = false;
    method.keeps_history = true;
    method.samples_per_frame = 1;
    method.edit = [edit](RenderDescription& render) {
        render.estimator = EstimatorKind::Restir;
        edit(render.restir);
    };
    method.is_worthwhile = [](const SceneTraits&) { return true; };
    return method;
}

}  // namespace

std::vector<Method> restir_methods()
{
    std::vector<Method> table{
        restir_method("restir-off", "restir without reuse",
                      [](RestirParams& r) { r.reuse = ReuseMode::Off; }),
        restir_method("restir-temporal", "restir with temporal reuse",
                      [](RestirParams& r) { r.reuse = ReuseMode::Temporal; }),
        restir_method("restir-spatial", "restir with spatial reuse",
                      [](RestirParams& r) { r.reuse = ReuseMode::Spatial; }),
        restir_method("restir-both", "restir with temporal and spatial reuse",
                      [](RestirParams& r) { r.reuse = ReuseMode::Both; }),
        restir_method("restir-auto", "restir, reuse as it sees fit",
                      [](RestirParams& r) { r.reuse = ReuseMode::Auto; }),
        restir_method("restir-textbook",
                      "restir as published: 4 candidates, cached target, cap 20, 5 neighbours",
                      [](RestirParams& r) { r = make_restir_params(RestirPreset::Textbook); }),
    };
    // Rows that would be the same as restir-off.
    for (Method& method : table) {
        const bool reuses = method.name == "restir-temporal" || method.name == "restir-spatial" ||
                            method.name == "restir-both";
        if (!reuses) continue;
        method.is_worthwhile = [](const SceneTraits& traits) { return traits.has_reservoirs(); };
    }
    // Lights nearby have no closed form, and only theirs are reused.
    Method preview =
        restir_method("restir-preview", "restir's closed form alone; biased", [](RestirParams& r) {
            r.reuse = ReuseMode::Off;
            r.corrections = false;
        });
    preview.is_worthwhile = [](const SceneTraits& traits) {
        return traits.infinite_lights && !traits.local_lights;
    };
    Method blind = restir_method(
        "restir-no-visibility", "preset biased-no-visibility: shadows ignored in reuse; biased",
        [](RestirParams& r) { r = make_restir_params(RestirPreset::BiasedNoVisibility); });
    Method constant = restir_method(
        "restir-constant-mis", "preset biased-constant-mis: 1/M weights; biased",
        [](RestirParams& r) { r = make_restir_params(RestirPreset::BiasedConstantMis); });
    blind.is_worthwhile =
        constant.is_worthwhile = [](const SceneTraits& traits) { return traits.local_lights; };
    Method reused = restir_method(
        "restir-reused-visibility",
        "preset biased-reused-visibility: surfaces' samples keep the "
        "shadow of where they were drawn; biased",
        [](RestirParams& r) { r = make_restir_params(RestirPreset::BiasedReusedVisibility); });
    Method weighted = restir_method(
        "restir-weighted-visibility",
        "preset biased-weighted-visibility: surfaces average shadows over time; biased",
        [](RestirParams& r) { r = make_restir_params(RestirPreset::BiasedWeightedVisibility); });
    reused.is_worthwhile =
        weighted.is_worthwhile = [](const SceneTraits& traits) { return traits.surfaces; };
    for (Method* method : {&preview, &blind, &constant, &reused, &weighted}) {
        method->is_biased = true;
        table.push_back(std::move(*method));
    }
    return table;
}

}  // namespace mote
