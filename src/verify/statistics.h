#pragma once

#include "core/stats.h"

namespace mote {

/// A mean and how well it is known. The observations are independent runs: pixels and frames
/// within one run are correlated, so a run's image, or one tile of it, is one observation.
struct MeanEstimate {
    double mean = 0.0;
    double variance = 0.0;  ///< of the mean, s^2/K; infinite: unknown (fewer than 2 runs)
    double freedom = 0.0;   ///< degrees of freedom of `variance`; infinite: variance is exact

    [[nodiscard]] double standard_error() const { return std::sqrt(variance); }
};

/// Range that holds the true value with a stated confidence. Infinite ends where the data cannot
/// bound it.
struct ConfidenceInterval {
    double lower = 0.0;
    double upper = 0.0;

    [[nodiscard]] bool contains(double x) const { return lower <= x && x <= upper; }
};

/// What one two-sided test found.
struct TestResult {
    MeanEstimate difference;
    double t = 0.0;  ///< difference over its standard error; +-infinite if that is 0
    double p = 1.0;  ///< chance of such a |t| without bias; 1 for fewer than 2 runs
};

[[nodiscard]] MeanEstimate estimate_mean(const RunningStats& runs);

/// weight_a * a + weight_b * b for independent a and b; the degrees of freedom by Satterthwaite.
[[nodiscard]] MeanEstimate combine(const MeanEstimate& a, double weight_a, const MeanEstimate& b,
                                   double weight_b);

/// Student's test of "|true difference| <= tolerance". With tolerance 0 the usual two-sided test;
/// a tolerance for rounding makes p conservative and decides pixels without any variance, which
/// differ (p = 0) or not (p = 1).
[[nodiscard]] TestResult test_zero(const MeanEstimate& difference, double tolerance = 0.0);

/// Welch's t-test of equal means, variances unequal. Needs 2 runs on each side, else p = 1.
/// Source: Welch 1947; for renderers: Jung, Hanika and Dachsbacher 2020.
[[nodiscard]] TestResult welch_test(const MeanEstimate& a, const MeanEstimate& b,
                                    double tolerance = 0.0);

/// p-value of "|true difference| >= budget", by two one-sided t-tests: small means that the bias is
/// shown to be inside the budget. Too few runs give a large p and so never pass. Budget > 0.
/// Source: Schuirmann 1987.
[[nodiscard]] double equivalence_p(const MeanEstimate& difference, double budget);

/// p-value of "|a/b - 1| >= budget" for independent a and b, budget in (0,1): small means that the
/// relative bias of a is shown to be inside the budget. Exact in b's uncertainty, for b > 0.
[[nodiscard]] double ratio_equivalence_p(const MeanEstimate& a, const MeanEstimate& b,
                                         double budget);

/// Two-sided interval of a mean, confidence in (0,1).
[[nodiscard]] ConfidenceInterval confidence_interval(const MeanEstimate& mean, double confidence);

/// Two-sided interval of the ratio a/b of independent means, confidence in (0,1). Both ends are
/// infinite unless b differs from 0 at that confidence. Source: Fieller 1954, with Satterthwaite's
/// degrees of freedom at the ratio of the means.
[[nodiscard]] ConfidenceInterval ratio_interval(const MeanEstimate& a, const MeanEstimate& b,
                                                double confidence);

/// Bias that a two-sided t-test at `significance` finds with probability `power`, both in (0,1),
/// in units of the difference. Infinite for fewer than 2 runs. By the noncentral t distribution.
[[nodiscard]] double smallest_detectable_bias(const MeanEstimate& difference, double significance,
                                              double power);

}  // namespace mote
