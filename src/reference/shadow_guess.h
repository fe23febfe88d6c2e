#pragma once

#include <optional>

#include "core/math.h"

namespace mote {

/// What somebody knows beforehand of shadows in media: a look-up in place of most shadow rays. Now
/// and then the exact shadow is asked for as well, and by how much it differs counts as often more,
/// so that wrong guesses cost variance, never bias.
class ShadowGuess {
  public:
    ShadowGuess() = default;
    ShadowGuess(const ShadowGuess&) = delete;
    ShadowGuess& operator=(const ShadowGuess&) = delete;
    virtual ~ShadowGuess() = default;

    /// About the transmittance from x along wi to infinity, in [0,1]; empty if nothing is known.
    [[nodiscard]] virtual std::optional<float> to_infinity(Vec3 x, Vec3 wi) const = 0;
};

}  // namespace mote
