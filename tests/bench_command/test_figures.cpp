#include <gtest/gtest.h>

#include "bench/figures.h"
#include "bench_command/noisy_images.h"

namespace mote {

namespace {

RunFigures run_of(double mse, double cpu_us)
{
    return {{mse, 0.5 * mse, 2.0 * mse, mse, 0.1}, cpu_us, 0.25 * cpu_us, 2.0 * cpu_us};
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
    const MethodFigures f = summarize(runs, any, any);
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
    const MethodFigures f = summarize(runs, any, any);
    EXPECT_TRUE(std::isnan(f.efficiency));
    EXPECT_TRUE(std::isnan(f.efficiency_error));
}

TEST(Figures, EfficiencyErrorIsTheScatterOfLogarithms)
{
    const PixelStats any = noisy_runs(8, 8, 1.0f, 0.0, 2, 1);
    const std::vector<RunFigures> runs{run_of(1.0, 1.0), run_of(std::exp(0.2), 1.0)};
    // Two values 0.2 apart: standard deviation 0.2 / sqrt 2, of the mean 0.1.
    EXPECT_NEAR(summarize(runs, any, any).efficiency_error, 0.1, 1e-12);
}

TEST(FiguresStat, VarianceAndBiasOfKnownNoiseAreFound)
{
    // 64 x 50 pixels, truth 1; the tested runs are 1 % too bright with variance 0.04.
    constexpr double variance = 0.04;
    const PixelStats reference = noisy_runs(64, 50, 1.0f, 0.01, 8, 1);
    const PixelStats tested = noisy_runs(64, 50, 1.01f, variance, 8, 100);
    const std::vector<RunFigures> runs(8, run_of(variance, 1.0));
    const MethodFigures f = summarize(runs, tested, reference);
    // Means over 8 runs of 9600 values have standard errors of 0.04 %, and 0.02 % in the reference.
    EXPECT_NEAR(f.bias_error, 0.0008, 0.0005);
    EXPECT_NEAR(f.bias, 0.01, 5.0 * 0.0008);
    EXPECT_LT(f.bias_p, 0.01);
    EXPECT_NEAR(f.n_var, variance, 0.02 * variance);  // 67,200 degrees of freedom: 0.5 %
    // Negative control: runs without bias are not found guilty (fails falsely for 1 % of seeds).
    const PixelStats unbiased = noisy_runs(64, 50, 1.0f, variance, 8, 300);
    EXPECT_GT(summarize(runs, unbiased, reference).bias_p, 0.01);
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

}  // namespace mote
