#pragma once

#include "reference/path_tracer.h"

namespace mote {

/// One of two events that are compared.
struct PairedEvent {
    Vec3 x{0.0f};   ///< world [m]
    Vec3 wo{0.0f};  ///< where the light goes to [unit, away from x]
    const Phase* phase = nullptr;
    Spectrum weight{0.0f};  ///< what the light counts with, albedo included
};

/// What estimate_difference may do.
struct PairedPathParams {
    float reach = 0.0f;  ///< mean length of segments followed side by side; longer ones lead both
                         ///< paths to one place [m]
    bool translates = true;  ///< false: none is; needed where phase functions differ
    float roulette = 0.25f;  ///< differences below this are followed less often
};

/// Solid angle that a patch at `y` covers seen from b, over that seen from a: the Jacobian of
/// leading a's path and b's to one place. `normal` of the patch; null: of a place in a medium,
/// where the distances alone count. 0 if b lies in y.
[[nodiscard]] float solid_angle_ratio(Vec3 a, Vec3 b, Vec3 y, const Vec3* normal);

/// Unbiased estimate of here.weight J(here) - there.weight J(there), where J is the light scattered
/// at an event that has scattered elsewhere before: max_bounces events at most, the event itself
/// included. Either event starts the path, with a probability in proportion to its weight; the
/// other one is led along: side by side on short segments (the same offset, Jacobian 1), to the
/// same place on long ones (Jacobian of the two solid angles). From there on one path serves both,
/// with the difference of what it brings to either as its weight. Weighted by the balance heuristic
/// over the two ways to make the pair. The nearer the events, the less is left. An event without a
/// phase function stands for none; weights are >= 0.
///
/// Reconnection and random replay: Lin et al. 2022 (GRIS), used here between two points in space
/// rather than two pixels; gradient-domain path tracing (Kettunen et al. 2015) is its next of kin.
[[nodiscard]] Spectrum estimate_difference(const TraceContext& context, const PairedEvent& here,
                                           const PairedEvent& there, float time,
                                           const PairedPathParams& params, Rng& rng,
                                           bool& truncated);

}  // namespace mote
