#pragma once

#include "restir/environment_nodes.h"
#include "volumes/phase.h"

namespace mote {

/// In-scatter of the environment by a phase function no narrower than the hats, which is evaluated
/// at their middles (see EnvironmentCache, whose documentation holds for the calls):
///   directional(x, wo, wi) = sum over nodes n and hats k of hat_n(x) hat_k(wi) ph(n, w_k) T_k(n)
///   L_k inscatter(x)       = sum over nodes n and all k  of hat_n(x) (4 pi / K) ph(n, w_k) T_k(n)
///   L_k
class WideInscatter {
  public:
    WideInscatter(const Phase& phase, const EnvironmentNodes& nodes);

    [[nodiscard]] Spectrum inscatter(const EnvironmentNodes& nodes, Vec3 x) const;
    [[nodiscard]] Spectrum directional(const EnvironmentNodes& nodes, Vec3 x, Vec3 wo,
                                       Vec3 wi) const;
    [[nodiscard]] int64_t memory_bytes() const;

  private:
    [[nodiscard]] Spectrum at_node(const EnvironmentNodes& nodes, Vec3 position,
                                   const float* transmittance) const;

    Phase phase_;
    bool is_isotropic_ = true;
    std::vector<float> light_[3];      ///< red, green, blue of L_k; padded like a row
    std::vector<float> direction_[3];  ///< x, y, z of w_k
    std::vector<Spectrum> inscatter_;  ///< per slot; [0] means nothing
};

}  // namespace mote
