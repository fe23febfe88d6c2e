#pragma once

#include <string>

#include "scene/description.h"

namespace mote {

/// Estimator, what it reuses, and whether its mean is right, for metadata: "path, unbiased",
/// "restir, reuse auto, unbiased", "restir, reuse both, biased: mis = constant, surface.visibility
/// = reused".
[[nodiscard]] std::string estimator_text(const RenderDescription& render);

}  // namespace mote
