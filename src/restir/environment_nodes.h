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

/// A colour that fills a vector register: a lookup of eight of them is eight loads.
struct alignas(16) PaddedSpectrum {
    float c[4]{};

    PaddedSpectrum() = default;
    explicit PaddedSpectrum(Spectrum s) : c{s.x, s.y, s.z, 0.0f} {}
};

/// Interpolates values kept per slot; at_inactive(node position) gives those of nodes without,
/// which only points outside of smoke meet.
template <class AtInactive>
[[nodiscard]] Spectrum interpolate_nodes(const SmokeLattice& lattice,
                                         const std::vector<PaddedSpectrum>& per_slot, Vec3 x,
                                         AtInactive&& at_inactive)
{
    const SmokeLattice::Corners corners = lattice.corners(x);
    // Slot 0 holds zeros.
    float sum[4] = {};
    for (int n = 0; n < 8; ++n) {
        const PaddedSpectrum& value = per_slot[static_cast<size_t>(corners.slot[n])];
        for (int c = 0; c < 4; ++c) sum[c] += corners.weight[n] * value.c[c];
    }
    Spectrum out(sum[0], sum[1], sum[2]);
    for (int n = 0; n < 8; ++n) {
        if (corners.slot[n] != 0 || !(corners.weight[n] > 0.0f)) continue;
        out += corners.weight[n] * at_inactive(lattice.position(corners.node(n)));
    }
    return out;
}

}  // namespace mote
