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

/// CPU time that the process has used so far, all threads [s].
[[nodiscard]] double process_cpu_seconds();

}  // namespace mote
