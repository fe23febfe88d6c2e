#pragma once

#include <functional>
#include <optional>

#include "core/transform.h"

namespace mote {

/// Translation, rotation and scale of a matrix; mirrors become a negative scale along x. Empty if
/// it is sheared (its columns are not at right angles, to 1e-4) or flattens space.
[[nodiscard]] std::optional<Trs> decompose(const Mat4d& matrix);

/// Whether the matrix flattens space to a plane or less.
[[nodiscard]] bool is_flat(const Mat4d& matrix);

/// A transform over [open, close] in frames from the matrix at each instant, at `steps` + 1 keys,
/// one if none differs. Empty if any of them is sheared or flat.
[[nodiscard]] std::optional<MovingTransform> matrix_motion(
    const std::function<Mat4d(double frame)>& matrix_at, double open, double close, int steps);

}  // namespace mote
