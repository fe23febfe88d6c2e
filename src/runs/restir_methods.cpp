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
        restir_method("restir-preview", "restir's closed form alone; biased",
                      [](RestirParams& r) {
                          r.reuse = ReuseMode::Off;
                          r.corrections = false;
                      }),
    };
    // Lights nearby have no closed form.
    table.back().is_worthwhile = [](const SceneTraits& traits) {
        return traits.infinite_lights && !traits.local_lights;
    };
    return table;
}

}  // namespace mote
