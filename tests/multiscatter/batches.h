#pragma once

#include <functional>

#include "core/rng.h"
#include "verify/statistics.h"

namespace mote::test {

/// How many independent samples a mean is made of: a batch's mean is one observation.
struct Batches {
    int count = 32;
    int samples = 600;
};

/// Luminance of f(rng) over independent samples.
inline MeanEstimate mean_of(const Batches& batches, uint32_t seed,
                            const std::function<Spectrum(Rng&)>& f)
{
    RunningStats stats;
    for (int b = 0; b < batches.count; ++b) {
        double sum = 0.0;
        for (int i = 0; i < batches.samples; ++i) {
            Rng rng(seed, static_cast<uint32_t>(b), Stream::Test, static_cast<uint32_t>(i), 0);
            sum += static_cast<double>(luminance(f(rng)));
        }
        stats.add(sum / batches.samples);
    }
    return estimate_mean(stats);
}

}  // namespace mote::test
