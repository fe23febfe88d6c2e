#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/math.h"
#include "particles/particle_set.h"
#include "particles/source.h"

namespace mote {

/// Range of one attribute over all particles; vectors by their components.
struct AttributeRange {
    std::string name;  ///< mote's: "position", "velocity", ...
    std::string unit;  ///< "m", "m/s", ...; may be empty
    int components = 1;
    double lo[3] = {0.0, 0.0, 0.0};
    double hi[3] = {0.0, 0.0, 0.0};
};

/// What `mote info` and `mote check` say about particles.
struct ParticleInfo {
    int64_t count = 0;
    Bounds3 bounds;                          ///< of the positions [m]; empty when there are none
    double total_mass = 0.0;                 ///< [kg]
    float largest_speed = 0.0f;              ///< [m/s]
    int64_t memory_bytes = 0;                ///< of the arrays
    std::vector<AttributeRange> attributes;  ///< those that the set has
};

[[nodiscard]] ParticleInfo describe_particles(const ParticleSet& particles);

/// A particle file in world units, read as `params` say (its sequence is not looked at).
/// Throws as particles_at does.
[[nodiscard]] ParticleInfo describe_particle_file(const std::string& path,
                                                  const CacheParams& params = {},
                                                  double fps = 24.0);

/// What the header of a particle file tells, its particles unread.
struct ParticleHeader {
    /// mote's names of the attributes that it has; empty: only its particles tell (.vdb points).
    std::optional<std::vector<std::string>> attributes;
};

/// Cost: a few milliseconds, however large the file. Throws as particles_at does for what a header
/// can show: another format, missing positions, more particles than the file has room for.
[[nodiscard]] ParticleHeader describe_particle_header(const std::string& path,
                                                      const CacheParams& params = {});

}  // namespace mote
