#include "scene/estimator_text.h"

#include <vector>

#include <fmt/format.h>

#include "core/error.h"

namespace mote {
namespace {

const char* reuse_name(ReuseMode reuse)
{
    switch (reuse) {
        case ReuseMode::Auto:
            return "auto";
        case ReuseMode::Off:
            return "off";
        case ReuseMode::Temporal:
            return "temporal";
        case ReuseMode::Spatial:
            return "spatial";
        case ReuseMode::Both:
            return "both";
    }
    return "";
}

/// Why surfaces that reuse samples have the wrong mean.
std::string surface_reason(const RestirParams& p)
{
    switch (p.surface.visibility) {
        case SurfaceVisibility::Reused:
            return "surface.visibility = reused";
        case SurfaceVisibility::Weighted:
            return "surface.visibility = weighted";
        case SurfaceVisibility::Exact:
        case SurfaceVisibility::None:
            break;
    }
    return "surface.mis = constant";
}

/// The settings that make images wrong on purpose, as is_unbiased knows them.
std::vector<std::string> reasons(const RestirParams& p)
{
    std::vector<std::string> out;
    if (!p.corrections) out.emplace_back("corrections = false");
    const bool reuses_paths = p.indirect_reuse != IndirectReuse::Off;
    const bool reuses_media = p.reuse != ReuseMode::Off && p.reuse != ReuseMode::Auto;
    if (reuses_media && p.visibility == TargetVisibility::None) {
        out.emplace_back("visibility = none");
    }
    if ((reuses_media || reuses_paths) && p.mis == ReuseMis::Constant) {
        out.emplace_back("mis = constant");
    }
    if (reuses_paths_in_time(p) && p.indirect_suffix == IndirectSuffix::BiasedValidated) {
        out.emplace_back("indirect_suffix = biased-validated");
    }
    if (p.reuse != ReuseMode::Off && !is_surface_reuse_unbiased(p)) {
        out.push_back(surface_reason(p));
    }
    return out;
}

std::string restir_text(const RestirParams& p)
{
    const std::string text =
        fmt::format("restir, reuse {}{}, ", reuse_name(p.reuse),
                    p.indirect_reuse == IndirectReuse::Off ? "" : ", paths reused");
    const std::vector<std::string> why = reasons(p);
    MOTE_ASSERT(why.empty() == is_unbiased(p));
    return text + (why.empty() ? "unbiased" : fmt::format("biased: {}", fmt::join(why, ", ")));
}

}  // namespace

std::string estimator_text(const RenderDescription& render)
{
    switch (render.estimator) {
        case EstimatorKind::Path:
            return "path, unbiased";
        case EstimatorKind::Restir:
            return restir_text(render.restir);
        case EstimatorKind::March:
            return "march, biased: ray marching";
    }
    return "";
}

}  // namespace mote
