#pragma once

#include <cstddef>
#include <functional>

namespace mote {

/// Calls f(begin, end) over disjoint chunks of [0, count), in parallel. Chunk borders depend only
/// on `grain`, never on the thread count. Exceptions thrown by f reach the caller.
void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& f);

/// A rectangle of pixels, [x0,x1) x [y0,y1).
struct Tile {
    int x0, y0, x1, y1;
};

inline constexpr int image_tile_size = 16;

/// Calls f(tile) for 16x16 tiles covering the image, in parallel. A tile is the unit of scheduling:
/// per-thread set-up belongs here, pixels do not depend on each other.
void for_each_tile(int width, int height, const std::function<void(const Tile&)>& f);

/// Threads this process may use: the affinity mask and SLURM_CPUS_PER_TASK, not the machine's
/// total.
[[nodiscard]] int available_threads();

/// Runs f with exactly `count` threads (>= 1) for every parallel loop inside it, more than the
/// machine has cores included. What `--threads` means.
void run_with_threads(int count, const std::function<void()>& f);

/// Threads worth starting now beside TBB's: what is available, or a lower limit in force.
[[nodiscard]] int thread_limit();

}  // namespace mote
