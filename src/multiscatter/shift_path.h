#pragma once

#include <optional>

#include "multiscatter/walk_path.h"
#include "restir/shift.h"

namespace mote {

/// Where paths live: one pixel of one frame.
struct PathEndpoint {
    const PathWorld& world;
    const PixelDomain& domain;

    [[nodiscard]] ShiftEnd end() const { return {world.frame, domain}; }
};

/// What becomes of what a path found with its random numbers.
enum class SuffixRule {
    Kept,    ///< it stays: right where media, lights and surfaces are the same
    Traced,  ///< it is found again, with the same random numbers, in the other frame
};

/// How paths go from one pixel to another.
struct PathMap {
    ShiftKind kind = ShiftKind::RandomNumbers;
    RayMap ray;         ///< between camera rays
    Vec3 motion{0.0f};  ///< of second vertices: the media's, on the way [m]
    SuffixRule suffix = SuffixRule::Kept;

    [[nodiscard]] PathMap inverse() const { return {kind, ray.inverse(), -motion, suffix}; }
};

/// A path in another domain.
struct ShiftedPath {
    ReusedPath y;
    float jacobian = 1.0f;  ///< of the form's measure, > 0
    Spectrum f{0.0f};       ///< the light that y brings there
};

/// Takes a path to another pixel's domain. Its first vertex goes as a sample's distance does (see
/// shift_number). Then, by its form:
///   ToLight, ToRay  the second vertex, moved by `motion`, is seen from the new first one:
///                   J = J(u) r^2 / r'^2, r the distance between both;
///   Replay          the random numbers stay: J = J(u).
/// Empty where the path has no counterpart, or one of no light. Back by the inverse map it is the
/// same path again, up to rounding. Reconnection: Lin et al. 2021 and 2022, Ouyang et al. 2021
/// (there with cosines, for surfaces); random replay: Hua et al. 2019, Lin et al. 2022.
[[nodiscard]] std::optional<ShiftedPath> shift_path(const ReusedPath& y, const PathEndpoint& from,
                                                    const PathEndpoint& to, const PathMap& map);

}  // namespace mote
