#pragma once

#include <optional>

#include "core/rng.h"
#include "reference/equiangular.h"
#include "surfaces/bsdf.h"
#include "volumes/phase.h"

namespace mote {

/// Two places that light scattered at one event goes to, each with a weight of any sign: one path
/// behind the event then serves both.
struct TwoWays {
    Vec3 wo[2];  ///< [unit, away from the event]
    Spectrum weight[2]{Spectrum(0.0f), Spectrum(0.0f)};
};

/// A scattering event, about to be lit: in a medium, or on a surface.
struct ScatterEvent {
    Vec3 x;   ///< world [m]
    Vec3 wo;  ///< where the path came from [unit, away from x]
    float time = 0.0f;
    const Phase* phase = nullptr;            ///< of the medium
    const FirstEvent* first = nullptr;       ///< set if equiangular sampling competes
    const SurfaceVertex* surface = nullptr;  ///< set on surfaces; there is no phase then
    const TwoWays* ways = nullptr;           ///< instead of wo, if set
};

/// How an event scatters light from one direction.
struct Scattering {
    Spectrum f{0.0f};      ///< phase function, or BSDF times cosine [1/sr]; of two ways the
                           ///< weighted sum
    float pdf_dir = 0.0f;  ///< with which sample_scattering draws the direction [1/sr]
};

/// Towards one place.
[[nodiscard]] inline Scattering eval_scattering_to(const ScatterEvent& event, Vec3 wo, Vec3 wi)
{
    if (event.surface) {
        const BsdfValue value = eval_bsdf_and_pdf(*event.surface, wo, wi);
        return {value.cosine * value.f, value.pdf_dir};
    }
    const float phase = eval_phase(*event.phase, wo, wi);
    return {Spectrum(phase), phase};
}

[[nodiscard]] inline Scattering eval_scattering(const ScatterEvent& event, Vec3 wi)
{
    if (!event.ways) return eval_scattering_to(event, event.wo, wi);
    const TwoWays& ways = *event.ways;
    const Scattering a = eval_scattering_to(event, ways.wo[0], wi);
    const Scattering b = eval_scattering_to(event, ways.wo[1], wi);
    return {ways.weight[0] * a.f + ways.weight[1] * b.f, 0.5f * (a.pdf_dir + b.pdf_dir)};
}

/// A scattered direction, drawn with density pdf_dir of its scattering. Of two ways either is taken
/// with probability 1/2. Empty if nothing is scattered.
struct ScatteredDirection {
    Vec3 wi{0.0f};
    Scattering scattering;
};
[[nodiscard]] std::optional<ScatteredDirection> sample_scattering(const ScatterEvent& event,
                                                                  Rng& rng);

/// Where a ray that leaves the event starts.
[[nodiscard]] inline Vec3 ray_origin(const ScatterEvent& event, Vec3 direction)
{
    return event.surface ? ray_origin(*event.surface, direction) : event.x;
}

}  // namespace mote
