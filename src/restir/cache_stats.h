#pragma once

#include <cstdint>

namespace mote {

/// What building a light cache cost.
struct CacheStats {
    double cpu_seconds = 0.0;  ///< of the whole process while building: all threads
    int64_t nodes = 0;         ///< values that stay in memory, per direction
    int64_t rays = 0;          ///< exact walks
    int64_t bytes = 0;         ///< that stay in memory
};

/// How much of each kind of light cache a frame has: 0 for lights that the scene lacks.
struct CacheParts {
    int transmittance_maps = 0;  ///< one per distant light
    int direction_sets = 0;      ///< 1 with an environment
    int64_t local_lights = 0;    ///< lamps and glowing media that candidates choose among
    int64_t light_cells = 0;     ///< cells with a distribution over them
    int64_t map_bytes = 0;       ///< of the transmittance maps
    int64_t direction_bytes = 0;
    int64_t environment_bytes = 0;  ///< of the sky's light scattered to this camera
    int64_t cell_bytes = 0;
    int64_t extinction_bytes = 0;  ///< of mean extinction

    [[nodiscard]] int64_t bytes() const
    {
        return map_bytes + direction_bytes + environment_bytes + cell_bytes + extinction_bytes;
    }
};

/// CPU time that the process has used so far, all threads [s].
[[nodiscard]] double process_cpu_seconds();

}  // namespace mote
