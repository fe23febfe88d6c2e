#pragma once

#include <cstdint>
#include <limits>

namespace mote {

/// Work of the trackers, counted by each thread for itself: a frame's is the sum of what its tiles
/// add. Random numbers decide it, not the machine: a cost without the noise of clocks.
struct TrackingCounts {
    int64_t free_flights = 0;   ///< media tried for a collision
    int64_t shadow_rays = 0;    ///< media whose transmittance was estimated or integrated
    int64_t surface_rays = 0;   ///< shadow rays asked of surfaces, by whoever traces them
    int64_t lookups = 0;        ///< density at tentative collisions
    int64_t closed_bricks = 0;  ///< bricks that took part in closed form
    /// Densities above their majorant: such a free flight or transmittance is wrong. Must be 0.
    int64_t majorant_violations = 0;

    void add(const TrackingCounts& other)
    {
        free_flights += other.free_flights;
        shadow_rays += other.shadow_rays;
        surface_rays += other.surface_rays;
        lookups += other.lookups;
        closed_bricks += other.closed_bricks;
        majorant_violations += other.majorant_violations;
    }
    /// What was counted since `start`, an earlier copy of the same thread's counts.
    [[nodiscard]] TrackingCounts since(const TrackingCounts& start) const
    {
        return {
            free_flights - start.free_flights,   shadow_rays - start.shadow_rays,
            surface_rays - start.surface_rays,   lookups - start.lookups,
            closed_bricks - start.closed_bricks, majorant_violations - start.majorant_violations};
    }
};

/// Of this thread, since it began. The model spares code that may become part of a library a call
/// at each use; libraries loaded later, which it rules out, do no tracking.
[[gnu::tls_model("initial-exec")]] inline thread_local constinit TrackingCounts tracking_counts;

/// Whether a density is above what was said to bound it by more than the rounding of an
/// interpolation: three steps of two roundings each.
[[nodiscard]] constexpr bool violates(float density, float bound)
{
    return density > bound * (1.0f + 0x1p-20f) + std::numeric_limits<float>::min();
}

}  // namespace mote
