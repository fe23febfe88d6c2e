#pragma once

#include "restir/environment_nodes.h"
#include "volumes/phase.h"

namespace mote {

/// In-scatter of the environment by a phase function no narrower than the hats, which is evaluated
/// at their middles (see EnvironmentCache, whose documentation holds for the calls):
///   directional(x, wi) = sum over nodes n and hats k of hat_n(x) hat_k(wi) ph(n, w_k) T_k(n)
///   L_k inscatter(x)       = sum over nodes n and all k  of hat_n(x) (4 pi / K) ph(n, w_k) T_k(n)
///   L_k
class WideInscatter {
  public:
    WideInscatter(const Phase& phase, const EnvironmentNodes& nodes);

    [[nodiscard]] Spectrum inscatter(const EnvironmentNodes& nodes, Vec3 x) const;
    /// `hat`: at wi, of the nodes' hats.
    [[nodiscard]] Spectrum directional(const EnvironmentNodes& nodes, Vec3 x,
                                       const DirectionHats::Weights& hat) const;
    [[nodiscard]] int64_t memory_bytes() const;

  private:
    /// Phase function times transmittance for all directions, seen along d.
    void scatter(Vec3 d, const float* transmittance, float* row) const;
    /// Sum over k of row[k] L_k.
    [[nodiscard]] Spectrum sum_of_light(const float* row) const;

    Phase phase_;
    std::vector<float> light_[3];      ///< red, green, blue of L_k; padded like a row
    std::vector<float> direction_[3];  ///< x, y, z of w_k
    std::vector<float> scattered_;     ///< ph(n, w_k) T_k(n): rows per slot, as transmittances
    std::vector<PaddedSpectrum> inscatter_;  ///< per slot; slot 0 means nothing in both
};

}  // namespace mote
