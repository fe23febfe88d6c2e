#pragma once

#include <array>

namespace mote {

/// Layers that a scene may ask for beside RGBA; what each holds is in scenes/README.md.
inline constexpr std::array aov_names = {
    "Z",
    "albedo",
    "motion",
    "variance",
    "samples",
    "volume_direct",
    "volume_indirect",
    "volume_emission",
    "background",
    "transmittance",
    "optical_depth",
    "volume_Z",
    "restir",
    "cost",
    "work",
    "direct",
    "indirect",
    "emission",
    "N",
    "P",
    "material_id",
};

}  // namespace mote
