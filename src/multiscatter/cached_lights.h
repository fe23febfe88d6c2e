#pragma once

#include <optional>

#include "multiscatter/cached_shadows.h"
#include "reference/light_guide.h"
#include "restir/light_caches.h"

namespace mote {

/// Lamps by the light cells of the caches, which know about how much of each lamp's light gets
/// through the smoke to each place.
class CachedLights final : public LightGuide {
  public:
    /// The cells must outlive it, and know lamps alone.
    explicit CachedLights(const LightCells& cells) : cells_(cells) {}

    [[nodiscard]] Choice choose(Vec3 x, double u) const override
    {
        const LightPick pick = cells_.sample(x, u);
        return {pick.light, pick.pmf};
    }
    [[nodiscard]] float pmf(int lamp, Vec3 x) const override { return cells_.pmf(lamp, x); }

  private:
    const LightCells& cells_;
};

/// A frame's guesses for paths of many events; empty where its caches know nothing.
struct CachedGuesses {
    explicit CachedGuesses(const LightCaches& caches);

    CachedShadows shadows;
    std::optional<CachedLights> lights;

    [[nodiscard]] const LightGuide* guide() const { return lights ? &*lights : nullptr; }
};

}  // namespace mote
