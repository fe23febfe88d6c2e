#pragma once

#include <optional>

#include "core/math.h"

namespace mote {

/// Somebody's better way to choose among many lamps that are not at infinity, by what is known of
/// the smoke between. Any distribution will do that leaves no lamp out.
class LightGuide {
  public:
    struct Choice {
        int lamp = -1;  ///< into Scene::lights
        float pmf = 0.0f;
    };

    LightGuide() = default;
    LightGuide(const LightGuide&) = delete;
    LightGuide& operator=(const LightGuide&) = delete;
    virtual ~LightGuide() = default;

    /// Chooses for point x; u in [0,1).
    [[nodiscard]] virtual Choice choose(Vec3 x, double u) const = 0;

    /// Probability of choose(x) returning this lamp.
    [[nodiscard]] virtual float pmf(int lamp, Vec3 x) const = 0;
};

}  // namespace mote
