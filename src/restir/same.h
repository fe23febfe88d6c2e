#pragma once

#include <span>

#include "scene/scene.h"

namespace mote {

// Whether two things are the same, so that what was made of one serves for the other. Images and
// grids count by identity.

[[nodiscard]] bool is_same(const MovingTransform& a, const MovingTransform& b);
[[nodiscard]] bool is_same(const Light& a, const Light& b);
[[nodiscard]] bool have_same_lamps(std::span<const Light> a, std::span<const Light> b);
[[nodiscard]] bool is_same(const EnvironmentLight& a, const EnvironmentLight& b);
/// null: none.
[[nodiscard]] bool is_same(const Surfaces* a, const Surfaces* b);

/// Whether two volumes scatter and glow alike where they have the same density.
[[nodiscard]] bool is_same_look(const Volume& a, const Volume& b);

}  // namespace mote
