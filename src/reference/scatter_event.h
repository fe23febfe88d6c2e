#pragma once

#include <optional>
#include <span>

#include "core/rng.h"
#include "reference/equiangular.h"
#include "surfaces/bsdf.h"
#include "volumes/phase.h"

namespace mote {

/// Places that light scattered at one event may go to, each with a probability: the event is then
/// sampled, and weighted by MIS, for all of them alike.
struct WayMixture {
    std::span<const Vec3> wo;      ///< [unit, away from the event]
    std::span<const float> share;  ///< sum to 1
};

/// A scattering event, about to be lit: in a medium, or on a surface.
struct ScatterEvent {
    Vec3 x;   ///< world [m]
    Vec3 wo;  ///< where the path came from [unit, away from x]
    float time = 0.0f;
    const Phase* phase = nullptr;            ///< of the medium
    const FirstEvent* first = nullptr;       ///< set if equiangular sampling competes
    const SurfaceVertex* surface = nullptr;  ///< set on surfaces; there is no phase then
    const WayMixture* mixture = nullptr;     ///< instead of wo, if set
};

/// How an event scatters light from one direction.
struct Scattering {
    Spectrum f{0.0f};      ///< phase function, or BSDF times cosine [1/sr]; of a mixture
                           ///< the mean
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
    if (!event.mixture) return eval_scattering_to(event, event.wo, wi);
    Scattering sum;
    for (size_t i = 0; i < event.mixture->wo.size(); ++i) {
        const float share = event.mixture->share[i];
        const Scattering s = eval_scattering_to(event, event.mixture->wo[i], wi);
        sum.f += share * s.f;
        sum.pdf_dir += share * s.pdf_dir;
    }
    return sum;
}

/// A scattered direction, drawn with density pdf_dir of its scattering; of a mixture
/// either way is taken with its share. Empty if nothing is scattered.
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
