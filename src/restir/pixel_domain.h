#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "restir/frame_domain.h"
#include "volumes/ray_bins.h"

namespace mote {

/// Where a pixel's samples live in one pass: its camera ray, the exact optical depths along it, and
/// the distribution of scattering distances. With Z = cdf[count], a random number u stands for the
/// distance s at which a share u of Z has passed: bins in proportion to their expected in-scattered
/// light, inside a bin in proportion to sigma_t T, both exact. So the density of s is
///     sigma_t(s) T(s) S_k / Z,   S_k = (cdf[k+1] - cdf[k]) / (T_k - T_{k+1}),
/// and sigma_t and T cancel out of every contribution (findings of the prototype: no mismatch is
/// left to make noise, and no Jacobian when numbers are copied to another pixel).
struct PixelDomain {
    Ray ray;
    RayBins bins;
    float cdf[RayBins::capacity + 1];   ///< cumulative weights at the edges; cdf[0] = 0
    std::optional<SurfaceHit> surface;  ///< what ends the ray, smoke in front of it or not

    [[nodiscard]] Vec3 wo() const { return -ray.d; }
    [[nodiscard]] float t_end() const { return surface ? surface->t : infinity; }
    /// Sum of all weights; 0: the pixel's reservoir stays empty.
    [[nodiscard]] float Z() const { return bins.empty() ? 0.0f : cdf[bins.count]; }
};

/// Surface and bins of the ray, without weights.
void make_pixel_domain(const FrameDomain& frame, const Ray& ray, PixelDomain& domain,
                       BinCounts& counts);

/// The same of many rays, which are set, side by side (see make_ray_bins).
void make_pixel_domains(const FrameDomain& frame, std::span<PixelDomain> domains,
                        BinCounts& counts);

/// Calls f(i, domain) for `count` rays ray_of(i), in order; the domains of neighbours are made side
/// by side in `scratch`.
template <class RayOf, class OnDomain>
void for_each_domain(const FrameDomain& frame, size_t count, RayOf&& ray_of,
                     std::vector<PixelDomain>& scratch, BinCounts& counts, OnDomain&& f)
{
    constexpr size_t at_once = 64;  // they fit the cache
    scratch.resize(std::max(scratch.size(), std::min(at_once, count)));
    for (size_t begin = 0; begin < count; begin += at_once) {
        const std::span<PixelDomain> domains =
            std::span(scratch).first(std::min(at_once, count - begin));
        for (size_t i = 0; i < domains.size(); ++i) domains[i].ray = ray_of(begin + i);
        make_pixel_domains(frame, domains, counts);
        for (size_t i = 0; i < domains.size(); ++i) f(begin + i, domains[i]);
    }
}

/// Fills cdf from the expected in-scattered light at the bins' edges. Every bin with depth gets
/// some, whatever the caches say: a share of the ray's mean.
void weigh_bins(const FrameDomain& frame, PixelDomain& domain);

/// The same from any light in-scattered at the edges. `least`: the share.
void weigh_bins_by(std::span<const float> inscatter, float least, PixelDomain& domain);

/// A scattering event on the ray.
struct RayPoint {
    Vec3 x{0.0f};    ///< [m]
    float s = 0.0f;  ///< distance from bins.t0 [m]
    int bin = 0;
    float weight = 0.0f;  ///< sigma_t T over the density of u -> s; 0: no such event
};

/// The event that u in [0,1) stands for.
[[nodiscard]] RayPoint point_at(const FrameDomain& frame, const PixelDomain& domain, float u);

/// The inverse: which u stands for distance s, and d(u)/d(s) [1/m] there. Empty where nothing
/// scatters, which no u stands for.
struct RayNumber {
    float u = 0.0f;
    float density = 0.0f;
};
[[nodiscard]] std::optional<RayNumber> number_at(const FrameDomain& frame,
                                                 const PixelDomain& domain, float s);

/// Integral over an optical depth D of exp(-tau) times a function that runs linearly in tau from a
/// to b, as the weights (x, y) of a and b: x = sum of (-D)^m / (m+1)!, y = 1 - exp(-D) - x.
[[nodiscard]] inline Vec2 linear_weights(float D)
{
    if (D < 0.1f) {  // series: the closed form cancels
        const float a =
            D * (0.5f - D * (1.0f / 6 - D * (1.0f / 24 - D * (1.0f / 120 - D / 720.0f))));
        const float b = D * (0.5f - D * (1.0f / 3 - D * (1.0f / 8 - D * (1.0f / 30 - D / 144.0f))));
        return {a, b};
    }
    const float lost = -std::expm1(-D);
    const float b = (lost - D * std::exp(-D)) / D;
    return {lost - b, b};
}

}  // namespace mote
