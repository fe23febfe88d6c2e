#pragma once

#include <memory>

#include "volumes/bricks.h"
#include "volumes/grid_source.h"

namespace mote {

/// make_procedural and make_bricks in one, for code that stays clear of OpenVDB's headers.
[[nodiscard]] std::shared_ptr<const BrickGrid> make_procedural_bricks(
    const ProceduralParams& params, double time_s, const GridBudget& budget = {});

}  // namespace mote
