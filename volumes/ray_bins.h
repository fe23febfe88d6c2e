#pragma once

#include <span>

#include "volumes/tracking.h"

namespace mote {

/// Optical depth of all media along one ray, tabulated at the edges of bins and exact there: edges
/// lie on cell borders, and what lies between is integrated in closed form when asked for. From one
/// walk come exact free flights, exact transmittances and a place for whatever else is known at
/// the edges. Bins tile the ray from the first medium to the last; a gap is a bin of depth 0.
///
/// Distances s are metres from t0, in float: t0 may be far away.
struct RayBins {
    /// More than this many bins are never made: they hold more cells instead.
    static constexpr int capacity = 62;

    int count = 0;
    int cells = 0;            ///< walked to fill them
    double t0 = 0.0;          ///< world distance of s = 0 [m]
    float s[capacity + 1];    ///< edges: bin k runs from s[k] to s[k + 1]
    float tau[capacity + 1];  ///< optical depth from the ray's origin to each edge, all media

    [[nodiscard]] bool empty() const { return count == 0; }
    /// Optical depth of the whole ray.
    [[nodiscard]] float depth() const { return count > 0 ? tau[count] : 0.0f; }
    [[nodiscard]] float depth_of_bin(int k) const { return tau[k + 1] - tau[k]; }
    [[nodiscard]] float world_t(float at) const
    {
        return static_cast<float>(t0 + static_cast<double>(at));
    }
};

/// Counts of a walk, for statistics.
struct BinCounts {
    int64_t rays = 0;            ///< times media whose bounds they meet
    int64_t misses = 0;          ///< rays that meet no bounds: nothing is walked
    int64_t uniform_bricks = 0;  ///< bricks of one value, crossed in closed form without cells
    int64_t cells = 0;           ///< walked in all other bricks
    int64_t bins = 0;
};

/// Fills `bins` for a camera ray. A bin holds up to 4 cells (more on long rays) and is closed
/// earlier where transmittance has dropped by 4 %, or at a gap. The walk ends where transmittance
/// is below `cut` (0: nowhere): what lies behind counts as not there, so choose it by what a light
/// there could still contribute; and at t_end [m], where something ends the ray. Several media:
/// edges from all of them. Cost: every cell on the ray; about twice that if media overlap.
void make_ray_bins(const Media& media, const Ray& ray, float cut, RayBins& bins, BinCounts& counts,
                   float t_end = infinity);

/// A camera ray whose bins are asked for, and where something ends it.
struct BinQuery {
    const Ray* ray;
    float t_end;  ///< [m]
    RayBins* bins;
};

/// The same for many rays. Through one medium they are walked side by side in the vector unit,
/// with the same bits whatever instruction set it has and whatever rays are asked for besides;
/// edges and depths differ from those of one ray alone by rounding. Cost: 0.7 of
/// one by one for 8 rays that run side by side, 0.6 for 64 (bench_tracking).
void make_ray_bins(const Media& media, std::span<const BinQuery> queries, float cut,
                   BinCounts& counts);

/// Where in bin k the optical depth counted from its near edge reaches `tau`, by closed-form
/// integrals: distance s. Clamped to the bin. Exact up to float rounding.
[[nodiscard]] float invert_bin(const Media& media, const Ray& ray, const RayBins& bins, int k,
                               float tau);

/// The distance s at which the optical depth from the ray's origin reaches `tau`; clamped to the
/// bins. Precondition: not empty.
[[nodiscard]] float distance_at(const Media& media, const Ray& ray, const RayBins& bins, float tau);

/// Optical depth from the ray's origin to distance s; exact, a walk over part of one bin.
[[nodiscard]] float depth_to(const Media& media, const Ray& ray, const RayBins& bins, float s);

/// The bin that holds distance s: the last one whose near edge is not beyond it, clamped.
[[nodiscard]] int bin_of(const RayBins& bins, float s);

}  // namespace mote
