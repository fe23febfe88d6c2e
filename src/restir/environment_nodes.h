#pragma once

#include <memory>

#include "restir/direction_transmittance.h"

namespace mote {

/// The environment at the nodes of a lattice, seen from one camera position: what the in-scatter of
/// every phase function is made from.
struct EnvironmentNodes {
    std::shared_ptr<const DirectionTransmittance> transmittance;
    std::vector<Spectrum> radiance;  ///< mean_radiance() for transmittance->hats()
    Vec3 camera{0.0f};               ///< world space [m]

    [[nodiscard]] const SmokeLattice& lattice() const { return transmittance->lattice(); }
};

/// Interpolates values kept per slot; at_inactive(node position) gives those of nodes without,
/// which only points outside of smoke meet.
template <class AtInactive>
[[nodiscard]] Spectrum interpolate_nodes(const SmokeLattice& lattice,
                                         const std::vector<Spectrum>& per_slot, Vec3 x,
                                         AtInactive&& at_inactive)
{
    const SmokeLattice::Corners corners = lattice.corners(x);
    Spectrum sum(0.0f);
    for (int n = 0; n < 8; ++n) {
        if (corners.slot[n] != 0) {
            sum += corners.weight[n] * per_slot[static_cast<size_t>(corners.slot[n])];
        } else if (corners.weight[n] > 0.0f) {
            sum += corners.weight[n] * at_inactive(lattice.position(corners.node(n)));
        }
    }
    return sum;
}

}  // namespace mote
