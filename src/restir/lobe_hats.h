#pragma once

#include "restir/direction_hats.h"
#include "volumes/phase.h"

namespace mote {

/// Share [0,1] of what a phase function scatters that goes at least as far forward as an angle: its
/// integral from there to straight ahead. The angle is given as 1 - cos and 1 + cos, in [0,2], so
/// that nothing cancels near the peaks.
[[nodiscard]] float phase_share(const Phase& phase, float one_minus_cos, float one_plus_cos);

/// Frames around directions that turn with them smoothly: two directions close together have frames
/// close together, except far from the middle one.
class FrameField {
  public:
    /// `middle` [unit].
    explicit FrameField(Vec3 middle = Vec3(0.0f, 0.0f, 1.0f)) : base_(make_frame(middle)) {}

    /// Orthonormal; d [unit] is the third column.
    [[nodiscard]] Mat3 at(Vec3 d) const;
    [[nodiscard]] Vec3 middle() const { return base_[2]; }

  private:
    Mat3 base_;
};

/// Hats on the square to which a phase function maps directions around the direction that light
/// travels in: the share scattered further forward, and the azimuth. The phase function is uniform
/// there, so every hat, times it, integrates to 1 / count(), however narrow its lobes. A function
/// of direction given by values at the hats is finest where the phase function is strongest.
class LobeHats {
  public:
    LobeHats(const Phase& phase, const DirectionHats& shape);

    [[nodiscard]] int count() const { return shape_.count(); }

    /// Middle of hat j around +z [unit].
    [[nodiscard]] Vec3 centre(int j) const { return centres_[static_cast<size_t>(j)]; }

    /// wi and d, the third column of the frame, in one space [unit]. Any vector gives valid indices
    /// and weights.
    [[nodiscard]] DirectionHats::Weights at(const Mat3& frame, Vec3 wi) const;

  private:
    Phase phase_;
    DirectionHats shape_;
    std::vector<Vec3> centres_;
};

}  // namespace mote
