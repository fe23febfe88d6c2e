#pragma once

#include <algorithm>
#include <cmath>

#include "volumes/ray_bins.h"

namespace mote {

/// An exact free flight on a binned ray, given that there is a collision.
struct RayFlight {
    int bin = 0;
    float lambda = 0.0f;  ///< share of the bin's optical depth before it
    Vec3 x{0.0f};         ///< world [m]
};

/// The flight that u in [0,1) stands for: a share u of the light that collides does so before it.
/// Precondition: the bins are not empty. Cost: closed form in one bin.
[[nodiscard]] inline RayFlight flight_at(const Media& media, const Ray& ray, const RayBins& bins,
                                         float u)
{
    const float lost = -std::expm1(-bins.depth());
    const float tau = std::min(-std::log1p(-u * lost), bins.depth());
    const auto above = std::upper_bound(bins.tau + 1, bins.tau + bins.count, tau) - bins.tau;
    RayFlight flight;
    flight.bin = static_cast<int>(above) - 1;
    const float depth = bins.depth_of_bin(flight.bin);
    const float within = tau - bins.tau[flight.bin];
    flight.lambda = depth > 0.0f ? std::clamp(within / depth, 0.0f, 1.0f) : 0.0f;
    flight.x = ray.at(bins.world_t(invert_bin(media, ray, bins, flight.bin, within)));
    return flight;
}

}  // namespace mote
