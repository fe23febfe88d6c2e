#pragma once

#include <algorithm>
#include <cmath>

#include "volumes/local_ray.h"
#include "volumes/ray_bins.h"

namespace mote {

/// Makes the bins of one ray through one medium from what a walk along it comes by, nearest first.
class BinFiller {
  public:
    /// `ray`: in the medium's density grid; must not miss it. `cut`: see make_ray_bins.
    BinFiller(const Volume& volume, const LocalRay& ray, float cut, RayBins& bins)
        : bins_(&bins),
          scale_(volume.density_scale),
          depth_cut_(cut > 0.0f ? -std::log(cut) : infinity)
    {
        bins.count = 0;
        bins.t0 = ray.t0;
        const Vec3 speed = glm::abs(ray.d);
        const float crossings = ray.s1 * (speed.x + speed.y + speed.z);
        tolerance_ = gap / std::max({speed.x, speed.y, speed.z});
        cells_max_ =
            std::max(cells_per_bin, static_cast<int>(crossings / (RayBins::capacity - 16)) + 1);
    }

    /// A stretch of one density; false when nothing more matters.
    bool add_uniform(float s0, float s1, float density)
    {
        ++uniform_bricks_;
        if (!(density > 0.0f)) return true;
        open_at(s0);
        const float sigma_t = scale_ * density;
        const float whole = (s1 - s0) * sigma_t;
        // Equal steps in transmittance, as far as the light gets.
        const float start = tau_;
        while (!is_full() && limit_ < start + whole) {
            tau_ = limit_;
            close(s0 + (tau_ - start) / sigma_t);
        }
        tau_ = start + whole;
        end_ = std::max(end_, s1);
        cells_in_bin_ += 2;
        if (cells_in_bin_ >= cells_max_ && !is_full()) close(end_);
        return !is_over();
    }

    /// A cell and the integral of its density; false when nothing more matters.
    bool add_cell(float s0, float s1, float integral)
    {
        ++bins_->cells;
        const float step = scale_ * integral;
        if (!(step > 0.0f)) return true;
        open_at(s0);
        tau_ += step;
        if (!(s1 > end_)) return !is_over();  // rounding: no place for an edge
        end_ = s1;
        ++cells_in_bin_;
        if ((cells_in_bin_ >= cells_max_ || tau_ > limit_) && !is_full()) close(end_);
        return !is_over();
    }

    /// Whether nothing more matters.
    [[nodiscard]] bool is_over() const { return !(tau_ < depth_cut_); }

    /// Closes the last bin.
    void finish(BinCounts& counts)
    {
        if (started_ && cells_in_bin_ > 0) close(end_);
        counts.cells += bins_->cells;
        counts.uniform_bricks += uniform_bricks_;
        ++counts.rays;
        counts.bins += bins_->count;
    }

  private:
    /// A bin is closed when transmittance has dropped by this much since its near edge.
    static constexpr float transmittance_step = 0.04f;
    /// Cells per bin, unless the ray is so long that the bins would run out.
    static constexpr int cells_per_bin = 4;
    /// Edges closer than this share of a cell's size are one edge: rounding, not gaps.
    static constexpr float gap = 1e-4f;

    /// The last slot stays free for the far end.
    [[nodiscard]] bool is_full() const { return bins_->count >= RayBins::capacity - 1; }

    /// A stretch that holds something; what lies before it is a gap if it does not join on.
    void open_at(float s)
    {
        if (!started_) {
            started_ = true;
            bins_->s[0] = s;
            bins_->tau[0] = 0.0f;
        } else if (s > end_ + tolerance_ && !is_full()) {
            if (cells_in_bin_ > 0) close(end_);
            if (!is_full()) close(s);
        }
    }

    /// Closes the open bin at distance s.
    void close(float s)
    {
        ++bins_->count;
        bins_->s[bins_->count] = s;
        bins_->tau[bins_->count] = tau_;
        cells_in_bin_ = 0;
        // Nothing is gained from thin bins where hardly any light gets to.
        limit_ = tau_ < 7.0f ? tau_ + transmittance_step * std::exp(tau_) : infinity;
    }

    RayBins* bins_;
    float scale_;
    float depth_cut_;
    float tolerance_ = 0.0f;
    int cells_max_ = 0;
    int cells_in_bin_ = 0;
    int64_t uniform_bricks_ = 0;
    float limit_ = transmittance_step;  ///< depth at which the open bin is closed
    float tau_ = 0.0f;
    float end_ = 0.0f;  ///< of the last stretch that was added
    bool started_ = false;
};

}  // namespace mote
