#pragma once

#include "study/verify_runs.h"

namespace mote {

/// Time of a run, the second of two, and the images of both.
struct ShortRuns {
    LayeredImage images[2];
    double seconds = 0.0;
    double variance = 0.0;  ///< of a pixel, without the worst ones (trimmed_share)
};

[[nodiscard]] ShortRuns short_runs(const RunSource& source, uint32_t seed);

/// Short runs of one estimator, and of its frames without events.
struct Pilots {
    const Method& method;
    int samples;
    uint32_t seed;
    ShortRuns runs;
    ShortRuns straight;

    /// Runs of `n` samples from seed `s` on.
    Pilots(VerifySetup& setup, const Method& m, int n, uint32_t s);
    /// Of a pixel of a run without these parts, but for the share of the pixels where it is
    /// largest.
    [[nodiscard]] double rest_variance(const std::vector<std::string>& parts) const;
    /// Of a pixel of one pass without events.
    [[nodiscard]] double straight_variance(const std::vector<std::string>& parts) const;
};

/// Leaves out the layers in which nothing is seen.
void choose_parts(VerifySetup& setup, std::initializer_list<const ShortRuns*> all_runs);

/// Takes straight light from passes of its own where it makes most of the tested runs' noise, and
/// chooses the reference's samples for the rest; returns those.
[[nodiscard]] int share_out(VerifySetup& setup, Pilots& tested, Pilots& reference);

}  // namespace mote
