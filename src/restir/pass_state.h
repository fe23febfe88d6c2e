#pragma once

#include "restir/domain_store.h"
#include "restir/reservoir.h"
#include "restir/surface_domain.h"

namespace mote {

/// A pixel's reservoir on its way through a pass, with what its sample contributes in colour
/// (shadows included): luminance(f) is the target, p_hat.
struct PixelReservoir {
    Reservoir r;
    Spectrum f{0.0f};
};

/// A pass that later ones may reuse: what its samples depend on, and the samples. Everything per
/// pixel: 40 bytes of reservoir and the packed domain; with surfaces another reservoir and 150
/// bytes of surface domain.
struct FinishedPass {
    FrameDomain frame;
    DomainStore domains;
    Buffer2D<Reservoir> reservoirs;
    Buffer2D<SurfaceDomain> surfaces{};  ///< empty: the scene has none
    Buffer2D<Reservoir> surface_reservoirs{};

    [[nodiscard]] bool empty() const { return domains.empty(); }
};

}  // namespace mote
