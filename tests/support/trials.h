#pragma once

#include <cstdint>

#include "core/rng.h"
#include "core/stats.h"

namespace mote::test {

/// Runs f(rng) `count` times, each with its own stream, and collects the results.
/// Tests compare |mean - exact| with a multiple of the standard error; they use fixed seeds, so
/// they are deterministic, and state the false-alarm rate over seeds: 4 standard errors fail
/// falsely once in 16,000 seeds, 5 once in 1.7 million.
template <class F>
RunningStats run_trials(uint32_t count, uint32_t seed, F&& f)
{
    RunningStats stats;
    for (uint32_t i = 0; i < count; ++i) {
        Rng rng(seed, 0, Stream::Test, i, 0);
        stats.add(static_cast<double>(f(rng)));
    }
    return stats;
}

}  // namespace mote::test
