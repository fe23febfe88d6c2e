#pragma once

#include <vector>

#include "restir/cache_stats.h"
#include "surfaces/surfaces.h"
#include "volumes/tracking.h"

namespace mote {

struct TransmittanceMapParams {
    /// Distance between rays and between stored depths [m]; 0: twice the finest voxel. The error of
    /// exp(-depth) grows, the cost falls, with about its square.
    float spacing = 0.0f;
    int64_t node_budget = 8'000'000;  ///< 4 bytes each. The spacing grows to fit.
    /// A ray's walk through a volume ends when the depth exceeds this: exp(-40) is nothing.
    /// Infinite for depth_behind().
    float max_depth = 40.0f;
};

/// Optical depth from anywhere towards one direction, through all media together: a light at
/// infinity seen from every point. Parallel rays on a lattice sheared along the direction, walked
/// exactly from the light's side; depths are stored on planes and interpolated between.
///
/// The answer is approximate (stored depths are exact, between them linear; moving media stand
/// still at cache_time): fit for targets, proposals and control variates, never for what is shaded.
/// A transmittance used inside a target must be floored (1e-3, say) by its user: where the map says
/// 0 and the truth is not, a target of 0 would lose the sample.
///
/// Cost: one walk of the cells along each ray to build, about 10 ns per lookup. The result depends
/// on media, direction and parameters alone, so whoever holds it may keep it while these stay
/// (media_key.h), for any thread count. Stored in the manner of deep shadow maps, Lokovic and Veach
/// 2000.
class TransmittanceMap {
  public:
    /// Nothing in the way anywhere.
    TransmittanceMap() { clear(); }

    /// `wi` points towards the light [unit]. Without media, or for a wi that is no direction,
    /// nothing is in the way. Behind surfaces (null: none) it is dark: one ray more per ray of the
    /// lattice. depth_behind() knows nothing of them.
    TransmittanceMap(const Media& media, Vec3 wi, const TransmittanceMapParams& params = {},
                     const Surfaces* surfaces = nullptr);

    /// From world point x towards the light, finite, >= 0. Exactly 0 on the light's side of all
    /// media and beside them; the full depth behind them.
    [[nodiscard]] float optical_depth(Vec3 x) const
    {
        const Place p = place(x);
        const auto along = [&](const float* row) {
            return row[p.plane] + p.f.z * (row[p.plane + 1] - row[p.plane]);
        };
        return across(p, along);
    }

    /// From x away from the light: the rest of the ray. Needs max_depth = infinity. Depths of
    /// millions lose their digits and count as opaque.
    [[nodiscard]] float depth_behind(Vec3 x) const
    {
        const Place p = place(x);
        const auto rest = [&](const float* row) {
            const float depth = row[p.plane] + p.f.z * (row[p.plane + 1] - row[p.plane]);
            const float total = row[planes_ - 1];
            return std::max(0.0f, total - depth) + 2e-7f * total;
        };
        return across(p, rest);
    }

    /// exp(-optical_depth(x)), [0,1].
    [[nodiscard]] float transmittance(Vec3 x) const { return std::exp(-optical_depth(x)); }

    /// Distance between rays [m]: what was asked for, or more to stay within the budget.
    [[nodiscard]] float spacing() const { return spacing_; }
    [[nodiscard]] const CacheStats& stats() const { return stats_; }

  private:
    /// A point in the lattice.
    struct Place {
        const float* row;  ///< depths of the first of the four rays around it
        size_t plane;      ///< the plane before it
        Vec3 f;            ///< position between rays and planes, [0,1]
    };

    void clear();

    [[nodiscard]] Place place(Vec3 x) const
    {
        // Not-a-number becomes 0 here.
        const Vec3 p = lattice_from_world_.point(x - centre_);
        const float u = std::min(std::max(0.0f, p.x), last_.x);
        const float v = std::min(std::max(0.0f, p.y), last_.y);
        const float z = std::min(std::max(0.0f, p.z), last_.z);
        const int i = std::min(static_cast<int>(u), last_cell_.x);
        const int j = std::min(static_cast<int>(v), last_cell_.y);
        const int k = std::min(static_cast<int>(z), last_cell_.z);
        return {depths_.data() + static_cast<size_t>(j) * line_ + static_cast<size_t>(i) * planes_,
                static_cast<size_t>(k),
                {u - static_cast<float>(i), v - static_cast<float>(j), z - static_cast<float>(k)}};
    }

    /// Bilinear between the four rays around a place.
    template <class OnRay>
    [[nodiscard]] float across(const Place& p, OnRay&& on_ray) const
    {
        const float a = on_ray(p.row);
        const float b = on_ray(p.row + line_);
        const float low = a + p.f.x * (on_ray(p.row + planes_) - a);
        const float high = b + p.f.x * (on_ray(p.row + line_ + planes_) - b);
        return low + p.f.y * (high - low);
    }

    Affine lattice_from_world_{Mat3(0.0f), Vec3(0.0f)};  ///< of x - centre_: ray, ray, plane
    Vec3 centre_{0.0f};
    Vec3 last_{1.0f};
    Vec3i last_cell_{0};
    size_t planes_ = 2;          ///< depths per ray
    size_t line_ = 4;            ///< depths per line of rays
    std::vector<float> depths_;  ///< plane fastest, nearest to the light first
    float spacing_ = 0.0f;
    CacheStats stats_;
};

}  // namespace mote
