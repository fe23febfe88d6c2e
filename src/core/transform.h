#pragma once

#include <vector>

#include "core/math.h"

namespace mote {

/// Translation, rotation and (non-uniform) scale; applied scale first.
struct Trs {
    Vec3d translate{0.0};  ///< [m]
    Quatd rotate{1.0, 0.0, 0.0, 0.0};
    Vec3d scale{1.0};

    bool operator==(const Trs&) const = default;
};

/// world_from_object matrix of a Trs.
[[nodiscard]] Mat4d matrix(const Trs& trs);

/// Between a (u = 0) and b (u = 1): linear in translation and scale, spherical in rotation.
[[nodiscard]] Trs interpolate(const Trs& a, const Trs& b, double u);

/// A transform over the shutter: keys at equal steps of ray time in [0,1]. One key: not moving.
struct MovingTransform {
    std::vector<Trs> keys{Trs{}};

    [[nodiscard]] bool is_moving() const { return keys.size() > 1; }
    [[nodiscard]] Trs at(float time) const;
    bool operator==(const MovingTransform&) const = default;
};

/// Keyframe of an object's transform. Between keys every number runs linearly, the angles too, so
/// that 0 to 360 degrees is a full turn; before the first and after the last key it stands still.
struct TransformKey {
    double frame = 0.0;
    Vec3d translate{0.0};  ///< [m]
    Vec3d rotate{0.0};     ///< angles about x, then y, then z [degrees]
    Vec3d scale{1.0};
};

/// Value of the key list, frames ascending, at a (fractional) frame; empty list: identity.
[[nodiscard]] Trs evaluate(const std::vector<TransformKey>& keys, double frame);

/// Transform over [open, close] in frames; sampled finely enough to catch keys and turns in
/// between.
[[nodiscard]] MovingTransform over_shutter(const std::vector<TransformKey>& keys, double open,
                                           double close);

/// Affine map in float, ready for the inner loop: p -> linear * p + offset.
struct Affine {
    Mat3 linear{1.0f};
    Vec3 offset{0.0f};

    [[nodiscard]] Vec3 point(Vec3 p) const { return linear * p + offset; }
    [[nodiscard]] Vec3 vector(Vec3 v) const { return linear * v; }
};

[[nodiscard]] Affine to_affine(const Mat4d& m);

}  // namespace mote
