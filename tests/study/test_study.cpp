#include <limits>

#include <gtest/gtest.h>

#include "study/error_figures.h"
#include "study/fake_estimator.h"
#include "study/study.h"
#include "study/tile_judge.h"

namespace mote {
namespace {

using test::FakeEstimator;

StudyParams params_of(double budget, int most_runs = 256)
{
    StudyParams params;
    params.question.budget = budget;
    params.question.tile_budget = 0.5;
    params.most_runs = most_runs;
    return params;
}

TEST(Look, AlphaOfAllLooksTogetherStaysBelowAlpha)
{
    double sum = 0.0;
    for (int k = 1; k <= 10'000; ++k) sum += alpha_of_look(0.01, k);
    EXPECT_LT(sum, 0.01);
    EXPECT_NEAR(sum, 0.01, 2e-6);
    EXPECT_EQ(runs_of_look(32, 1), 32);
    EXPECT_EQ(runs_of_look(32, 2), 48);
    EXPECT_EQ(runs_of_look(32, 3), 72);
}

TEST(Look, PartsAreMeasuredByThePictureAndAlphaByItself)
{
    TileStats stats(8);
    LayeredImage image = FakeEstimator{}(1);
    image.channels.push_back({"volume_direct.R", PixelType::Float, Buffer2D<float>(24, 16, 0.1f)});
    add_run(stats, image);
    const auto mean = [&](const char* name) { return stats.find(name)->whole_image.mean; };
    const double picture = (mean("R") + mean("G") + mean("B")) / 3.0;
    EXPECT_DOUBLE_EQ(channel_scale(stats, "volume_direct.R"), picture);
    EXPECT_DOUBLE_EQ(channel_scale(stats, "G"), picture);
    EXPECT_DOUBLE_EQ(channel_scale(stats, "A"), mean("A"));
}

TEST(Study, StopsAsSoonAsABiasOfTheBudgetWouldHaveBeenFound)
{
    const Study study = run_study(FakeEstimator{}, FakeEstimator{}, params_of(0.05, 4096));
    EXPECT_EQ(study.verdict(), Verdict::NoBias) << study.last().reason;
    EXPECT_LE(study.last().detectable, 0.05);
    EXPECT_LT(study.last().runs, 1000);
    for (size_t i = 0; i + 1 < study.looks.size(); ++i) {
        EXPECT_EQ(study.looks[i].verdict, Verdict::NotEnoughRuns);
    }
    EXPECT_EQ(study.kept.size(), 8u);
    EXPECT_EQ(study.tested.run_count, study.reference.run_count);
}

TEST(Study, FindsBiasOfTheWholeImageAndOfACorner)
{
    FakeEstimator bright;
    bright.scale = 1.04;
    EXPECT_EQ(run_study(bright, FakeEstimator{}, params_of(0.005)).verdict(), Verdict::BiasFound);
    FakeEstimator corner;
    corner.corner_scale = 0.8;
    const Study study = run_study(corner, FakeEstimator{}, params_of(0.005));
    EXPECT_EQ(study.verdict(), Verdict::BiasFound);
    EXPECT_LT(study.last().comparison.p_tiles, study.last().alpha);
}

TEST(Study, TooFewRunsDecideNothingWhateverIsAsked)
{
    for (const bool equivalence : {false, true}) {
        StudyParams params = params_of(0.01, 40);
        params.question.equivalence = equivalence;
        const Study study = run_study(FakeEstimator{}, FakeEstimator{}, params);
        EXPECT_EQ(study.verdict(), Verdict::NotEnoughRuns) << study.last().reason;
        EXPECT_EQ(study.last().runs, 40);
        params = params_of(0.9, 4);
        params.question.equivalence = equivalence;
        EXPECT_EQ(run_study(FakeEstimator{}, FakeEstimator{}, params).verdict(),
                  Verdict::NotEnoughRuns);
    }
}

TEST(Study, EquivalenceAllowsABiasUnderTheBudgetAndNoneOverIt)
{
    FakeEstimator biased;
    biased.scale = 1.04;
    biased.noise = 0.1;
    FakeEstimator reference;
    reference.noise = 0.1;
    StudyParams params = params_of(0.08, 4096);
    params.question.equivalence = true;
    EXPECT_EQ(run_study(biased, reference, params).verdict(), Verdict::NoBias);
    params.question.budget = 0.02;
    EXPECT_EQ(run_study(biased, reference, params).verdict(), Verdict::BiasFound);
    // On the edge neither is shown, however many runs there are.
    params.question.budget = 0.04;
    params.most_runs = 300;
    EXPECT_EQ(run_study(biased, reference, params).verdict(), Verdict::NotEnoughRuns);
}

TEST(Study, PixelsThatAreNotFiniteAreAFailure)
{
    const RunSource broken = [](uint32_t seed) {
        LayeredImage image = FakeEstimator{}(seed);
        if (seed == 7) image.channels[1].data.at(3, 2) = std::numeric_limits<float>::quiet_NaN();
        return image;
    };
    const Study study = run_study(broken, FakeEstimator{}, params_of(0.05));
    EXPECT_EQ(study.verdict(), Verdict::BiasFound);
    EXPECT_NE(study.last().reason.find("NaN"), std::string::npos) << study.last().reason;
    EXPECT_GT(measure_errors(study).rel_mse, 0.0);
}

TEST(Study, AllIsTheSameForTheSameSeed)
{
    const auto bias = [] {
        return run_study(FakeEstimator{}, FakeEstimator{}, params_of(0.05)).last().channels[0].bias;
    };
    EXPECT_EQ(bias(), bias());
}

TEST(StudyStat, ErrorsSplitIntoBiasAndVariance)
{
    FakeEstimator tested;
    tested.scale = 1.2;
    tested.noise = 0.3;
    FakeEstimator reference;
    reference.noise = 0.05;
    const Study study = run_study(tested, reference, params_of(0.001));
    const ErrorFigures errors = measure_errors(study);
    // Mean over columns of ((1 + x) / 24)^2; the noise has variance 1/2 per pixel, times 0.3^2, and
    // that of the run 0.02^2.
    const double square = 0.3546;
    EXPECT_NEAR(errors.absolute.bias_squared, 0.04 * square, 0.05 * 0.04 * square);
    EXPECT_NEAR(errors.absolute.variance, 1.44 * (0.045 + 4e-4) * square, 0.002);
    EXPECT_NEAR(errors.absolute.mse(), errors.absolute.bias_squared + errors.absolute.variance,
                1e-12);
    EXPECT_GT(errors.rel_mse, errors.trimmed_rel_mse);
    EXPECT_GT(errors.worst_share, 0.0);
    // The bias is the same in all pixels, so the error does not fall off to 0.
    ASSERT_EQ(errors.autocovariance.size(), 9u);
    EXPECT_EQ(errors.autocovariance[0], 1.0);
    EXPECT_NEAR(errors.autocovariance[8], 0.38, 0.12);
}

/// Rejections of so many studies of unbiased estimators, and of Welch's test of the same
/// runs without judge_tiles().
struct Alarms {
    int64_t studies = 0;
    int64_t plain = 0;
};
Alarms alarms_of(const FakeEstimator& tested, const FakeEstimator& reference, double alpha,
                 uint32_t repetitions)
{
    Alarms alarms;
    for (uint32_t i = 0; i < repetitions; ++i) {
        StudyParams params = params_of(1e-4, 36);
        params.question.alpha = alpha;
        params.question.tile_budget = 0.1;
        params.first_look = 24;
        params.seed = 1 + 1000 * i;
        const Study study = run_study(tested, reference, params);
        alarms.studies += study.verdict() == Verdict::BiasFound ? 1 : 0;
        alarms.plain += compare_runs(study.tested, study.reference).p <= study.last().alpha ? 1 : 0;
    }
    return alarms;
}

TEST(StudyStat, AnEstimatorAgainstItselfIsRejectedNoMoreThanAtTheNominalRate)
{
    // At most 23 of 200 at 5 %: fails falsely once in 10,000 seeds.
    const Alarms alarms = alarms_of({}, {}, 0.05, 200);
    RecordProperty("rejected_of_200", static_cast<int>(alarms.studies));
    EXPECT_LE(alarms.studies, binomial_bound(200, 0.05, 1e-4));
}

TEST(StudyStat, RareSamplesRaiseNoFalseAlarms)
{
    // Tiles that few samples reach, and a reference of many samples. Welch's test alone takes
    // tested runs that have seen nothing for certainty, and fails this test, which fails falsely
    // once in 10,000 seeds.
    FakeEstimator reference;
    reference.alpha_samples = 32;
    const Alarms alarms = alarms_of({}, reference, 1e-3, 100);
    EXPECT_LE(alarms.studies, binomial_bound(100, 1e-3, 1e-4));
    EXPECT_GT(alarms.plain, binomial_bound(100, 1e-3, 1e-4));
}

TEST(TileJudge, AnEstimatorThatMissesWhatComesRarelyIsNotAccusedOfIt)
{
    FakeEstimator blind;
    blind.rare_chance = 0.0;
    FakeEstimator seeing;
    seeing.alpha_samples = 32;
    TileStats tested(8);
    TileStats reference(8);
    for (uint32_t k = 0; k < 32; ++k) {
        add_run(tested, blind(k));
        add_run(reference, seeing(1000 + k));
    }
    RunComparison comparison = compare_runs(tested, reference);
    const double before = comparison.channels[3].tiles[0].p;
    judge_tiles(tested, reference, 1e-3, comparison);
    EXPECT_LT(before, 1e-4);
    EXPECT_GT(comparison.channels[3].tiles[0].p, 1e-3);
    // What comes often is missed by nobody.
    blind.corner_scale = 0.0;
    TileStats dark(8);
    for (uint32_t k = 0; k < 32; ++k) add_run(dark, blind(k));
    comparison = compare_runs(dark, reference);
    judge_tiles(dark, reference, 1e-3, comparison);
    EXPECT_LT(comparison.channels[0].tiles[5].p, 1e-6);
    EXPECT_LT(comparison.p, 1e-4);
}

}  // namespace
}  // namespace mote
