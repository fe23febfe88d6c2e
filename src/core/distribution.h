#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/rng.h"

namespace mote {

/// Uniform in [0,1) with 53 random bits, for choices among many or very unequal weights.
[[nodiscard]] inline double uniform_double(Rng& rng)
{
    const uint64_t high = rng.next();
    return static_cast<double>((high << 32u | rng.next()) >> 11u) * 0x1p-53;
}

/// Draws an index in proportion to its weight, in constant time. Entries of weight 0 are never
/// drawn. Source: Walker 1977; construction by Vose 1991.
class AliasTable {
  public:
    AliasTable() = default;
    /// Weights must be finite and >= 0 (asserted); if all are 0 the table is empty.
    explicit AliasTable(std::span<const float> weights);

    struct Sample {
        size_t index = 0;
        float pmf = 0.0f;
    };
    /// u in [0,1) with many bits: a float's 24 would be used up by the index alone. Asserts that
    /// the table is not empty.
    [[nodiscard]] Sample sample(double u) const;

    /// Probability of `index`; 0 in an empty table.
    [[nodiscard]] float pmf(size_t index) const { return pmf_.empty() ? 0.0f : pmf_[index]; }
    [[nodiscard]] bool is_empty() const { return pmf_.empty(); }
    [[nodiscard]] size_t size() const { return pmf_.size(); }
    /// Sum of the weights.
    [[nodiscard]] double sum() const { return sum_; }

  private:
    std::vector<float> pmf_;
    std::vector<float> threshold_;  ///< share of a column that keeps its own index
    std::vector<uint32_t> alias_;
    double sum_ = 0.0;
};

}  // namespace mote
