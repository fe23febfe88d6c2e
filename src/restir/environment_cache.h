#pragma once

#include <variant>

#include "restir/narrow_inscatter.h"
#include "restir/wide_inscatter.h"
#include "volumes/phase_list.h"

namespace mote {

/// Light of the environment inside the smoke, scattered once, as seen from one camera position; the
/// albedo is left out. Approximate: for targets, proposals and control variates only.
///
/// The integral of directional() over all wi is inscatter(), for any wo: what a control variate
/// needs. It holds to float rounding: 1e-6, and even for the narrowest lobes when wi is drawn by
/// sample_phase(phase, wo) and directional() divided by phase_pdf(phase, wo, wi), whose roundings
/// cancel.
///
/// Transmittances outlive cameras and environments (share them, and see media_key.h); a new one of
/// either costs a bake. Phase functions come in two kinds, by how narrow they are.
class EnvironmentCache {
  public:
    /// No light anywhere; no phase functions.
    EnvironmentCache() = default;

    /// `radiance`: mean_radiance() for transmittance->hats(). `media`: those of `transmittance`,
    /// for their phase functions. `camera_position` in world space [m].
    EnvironmentCache(std::shared_ptr<const DirectionTransmittance> transmittance,
                     std::vector<Spectrum> radiance, const Media& media, Vec3 camera_position);

    /// Moves the camera. Cost: per active node, direction and distinct phase function 3 ns, for
    /// narrow ones 15 ns; memory 4 bytes, for narrow ones 12.
    void bake(Vec3 camera_position);

    /// Number of a volume's phase function, for the calls below; equal ones share a number.
    [[nodiscard]] int phase_of(size_t volume) const { return phases_.of_volume[volume]; }

    /// Environment light scattered towards the camera at world point x: the integral over
    /// directions of radiance, transmittance and phase function [W/(m^2 sr)]. Finite and >= 0 for
    /// any x.
    [[nodiscard]] Spectrum inscatter(int phase, Vec3 x) const;

    /// A direction wi in which light is looked for from points on one camera ray.
    struct Towards {
        int phase = 0;
        DirectionHats::Weights hat{};
        float scale = 0.0f;
    };
    /// wo [unit] points from the points to the camera, or nearly (lenses); both away from the
    /// vertex.
    [[nodiscard]] Towards towards(int phase, Vec3 wo, Vec3 wi) const;

    /// In-scatter's density in that direction: radiance, transmittance and phase function
    /// [W/(m^2 sr^2)]. Finite and >= 0.
    [[nodiscard]] Spectrum directional(const Towards& towards, Vec3 x) const;
    [[nodiscard]] Spectrum directional(int phase, Vec3 x, Vec3 wo, Vec3 wi) const
    {
        return directional(towards(phase, wo, wi), x);
    }

    /// Of the last bake alone.
    [[nodiscard]] const CacheStats& stats() const { return stats_; }

  private:
    using Inscatter = std::variant<WideInscatter, NarrowInscatter>;

    EnvironmentNodes nodes_;
    PhaseList phases_;
    std::vector<Inscatter> inscatter_;  ///< per phase
    CacheStats stats_;
};

}  // namespace mote
