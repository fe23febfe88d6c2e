#pragma once

#include "reference/shadow_guess.h"
#include "restir/light_caches.h"

namespace mote {

/// What the light caches know of shadows: of distant lights by their maps, of all other directions
/// by the direction set, if the scene has them.
class CachedShadows final : public ShadowGuess {
  public:
    /// The caches must outlive it.
    explicit CachedShadows(const LightCaches& caches) : caches_(caches) {}

    [[nodiscard]] std::optional<float> to_infinity(Vec3 x, Vec3 wi) const override;

  private:
    const LightCaches& caches_;
};

}  // namespace mote
