#pragma once

#include <optional>

#include "restir/path_sample.h"
#include "restir/pixel_domain.h"

namespace mote {

/// A sample in another domain.
struct ShiftedSample {
    PathSample y;
    float jacobian = 1.0f;  ///< |du'/du| > 0
};

/// A ray's random number in another domain.
struct ShiftedNumber {
    float u = 0.0f;
    float jacobian = 1.0f;  ///< |du'/du| > 0
};

/// How points of one ray go to another: distance t' = offset + slope t, the projection of the moved
/// point on the new ray. Affine, so its inverse is exact. slope is the cosine between the rays.
struct RayMap {
    double offset = 0.0;
    float slope = 1.0f;

    [[nodiscard]] RayMap inverse() const
    {
        const double s = static_cast<double>(slope);
        return {-offset / s, static_cast<float>(1.0 / s)};
    }
    [[nodiscard]] bool is_usable() const { return slope > 0.1f && slope < 10.0f; }
};

/// Map from ray `from` to ray `to` for points that move by `motion` [m] on the way.
[[nodiscard]] RayMap make_ray_map(const Ray& from, const Ray& to, Vec3 motion);

/// A domain as one end of a shift.
struct ShiftEnd {
    const FrameDomain& frame;
    const PixelDomain& domain;
};

/// Whether the light's part of a sample means the same kind of thing in both frames. Where lights
/// come and go their numbers move, and a lamp's random numbers are no direction to the sky: then
/// neither frame could have made the other's sample.
[[nodiscard]] bool has_equal_measure(const FrameDomain& from, const FrameDomain& to, int light);

/// Takes a distance from one domain to another, by `kind`:
///   RandomNumbers  u' = u. Jacobian 1.
///   World          the point, moved by `map`, is found again: J = (slope sigma_t' T' / w') /
///                  (sigma_t T / w), with w the weight of RayPoint.
///   Fraction       F(s') = F(s), F the share of collisions before s: J = (w / w') (L' / L), L the
///                  ray's share of light that collides.
/// Empty where the map is not defined: no medium on either side. Shifting back by the inverse map
/// gives the number again, up to rounding.
[[nodiscard]] std::optional<ShiftedNumber> shift_number(ShiftKind kind, float u,
                                                        const ShiftEnd& from, const ShiftEnd& to,
                                                        const RayMap& map);

/// Takes a sample from one domain to another: its distance as above; the light's part is copied, as
/// its measure does not depend on the pixel. Empty also where the light is of another kind in the
/// other frame.
[[nodiscard]] std::optional<ShiftedSample> shift(ShiftKind kind, const PathSample& y,
                                                 const ShiftEnd& from, const ShiftEnd& to,
                                                 const RayMap& map);

}  // namespace mote
