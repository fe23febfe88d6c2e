#pragma once

#include <vector>

#include "scene/light.h"

namespace mote {

/// A sphere of directions cut into equal areas: bands of equal height along world y (up, as in
/// environment maps), each cut into the same number of azimuths. Functions of direction are given
/// by one value per area and interpolated bilinearly in height and azimuth, clamped at the poles:
/// every direction's hat function integrates to the same solid angle, 4 pi / count().
struct DirectionHats {
    int bands = 6;      ///< >= 1
    int azimuths = 12;  ///< >= 1

    [[nodiscard]] int count() const { return bands * azimuths; }
    [[nodiscard]] float solid_angle() const { return 4.0f * pi / static_cast<float>(count()); }

    /// Middle of area k in [0, count()), azimuth fastest [unit].
    [[nodiscard]] Vec3 centre(int k) const;

    /// The area opposite to area k; -1 for odd numbers of azimuths, which have none.
    [[nodiscard]] int opposite(int k) const
    {
        if (azimuths % 2 != 0) return -1;
        return (bands - 1 - k / azimuths) * azimuths + (k + azimuths / 2) % azimuths;
    }

    /// The hats that are not 0 at a direction, and their values there; they sum to 1.
    struct Weights {
        int index[4];
        float weight[4];
    };

    /// wi [unit]; any finite or non-finite vector gives valid indices and weights.
    [[nodiscard]] Weights at(Vec3 wi) const;

    /// The same on the unit square that the sphere maps to: u in [0,1] across the bands, v in turns
    /// in [-1,1] along the azimuths.
    [[nodiscard]] Weights at_square(float u, float v) const;
};

/// Mean radiance of the environment under each hat [W/(m^2 sr)], count() values: summed, times
/// solid_angle(), they give the environment's fluence. Depends on the environment alone: compute it
/// once. Cost: about 0.1 us per pixel of the image, at least 512 x 256.
[[nodiscard]] std::vector<Spectrum> mean_radiance(const EnvironmentLight& environment,
                                                  const DirectionHats& hats);

}  // namespace mote
