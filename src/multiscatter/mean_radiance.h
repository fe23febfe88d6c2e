#pragma once

#include <optional>
#include <vector>

#include "multiscatter/radiance_cache.h"

namespace mote {

/// What arrives at each place having scattered at least once, in the mean over directions: a smooth
/// guess of the light of many events. As a control variate of paths that are shared, it takes from
/// them the noise of how many of a group's paths a vertex gets. Nothing is biased whatever it says.
///
/// Of a RadianceCache's orders the others cost more by their noise than they know (measured: dense
/// cloud, g = 0.85, variance 17 % more with order 1, 14 % with order 2).
struct MeanRadiance {
    SmokeLattice lattice;
    std::vector<Spectrum> values;  ///< per slot [W/(m^2 sr)]; slot 0 is black
    int frames = 1;                ///< that it is a mean of

    /// Trilinear between active nodes; black where there are none.
    [[nodiscard]] Spectrum at(Vec3 x) const { return known_at(x).value_or(Spectrum(0.0f)); }
    /// The same, empty where there are none.
    [[nodiscard]] std::optional<Spectrum> known_at(Vec3 x) const;
    [[nodiscard]] size_t memory_bytes() const
    {
        return static_cast<size_t>(lattice.memory_bytes()) + values.size() * sizeof(Spectrum);
    }
};

/// A cache's mean over directions, smoothed over the nodes around. Nodes that are not finite count
/// as black: their paths would be missing once, but what they spread to for good.
[[nodiscard]] MeanRadiance mean_radiance(RadianceCache cache);

/// Makes `now` the mean of itself and of what earlier frames knew, as if these had been at most
/// `most_frames`. Lattices may differ; where nothing was known, `now` is left as it is.
void blend_in(const MeanRadiance& before, int most_frames, MeanRadiance& now);

}  // namespace mote
