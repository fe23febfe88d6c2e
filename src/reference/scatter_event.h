#pragma once

#include "reference/equiangular.h"
#include "surfaces/bsdf.h"
#include "volumes/phase.h"

namespace mote {

/// A scattering event, about to be lit: in a medium, or on a surface.
struct ScatterEvent {
    Vec3 x;   ///< world [m]
    Vec3 wo;  ///< where the path came from [unit, away from x]
    float time = 0.0f;
    const Phase* phase = nullptr;            ///< of the medium
    const FirstEvent* first = nullptr;       ///< set if equiangular sampling competes
    const SurfaceVertex* surface = nullptr;  ///< set on surfaces; there is no phase then
};

/// How an event scatters light from one direction.
struct Scattering {
    Spectrum f{0.0f};      ///< phase function, or BSDF times cosine [1/sr]
    float pdf_dir = 0.0f;  ///< with which sample_scattering draws the direction [1/sr]
};

[[nodiscard]] inline Scattering eval_scattering(const ScatterEvent& event, Vec3 wi)
{
    if (event.surface) {
        const BsdfValue value = eval_bsdf_and_pdf(*event.surface, event.wo, wi);
        return {value.cosine * value.f, value.pdf_dir};
    }
    const float phase = eval_phase(*event.phase, event.wo, wi);
    return {Spectrum(phase), phase};
}

/// Where a ray that leaves the event starts.
[[nodiscard]] inline Vec3 ray_origin(const ScatterEvent& event, Vec3 direction)
{
    return event.surface ? ray_origin(*event.surface, direction) : event.x;
}

}  // namespace mote
