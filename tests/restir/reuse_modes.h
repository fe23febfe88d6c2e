#pragma once

#include <string>
#include <vector>

#include "scene/restir_params.h"

namespace mote::test {

/// A way to reuse, and what reports call it.
struct ReuseCase {
    std::string name;
    RestirParams params;
};

[[nodiscard]] inline RestirParams reuse_params(ReuseMode reuse, ShiftKind shift,
                                               bool feedback = false)
{
    RestirParams params;
    params.reuse = reuse;
    params.shift = shift;
    params.spatial.feedback = feedback;
    params.candidates = 4;
    return params;
}

/// Every mode with every shift, feedback where it means something.
[[nodiscard]] inline std::vector<ReuseCase> all_reuse_cases()
{
    std::vector<ReuseCase> cases;
    const std::pair<const char*, ShiftKind> shifts[] = {{"numbers", ShiftKind::RandomNumbers},
                                                        {"world", ShiftKind::World},
                                                        {"fraction", ShiftKind::Fraction}};
    for (const auto& [name, shift] : shifts) {
        const std::string by = name;
        cases.push_back({"temporal " + by, reuse_params(ReuseMode::Temporal, shift)});
        cases.push_back({"spatial " + by, reuse_params(ReuseMode::Spatial, shift)});
        cases.push_back({"both " + by, reuse_params(ReuseMode::Both, shift)});
        cases.push_back({"feedback " + by, reuse_params(ReuseMode::Both, shift, true)});
    }
    cases.insert(cases.begin(), {"off", reuse_params(ReuseMode::Off, ShiftKind::World)});
    return cases;
}

}  // namespace mote::test
