#pragma once

#include <memory>

#include "restir/direction_transmittance.h"

namespace mote {

/// Light of the environment inside the smoke, scattered once, as seen from one camera position.
/// With w_k the directions, L_k the environment's mean radiance under hat k, T_k(x) the cached
/// transmittance, and ph the phase function at a node of the lattice, seen from the camera:
///   directional(x, wi) = sum over nodes n and hats k of hat_n(x) hat_k(wi) ph(n, w_k) T_k(n) L_k
///   inscatter(x)       = sum over nodes n and all k  of hat_n(x) (4 pi / K) ph(n, w_k) T_k(n) L_k
/// so that the integral of directional over all wi is inscatter: exactly what a control variate
/// needs. Neither holds the albedo.
///
/// Approximate, for targets, proposals and control variates only. Phase functions are widened to
/// the hats: convolved with a Henyey-Greenstein lobe of their size, which only multiplies g.
///
/// Transmittances outlive cameras and environments (share them); a new one of either costs a bake.
class EnvironmentCache {
  public:
    /// No light anywhere.
    EnvironmentCache() = default;

    /// `radiance`: mean_radiance() for the same hats; `camera_position` in world space [m].
    /// `media`: those of `transmittance`, for their phase functions.
    EnvironmentCache(std::shared_ptr<const DirectionTransmittance> transmittance,
                     std::vector<Spectrum> radiance, const Media& media, Vec3 camera_position);

    /// Moves the camera. Cost: about 1 ns per active node, direction and phase function.
    void bake(Vec3 camera_position);

    /// Number of a volume's phase function, for the calls below; equal ones share a number.
    [[nodiscard]] int phase_of(size_t volume) const { return phase_of_volume_[volume]; }

    /// Environment light scattered towards the camera at x: the integral over directions of
    /// radiance, transmittance and phase function [W/(m^2 sr)].
    [[nodiscard]] Spectrum inscatter(int phase, Vec3 x) const;

    /// Its density in wi [unit]; integrates to inscatter [W/(m^2 sr^2)].
    [[nodiscard]] Spectrum directional(int phase, Vec3 x, Vec3 wi) const;

    /// Of the last bake alone.
    [[nodiscard]] const CacheStats& stats() const { return stats_; }

  private:
    /// A phase function as the sums use it.
    struct Lobes {
        Phase phase;  ///< widened
        bool is_isotropic = true;
        std::vector<Spectrum> inscatter;  ///< per slot; [0] unused
    };

    [[nodiscard]] Spectrum at_node(const Phase& phase, Vec3 node, const float* transmittance) const;

    std::shared_ptr<const DirectionTransmittance> transmittance_;
    std::vector<float> light_[3];      ///< red, green, blue of L_k; padded like a row
    std::vector<float> direction_[3];  ///< x, y, z of w_k
    std::vector<int> phase_of_volume_;
    std::vector<Lobes> lobes_;
    Vec3 camera_{0.0f};
    CacheStats stats_;
};

}  // namespace mote
