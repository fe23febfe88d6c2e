#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"

namespace mote {

/// Particles of one frame, structure of arrays. `position` is always full; every other array is
/// either as long as `position` or empty, which means "this source has no such attribute".
struct ParticleSet {
    std::vector<Vec3> position;      ///< world space [m]
    std::vector<Vec3> velocity;      ///< [m/s]
    std::vector<float> radius;       ///< kernel support radius [m]
    std::vector<float> mass;         ///< [kg]
    std::vector<float> temperature;  ///< [K]
    std::vector<Spectrum> color;     ///< scattering albedo, linear RGB in [0,1]
    std::vector<int64_t> id;         ///< stable over frames
    std::vector<float> age;          ///< since birth [s]

    [[nodiscard]] size_t size() const { return position.size(); }
};

}  // namespace mote
