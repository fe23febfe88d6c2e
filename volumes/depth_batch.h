#pragma once

#include <cstdint>
#include <span>

#include "volumes/tracking.h"

namespace mote {

/// A segment whose optical depth is wanted: from o along the unit vector d over (0, t1).
struct DepthQuery {
    Vec3 o{0.0f};  ///< world space [m]
    float t1 = infinity;
    Vec3 d{0.0f, 0.0f, 1.0f};
    float time = 0.0f;         ///< of the ray, [0,1]
    float tau_max = infinity;  ///< depth beyond which nothing matters
};

/// What walks have cost so far.
struct WalkCounts {
    uint64_t rays = 0;            ///< times volumes that they meet
    uint64_t bricks = 0;          ///< pieces of rays through bricks
    uint64_t uniform_bricks = 0;  ///< those among them of one value: closed form, no cells
    uint64_t cells = 0;           ///< pieces integrated in closed form

    void add(const WalkCounts& other)
    {
        rays += other.rays;
        bricks += other.bricks;
        uniform_bricks += other.uniform_bricks;
        cells += other.cells;
    }
};

/// tau[i] = optical depth of queries[i] through all media, exact up to float rounding; where it
/// exceeds tau_max, any value of at least tau_max. 0 for rays that are not finite. Asserts that
/// tau is as long as queries.
///
/// Each result depends on its own query alone, bit for bit: not on the batch around it, nor on the
/// instruction set (walk_isa). Rays are cut into pieces through bricks; pieces that cross equally
/// many cells run side by side in the lanes of a vector. Cost per cell, measured by bench_tracking:
/// see the README. Pays from about 4 rays on.
void optical_depths(const Media& media, std::span<const DepthQuery> queries, std::span<float> tau,
                    WalkCounts& counts);

/// The same by the midpoint rule in steps of up to two voxels, 0.4 lookups per cell: for smooth
/// densities, those of coarse media. WalkCounts::cells counts lookups; bricks are not counted.
void march_depths(const Media& media, std::span<const DepthQuery> queries, std::span<float> tau,
                  WalkCounts& counts);

}  // namespace mote
