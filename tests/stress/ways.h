#pragma once

#include <string>
#include <vector>

#include "restir/reuse_modes.h"
#include "scene/description.h"

namespace mote::test {

/// A way to render, and what messages call it.
struct Way {
    std::string name;
    RenderDescription render;  ///< film size: that of the scene's camera, see play()
    /// Corrections of the control variate, of guessed shadows and of shared rays are signed: a
    /// pixel's estimate may fall below 0 though its expectation does not.
    bool is_signed = false;
};

[[nodiscard]] inline Way path_way(int max_bounces = 1, int samples = 2)
{
    Way way{"path", {}};
    way.render.estimator = EstimatorKind::Path;
    way.render.samples = samples;
    way.render.path.max_bounces = max_bounces;
    way.render.path.transmittance = TransmittanceKind::Exact;
    way.render.path.equiangular = true;
    return way;
}

[[nodiscard]] inline Way restir_way(const std::string& name, const RestirParams& restir,
                                    int max_bounces = 1, int samples = 2)
{
    Way way = path_way(max_bounces, samples);
    way.name = name;
    way.render.estimator = EstimatorKind::Restir;
    way.render.restir = restir;
    way.is_signed = restir.control_variate || max_bounces > 1;
    return way;
}

/// Every estimator, the kinds of reuse that differ in what they compute, all shifts.
[[nodiscard]] inline std::vector<Way> all_ways(int max_bounces = 1, int samples = 2)
{
    std::vector<Way> ways{path_way(max_bounces, samples), path_way(max_bounces, samples)};
    ways[1].name = "path, tracking";
    ways[1].render.path.transmittance = TransmittanceKind::ResidualRatio;
    ways[1].render.path.equiangular = false;
    const auto add = [&](const char* name, RestirParams restir, bool control_variate) {
        restir.control_variate = control_variate;
        ways.push_back(restir_way(name, restir, max_bounces, samples));
    };
    add("restir", reuse_params(ReuseMode::Off, ShiftKind::RandomNumbers), true);
    add("restir, candidates alone", reuse_params(ReuseMode::Off, ShiftKind::RandomNumbers), false);
    add("both", reuse_params(ReuseMode::Both, ShiftKind::RandomNumbers, true), true);
    add("both, world", reuse_params(ReuseMode::Both, ShiftKind::World, true), false);
    add("both, fraction", reuse_params(ReuseMode::Both, ShiftKind::Fraction), false);
    add("textbook", make_restir_params(RestirPreset::Textbook), false);
    return ways;
}

/// Those of them that must agree with the path tracer, one of each kind.
[[nodiscard]] inline std::vector<Way> restir_ways(int max_bounces = 1, int samples = 2)
{
    std::vector<Way> ways;
    for (const Way& way : all_ways(max_bounces, samples)) {
        if (way.name == "restir" || way.name == "both" || way.name == "both, world") {
            ways.push_back(way);
        }
    }
    return ways;
}

}  // namespace mote::test
