#pragma once

#include "reference/shadow_guess.h"

namespace mote::test {

/// Says the same everywhere.
class ConstantGuess final : public ShadowGuess {
  public:
    explicit ConstantGuess(float T) : T_(T) {}
    [[nodiscard]] std::optional<float> to_infinity(Vec3, Vec3) const override { return T_; }

  private:
    float T_;
};

}  // namespace mote::test
