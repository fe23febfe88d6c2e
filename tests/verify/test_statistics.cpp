#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/math.h"
#include "core/rng.h"
#include "verify/statistics.h"

namespace mote {

namespace {

MeanEstimate estimate(const std::vector<double>& values)
{
    RunningStats stats;
    for (const double value : values) stats.add(value);
    return estimate_mean(stats);
}

// Extra hours of sleep of ten patients each under two drugs, from Student 1908: the standard
// example of Welch's test. All expected values below were computed with 30 digits.
MeanEstimate first_drug()
{
    return estimate({0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0});
}

MeanEstimate second_drug()
{
    return estimate({1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4});
}

/// Two means of 20 and 30 runs.
const MeanEstimate tested{10.2, 4.0 / 20.0, 19.0};
const MeanEstimate reference{9.0, 9.0 / 30.0, 29.0};

}  // namespace

TEST(Statistics, WelchTestOfStudentsSleepData)
{
    const TestResult test = welch_test(first_drug(), second_drug());
    EXPECT_NEAR(test.t, -1.8608134674868531, 1e-12);
    EXPECT_NEAR(test.difference.freedom, 17.77647351617849, 1e-11);
    EXPECT_NEAR(test.p, 0.079394140187358138, 1e-12);
}

TEST(Statistics, WelchTestFromMomentsOfUnequalSets)
{
    const TestResult test = welch_test(tested, reference);
    EXPECT_NEAR(test.t, 1.6970562748477141, 1e-12);
    EXPECT_NEAR(test.difference.freedom, 47.996515679442509, 1e-11);
    EXPECT_NEAR(test.p, 0.096162640809920105, 1e-12);
}

TEST(Statistics, FewerThanTwoRunsDecideNothing)
{
    const MeanEstimate one_run = estimate({1.0});
    const MeanEstimate many_runs = estimate({5.0, 5.1, 4.9});
    EXPECT_EQ(welch_test(one_run, many_runs).p, 1.0);
    EXPECT_EQ(ratio_equivalence_p(one_run, many_runs, 0.5), 1.0);
    EXPECT_EQ(equivalence_p(one_run, 100.0), 1.0);
    EXPECT_EQ(confidence_interval(one_run, 0.95).upper, infinity);
    EXPECT_EQ(ratio_interval(many_runs, one_run, 0.95).lower, -infinity);
    EXPECT_EQ(smallest_detectable_bias(one_run, 0.05, 0.9), infinity);
    EXPECT_EQ(estimate({}).variance, infinity);
}

TEST(Statistics, WithoutVarianceTheDifferenceDecides)
{
    const MeanEstimate one = estimate({1.0, 1.0});
    const MeanEstimate nearly_one = estimate({1.0 + 1e-7, 1.0 + 1e-7});
    EXPECT_EQ(welch_test(one, one).p, 1.0);
    EXPECT_EQ(welch_test(nearly_one, one).p, 0.0);
    EXPECT_EQ(welch_test(nearly_one, one).t, infinity);
    EXPECT_EQ(welch_test(nearly_one, one, 1e-6).p, 1.0);
    EXPECT_EQ(ratio_equivalence_p(nearly_one, one, 0.01), 0.0);
    EXPECT_EQ(equivalence_p({0.01, 0.0, 2.0}, 0.01), 1.0);  // on the border is not inside
}

TEST(Statistics, DarkPixelsDoNotUnderflow)
{
    // Squares of these variances are below the smallest double.
    const MeanEstimate a{1e-100, 1e-204, 19.0};
    const MeanEstimate b{2e-100, 1e-204, 19.0};
    const TestResult test = welch_test(a, b);
    EXPECT_NEAR(test.difference.freedom, 38.0, 1e-9);
    EXPECT_NEAR(test.t, -100.0 / std::sqrt(2.0), 1e-9);
}

TEST(Statistics, EquivalenceNeedsTheIntervalInsideTheBudget)
{
    const MeanEstimate difference = combine(first_drug(), 1.0, second_drug(), -1.0);
    EXPECT_NEAR(equivalence_p(difference, 3.0), 0.055978914532244474, 1e-12);
    // p = 5 % exactly where the 90 % interval touches the budget.
    const double budget = -confidence_interval(difference, 0.90).lower;
    EXPECT_NEAR(equivalence_p(difference, budget), 0.05, 1e-10);
}

TEST(Statistics, RatioEquivalenceAgreesWithTheIntervalOfTheRatio)
{
    // p = 5 % where Fieller's 90 % interval ends, but for Satterthwaite's degrees of freedom, 45.6
    // at that border and 47.4 at the mean ratio, which move p by 1.3e-4.
    const double budget = ratio_interval(tested, reference, 0.90).upper - 1.0;
    EXPECT_NEAR(ratio_equivalence_p(tested, reference, budget), 0.05, 2e-4);
    EXPECT_GT(ratio_equivalence_p(tested, reference, 0.1), 0.5);  // the ratio itself is 1.13
    const MeanEstimate negative{-9.0, 0.3, 29.0};
    EXPECT_GT(ratio_equivalence_p(negative, negative, 0.5), 0.99);
}

TEST(Statistics, ConfidenceIntervals)
{
    const ConfidenceInterval difference =
        confidence_interval(combine(first_drug(), 1.0, second_drug(), -1.0), 0.95);
    EXPECT_NEAR(difference.lower, -3.365483230711711, 1e-11);
    EXPECT_NEAR(difference.upper, 0.20548323071171097, 1e-11);
    const ConfidenceInterval ratio = ratio_interval(tested, reference, 0.95);
    EXPECT_NEAR(ratio.lower, 0.97744190174390783, 1e-11);
    EXPECT_NEAR(ratio.upper, 1.3237011216272794, 1e-11);
    EXPECT_TRUE(ratio.contains(tested.mean / reference.mean));
    const ConfidenceInterval unbounded = ratio_interval(tested, {0.5, 0.3, 29.0}, 0.95);
    EXPECT_EQ(unbounded.lower, -infinity);
    EXPECT_EQ(unbounded.upper, infinity);
}

TEST(Statistics, IntervalsUseTabulatedQuantiles)
{
    // Student's t at 97.5 %: 12.7062 (1 degree), 2.0395 (31), 1.9600 (infinite).
    EXPECT_NEAR(confidence_interval({0.0, 1.0, 1.0}, 0.95).upper, 12.706204736174705, 1e-10);
    EXPECT_NEAR(confidence_interval({0.0, 1.0, 31.0}, 0.95).upper, 2.0395134463964085, 1e-12);
    EXPECT_NEAR(confidence_interval({0.0, 1.0, infinity}, 0.95).upper, 1.959963984540054, 1e-12);
}

TEST(Statistics, SmallestDetectableBiasByTheNoncentralDistribution)
{
    const auto detectable = [](double freedom, double significance, double power) {
        return smallest_detectable_bias({0.0, 1.0, freedom}, significance, power);
    };
    EXPECT_NEAR(detectable(1.0, 0.05, 0.9), 20.964473420099821, 1e-6);
    EXPECT_NEAR(detectable(10.0, 0.05, 0.9), 3.6037492592478438, 1e-8);
    EXPECT_NEAR(detectable(62.0, 0.05, 0.8), 2.8459197443462324, 1e-8);
    EXPECT_NEAR(detectable(62.0, 1e-4, 0.9), 5.510452005095061, 1e-8);
    // z(97.5 %) + z(90 %), the other tail's share being 1e-7.
    EXPECT_NEAR(detectable(infinity, 0.05, 0.9), 1.959963984540054 + 1.2815515655446004, 1e-6);
    // Where the noncentral t fails to evaluate: continues the curve, grows with the threshold.
    const double few_runs = detectable(1.0, 1e-3, 0.9);
    EXPECT_NEAR(detectable(1.0, 1e-4, 0.9) / few_runs, 10.0, 1e-2);
    EXPECT_TRUE(std::isfinite(detectable(1.0, 1e-12, 0.9)));
    EXPECT_EQ(smallest_detectable_bias({0.0, 0.0, 5.0}, 0.05, 0.9), 0.0);
}

TEST(StatisticsStat, WelchTestKeepsItsLevelAndItsPower)
{
    // 20,000 tests of 8 normal runs of variance 1 against 12 of variance 9, true bias either 0 or
    // the smallest one detectable with 90 % at 5 %, which was computed from the true variances.
    // Welch's approximation itself is exact here to about 0.2 %; three binomial standard errors
    // are 0.46 % and 0.64 %.
    constexpr int test_count = 20'000;
    const MeanEstimate exact_tested{0.0, 1.0 / 8.0, 7.0};
    const MeanEstimate exact_reference{0.0, 9.0 / 12.0, 11.0};
    const double bias =
        smallest_detectable_bias(combine(exact_tested, 1.0, exact_reference, -1.0), 0.05, 0.9);
    Rng rng(1, 0, Stream::Test, 0, 0);
    const auto normal = [&rng] {
        const double radius = std::sqrt(-2.0 * std::log1p(-static_cast<double>(rng.uniform())));
        return radius * std::cos(2.0 * M_PI * static_cast<double>(rng.uniform()));
    };
    int false_alarms = 0;
    int found = 0;
    for (int i = 0; i < test_count; ++i) {
        RunningStats a;
        RunningStats b;
        RunningStats biased;
        for (int k = 0; k < 8; ++k) {
            const double value = normal();
            a.add(value);
            biased.add(value + bias);
        }
        for (int k = 0; k < 12; ++k) b.add(3.0 * normal());
        false_alarms += welch_test(estimate_mean(a), estimate_mean(b)).p <= 0.05 ? 1 : 0;
        found += welch_test(estimate_mean(biased), estimate_mean(b)).p <= 0.05 ? 1 : 0;
    }
    EXPECT_NEAR(false_alarms / static_cast<double>(test_count), 0.05, 0.0066);
    EXPECT_NEAR(found / static_cast<double>(test_count), 0.90, 0.0100);
}

}  // namespace mote
