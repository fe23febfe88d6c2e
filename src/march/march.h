#pragma once

#include <memory>

#include "march/shadow_grid.h"

namespace mote {

/// What a marched ray brings; the parts of L are disjoint.
struct MarchResult {
    Spectrum direct{0.0f};      ///< scattered once
    Spectrum emission{0.0f};    ///< of glowing media
    Spectrum background{0.0f};  ///< sky and lamps seen through the media
    float transmittance = 1.0f;
    int steps = 0;
};

/// A frame ready to be marched: what production renderers do where noise is not allowed. Fixed
/// steps along camera rays, shadows from a grid, light scattered once. Deterministic and biased: by
/// the steps, by the grid, by lamps without size, by a sky of few directions; light of glowing
/// media is not scattered, nothing moves while the shutter is open. A baseline for `mote bench`,
/// used by nothing else.
class Marcher {
  public:
    /// `shadows` are those of the scene's media and of `lights`, which are march_lights().
    Marcher(const Scene& scene, const MarchParams& params, std::vector<MarchLight> lights,
            std::shared_ptr<const ShadowGrid> shadows);
    /// Builds its shadows.
    Marcher(const Scene& scene, const MarchParams& params);

    /// ray.d must be a unit vector; its time does not count.
    [[nodiscard]] MarchResult march(const Ray& ray) const;

  private:
    [[nodiscard]] Spectrum in_scatter(Vec3 x, Vec3 wo, float& sigma_t, Spectrum& emitted) const;

    const Scene* scene_;
    std::vector<MarchLight> lights_;
    std::shared_ptr<const ShadowGrid> shadows_;
    std::vector<Bounds3> bounds_;  ///< of the volumes
    float step_ = 1.0f;            ///< [m]
};

}  // namespace mote
