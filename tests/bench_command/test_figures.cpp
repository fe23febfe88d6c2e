#include <gtest/gtest.h>

#include "bench/figures.h"
#include "bench_command/noisy_images.h"

namespace mote {

namespace {

RunFigures run_of(double mse, double cpu_us)
{
    return {{mse, 0.5 * mse, 2.0 * mse, mse, 0.1}, cpu_us, 0.25 * cpu_us, 2.0 * cpu_us};
}

MethodFigures figures_of(std::vector<RunFigures> runs, const PixelStats& tested,
                         const PixelStats& reference)
{
    MethodResult row;
    row.runs = std::move(runs);
    return summarize(row, tested, reference);
}

MethodResult row_of(const char* name, bool is_reference, double efficiency, double trimmed)
{
    MethodResult row;
    row.name = name;
    row.is_reference = is_reference;
    row.figures.efficiency = efficiency;
    row.figures.trimmed_efficiency = trimmed;
    return row;
}

}  // namespace

TEST(Figures, AreMediansAndTheirEfficiency)
{
    const PixelStats any = noisy_runs(8, 8, 1.0f, 0.0, 2, 1);
    const std::vector<RunFigures> runs{run_of(0.1, 2.0), run_of(50.0, 2.0), run_of(0.2, 90.0)};
    const MethodFigures f = figures_of(runs, any, any);
    EXPECT_DOUBLE_EQ(f.error.mse, 0.2);
    EXPECT_DOUBLE_EQ(f.error.trimmed_mse, 0.1);
    EXPECT_DOUBLE_EQ(f.error.rel_mse, 0.4);
    EXPECT_DOUBLE_EQ(f.cpu_us, 2.0);
    EXPECT_DOUBLE_EQ(f.cache_us, 0.5);
    EXPECT_DOUBLE_EQ(f.wall_us, 4.0);
    EXPECT_DOUBLE_EQ(f.efficiency, 2.5);
    EXPECT_DOUBLE_EQ(f.trimmed_efficiency, 5.0);
    EXPECT_TRUE(std::isnan(f.ratio));
}

TEST(Figures, AnErrorBelowTheNoiseHasNoEfficiency)
{
    const PixelStats any = noisy_runs(8, 8, 1.0f, 0.0, 2, 1);
    const std::vector<RunFigures> runs{run_of(-0.1, 2.0), run_of(-0.2, 2.0)};
    const MethodFigures f = figures_of(runs, any, any);
    EXPECT_TRUE(std::isnan(f.efficiency));
    EXPECT_TRUE(std::isnan(f.efficiency_error));
}

TEST(Figures, EfficiencyErrorIsTheScatterOfLogarithms)
{
    const PixelStats any = noisy_runs(8, 8, 1.0f, 0.0, 2, 1);
    const std::vector<RunFigures> runs{run_of(1.0, 1.0), run_of(std::exp(0.2), 1.0)};
    // Two values 0.2 apart: standard deviation 0.2 / sqrt 2, of the mean 0.1.
    EXPECT_NEAR(figures_of(runs, any, any).efficiency_error, 0.1, 1e-12);
}

TEST(FiguresStat, VarianceAndBiasOfKnownNoiseAreFound)
{
    // 64 x 50 pixels, truth 1; the tested runs are 1 % too bright with variance 0.04.
    constexpr double variance = 0.04;
    const PixelStats reference = noisy_runs(64, 50, 1.0f, 0.01, 8, 1);
    const PixelStats tested = noisy_runs(64, 50, 1.01f, variance, 8, 100);
    const std::vector<RunFigures> runs(8, run_of(variance, 1.0));
    const MethodFigures f = figures_of(runs, tested, reference);
    // Means over 8 runs of 9600 values have standard errors of 0.04 %, and 0.02 % in the reference.
    EXPECT_NEAR(f.bias_error, 0.0008, 0.0005);
    EXPECT_NEAR(f.bias, 0.01, 5.0 * 0.0008);
    EXPECT_LT(f.bias_p, 0.01);
    EXPECT_NEAR(f.n_var, variance, 0.02 * variance);  // 67,200 degrees of freedom: 0.5 %
    // Negative control: runs without bias are not found guilty (fails falsely for 1 % of seeds).
    const PixelStats unbiased = noisy_runs(64, 50, 1.0f, variance, 8, 300);
    EXPECT_GT(figures_of(runs, unbiased, reference).bias_p, 0.01);
}

TEST(Figures, RatiosAreOverTheBestReferenceRow)
{
    std::vector<MethodResult> rows{row_of("path a", true, 2.0, 10.0),
                                   row_of("path b", true, 4.0, 5.0),
                                   row_of("other", false, 40.0, 40.0)};
    rate_rows(rows);
    EXPECT_DOUBLE_EQ(rows[0].figures.ratio, 0.5);
    EXPECT_DOUBLE_EQ(rows[1].figures.ratio, 1.0);
    EXPECT_DOUBLE_EQ(rows[2].figures.ratio, 10.0);
    EXPECT_DOUBLE_EQ(rows[2].figures.trimmed_ratio, 4.0);
    std::vector<MethodResult> none{row_of("other", false, 40.0, 40.0)};
    rate_rows(none);
    EXPECT_TRUE(std::isnan(none[0].figures.ratio));
}

TEST(Figures, SlopeIsThatOfThePowerLaw)
{
    // relMSE = 3 / t^1.5; caches do not count.
    std::vector<CurvePoint> curve;
    for (const double t : {1.0, 4.0, 16.0}) {
        curve.push_back({1, t + 7.0, 7.0, 0.0, 3.0 / (t * std::sqrt(t))});
    }
    EXPECT_NEAR(log_slope(curve), -1.5, 1e-12);
    curve[0].rel_mse = -1.0;  // below the reference's noise: left out
    EXPECT_NEAR(log_slope(curve), -1.5, 1e-12);
    curve[1].rel_mse = -1.0;
    EXPECT_TRUE(std::isnan(log_slope(curve)));
    EXPECT_TRUE(std::isnan(log_slope({})));
}

TEST(Figures, CurvePointsAreMedians)
{
    const CurvePoint point = curve_point(
        3, std::vector<RunFigures>{run_of(0.1, 2.0), run_of(50.0, 2.0), run_of(0.2, 9.0)});
    EXPECT_EQ(point.samples, 3);
    EXPECT_DOUBLE_EQ(point.mse, 0.2);
    EXPECT_DOUBLE_EQ(point.rel_mse, 0.4);
    EXPECT_DOUBLE_EQ(point.cpu_us, 2.0);
    EXPECT_DOUBLE_EQ(point.cache_us, 0.5);
}

TEST(Figures, TimeToTheTargetGrowsWithTheVarianceAlone)
{
    // 2 us a pixel, of it 0.5 caches, for a relMSE of 0.04 by 4 samples in 2 frames.
    const PixelStats any = noisy_runs(8, 8, 1.0f, 0.0, 2, 1);
    MethodResult row;
    row.samples = 4;
    row.compared = 2;
    row.runs = {run_of(0.02, 2.0), run_of(0.02, 2.0)};
    const MethodFigures f = summarize(row, any, any);
    EXPECT_DOUBLE_EQ(f.pass_us, 1.5 / 8.0);
    EXPECT_NEAR(f.time_to_target, 0.5 + 4.0 * 1.5, 1e-9);
    row.runs = {run_of(-0.02, 2.0), run_of(-0.02, 2.0)};
    EXPECT_TRUE(std::isnan(summarize(row, any, any).time_to_target));
}

TEST(FiguresStat, BiasIsTakenOutOfTheErrorOfTheMean)
{
    // 64 x 50 pixels, 20 % too bright, with variance 0.04: relMSE 0.08 / 1.01, of which bias 0.04.
    const PixelStats reference = noisy_runs(64, 50, 1.0f, 1e-4, 8, 1);
    const auto row_of_bias = [&](float value, bool is_biased, PixelStats& tested) {
        MethodResult row;
        row.is_biased = is_biased;
        for (uint32_t k = 0; k < 8; ++k) {
            const Buffer2D<Spectrum> image = noisy_image(64, 50, value, 0.04, 100 + k);
            add_run(tested, image);
            row.runs.push_back({measure_error(image, reference), 1.0, 0.0, 1.0});
        }
        return row;
    };
    PixelStats biased;
    const MethodResult row = row_of_bias(1.2f, true, biased);
    const MethodFigures f = summarize(row, biased, reference);
    // The squared errors of 76,800 values scatter by less than 2 sigma^2 + 4 b sigma: 0.24 / 277.
    EXPECT_NEAR(f.rel_bias_squared, 0.04 / 1.01, 5e-3);
    EXPECT_NEAR(f.bias_squared, 0.04, 5e-3);
    EXPECT_TRUE(std::isinf(f.time_to_target));  // 4 % is above the target
    // Negative control: without bias there is none to be found, and the target is reached.
    PixelStats unbiased;
    const MethodFigures right = summarize(row_of_bias(1.0f, false, unbiased), unbiased, reference);
    EXPECT_NEAR(right.bias_squared, 0.0, 1e-3);
    EXPECT_NEAR(right.time_to_target, 4.0 / 1.01, 0.1);
}

}  // namespace mote
