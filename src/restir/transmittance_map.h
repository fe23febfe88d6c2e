#pragma once

#include <vector>

#include "restir/cache_stats.h"
#include "volumes/tracking.h"

namespace mote {

struct TransmittanceMapParams {
    /// Distance between rays and between stored depths [m]; 0: twice the finest voxel. The error of
    /// exp(-depth) grows, the cost falls, with about its square.
    float spacing = 0.0f;
    int64_t node_budget = 8'000'000;  ///< [8, ..]; 4 bytes each. The spacing grows to fit.
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
    /// nothing is in the way.
    TransmittanceMap(const Media& media, Vec3 wi, const TransmittanceMapParams& params = {});

    /// From world point x towards the light, finite, >= 0. Exactly 0 on the light's side of all
    /// media and beside them; the full depth behind them. Depths end at about max_depth.
    [[nodiscard]] float optical_depth(Vec3 x) const
    {
        // Not-a-number becomes 0 here.
        const Vec3 p = lattice_from_world_.point(x - centre_);
        const float u = std::min(std::max(0.0f, p.x), last_.x);
        const float v = std::min(std::max(0.0f, p.y), last_.y);
        const float z = std::min(std::max(0.0f, p.z), last_.z);
        const int i = std::min(static_cast<int>(u), last_cell_.x);
        const int j = std::min(static_cast<int>(v), last_cell_.y);
        const int k = std::min(static_cast<int>(z), last_cell_.z);
        const float* row = depths_.data() + static_cast<size_t>(j) * line_ +
                           static_cast<size_t>(i) * planes_ + static_cast<size_t>(k);
        const float fu = u - static_cast<float>(i);
        const float fv = v - static_cast<float>(j);
        const float fz = z - static_cast<float>(k);
        const auto along = [&](const float* r) { return r[0] + fz * (r[1] - r[0]); };
        const float a = along(row);
        const float b = along(row + line_);
        const float low = a + fu * (along(row + planes_) - a);
        const float high = b + fu * (along(row + line_ + planes_) - b);
        return low + fv * (high - low);
    }

    /// exp(-optical_depth(x)), [0,1].
    [[nodiscard]] float transmittance(Vec3 x) const { return std::exp(-optical_depth(x)); }

    /// Distance between rays [m]: what was asked for, or more to stay within the budget.
    [[nodiscard]] float spacing() const { return spacing_; }
    [[nodiscard]] const CacheStats& stats() const { return stats_; }

    /// Walks stop at this optical depth per volume: exp(-40) is nothing.
    static constexpr float max_depth = 40.0f;

  private:
    void clear();

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
