#include <fmt/format.h>

#include "runs/method_rows.h"

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

}  // namespace

std::vector<Method> path_methods()
{
    std::vector<Method> table;
    for (const SamplerRow& sampler : samplers) {
        for (const bool equiangular : {false, true}) {
            for (const bool exact : {false, true}) {
                table.push_back(path_method(sampler, equiangular, exact));
            }
        }
    }
    return table;
}

}  // namespace mote
