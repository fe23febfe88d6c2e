#pragma once

#include <optional>
#include <vector>

#include "volumes/brick_walk.h"

namespace mote {

/// Cumulative optical depth of one volume along one ray, exact at brick borders: draws any number
/// of free flights from the ray, with their density, at the price of one walk.
/// Keeps a pointer to the grid. Cost to build: every cell on the ray; 32 bytes per brick.
class RayTable {
  public:
    RayTable(const Volume& volume, const Ray& ray, Interval range);

    /// Optical depth of the whole range.
    [[nodiscard]] double depth() const { return depth_; }

    /// Optical depth from the start of the range to world distance t. Exact.
    [[nodiscard]] double depth_to(float t) const;

    /// World distance at which depth_to reaches `tau`; empty if it never does.
    [[nodiscard]] std::optional<float> distance_at(double tau) const;

    /// Free flight from one random number, u in [0,1); empty if it leaves the range.
    [[nodiscard]] std::optional<float> sample(float u) const;

    /// Free flight given that there is a collision in the range, u in [0,1); empty in a vacuum.
    [[nodiscard]] std::optional<float> sample_collision(float u) const;

    /// Density of sample() [1/m]: sigma_t(t) T(t). That of sample_collision() is this over
    /// 1 - exp(-depth()).
    [[nodiscard]] float pdf(float t) const;

  private:
    struct Entry {
        BrickSpan span;
        double end = 0.0;  ///< optical depth at the end of the span
    };

    const BrickGrid* grid_ = nullptr;
    LocalRay ray_;
    double scale_ = 0.0;
    double depth_ = 0.0;
    std::vector<Entry> entries_;
};

}  // namespace mote
