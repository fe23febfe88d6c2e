#include "core/distribution.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace mote {

AliasTable::AliasTable(std::span<const float> weights)
{
    for (const float weight : weights) {
        MOTE_ASSERT(std::isfinite(weight) && weight >= 0.0f);
        sum_ += static_cast<double>(weight);
    }
    if (!(sum_ > 0.0)) return;

    const size_t count = weights.size();
    pmf_.resize(count);
    threshold_.assign(count, 1.0f);
    alias_.resize(count);
    std::vector<double> share(count);  // of a column; the mean is 1
    std::vector<uint32_t> small;
    std::vector<uint32_t> large;
    uint32_t largest = 0;
    for (uint32_t i = 0; i < count; ++i) {
        pmf_[i] = static_cast<float>(static_cast<double>(weights[i]) / sum_);
        share[i] = static_cast<double>(weights[i]) / sum_ * static_cast<double>(count);
        alias_[i] = i;
        (share[i] < 1.0 ? small : large).push_back(i);
        if (weights[i] > weights[largest]) largest = i;
    }
    while (!small.empty() && !large.empty()) {
        const uint32_t i = small.back();
        const uint32_t donor = large.back();
        small.pop_back();
        threshold_[i] = static_cast<float>(share[i]);
        alias_[i] = donor;
        share[donor] -= 1.0 - share[i];
        if (share[donor] < 1.0) {
            large.pop_back();
            small.push_back(donor);
        }
    }
    // What is left has share 1 up to rounding, but an entry of weight 0 must stay impossible.
    for (const uint32_t i : small) {
        if (weights[i] > 0.0f) continue;
        threshold_[i] = 0.0f;
        alias_[i] = largest;
    }
}

AliasTable::Sample AliasTable::sample(double u) const
{
    MOTE_ASSERT(!is_empty());
    const double scaled = u * static_cast<double>(pmf_.size());
    const size_t column = std::min(static_cast<size_t>(scaled), pmf_.size() - 1);
    const double rest = scaled - static_cast<double>(column);
    const size_t index =
        rest < static_cast<double>(threshold_[column]) ? column : size_t{alias_[column]};
    return {index, pmf_[index]};
}

}  // namespace mote
