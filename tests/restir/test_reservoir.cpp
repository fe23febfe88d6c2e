#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "restir/combine.h"
#include "restir/reservoir.h"
#include "restir/reuse_mis.h"

namespace mote {
namespace {

/// A space of four points: source probabilities, target, and the function to integrate. One point
/// the target does not want though the source makes it, one brings more than the target believes.
constexpr size_t points = 4;
constexpr double source[points] = {0.4, 0.3, 0.2, 0.1};
constexpr float target[points] = {1.0f, 0.0f, 3.0f, 0.5f};
constexpr double f[points] = {2.0, 0.0, 2.5, 1.0};
constexpr double integral = 5.5;

PathSample sample_of(size_t point)
{
    PathSample y;
    y.light = static_cast<int>(point);
    return y;
}

double weight_of(size_t point, size_t candidates)
{
    return static_cast<double>(target[point]) / (static_cast<double>(candidates) * source[point]);
}

/// Mean over a fine grid of the number that decides, the midpoint rule: off by at most 1/steps.
constexpr int steps = 512;
template <class F>
double mean_over_u(F&& g)
{
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        sum += g((static_cast<float>(i) + 0.5f) / static_cast<float>(steps));
    }
    return sum / steps;
}

/// Every pair of candidates, each with its probability: E[f(y) W] is the integral of f.
TEST(Reservoir, HasTheIntegralAsItsMean)
{
    double mean = 0.0;
    for (size_t a = 0; a < points; ++a) {
        for (size_t b = 0; b < points; ++b) {
            mean += source[a] * source[b] * mean_over_u([&](float u) {
                        RisStream stream;
                        stream.add(sample_of(a), target[a], weight_of(a, 2), 0.0f, 0.25f);
                        stream.add(sample_of(b), target[b], weight_of(b, 2), 0.0f, u);
                        const Reservoir r = stream.finish();
                        if (!(r.W > 0.0f)) return 0.0;
                        return f[static_cast<size_t>(r.y.light)] * static_cast<double>(r.W);
                    });
        }
    }
    // One step of the grid, times the largest f / target.
    EXPECT_NEAR(mean, integral, 2.0 * integral / steps);
}

TEST(Reservoir, ChoosesInProportionToWeights)
{
    const double w[] = {0.5, 2.0, 1.5};
    for (int chosen = 0; chosen < 2; ++chosen) {
        const double share = mean_over_u([&](float u) {
            RisStream stream;
            stream.add(sample_of(0), 1.0f, w[0], 0.0f, 0.0f);
            const bool taken = stream.add(sample_of(1), 1.0f, w[1 + chosen], 0.0f, u);
            return taken ? 1.0 : 0.0;
        });
        EXPECT_NEAR(share, w[1 + chosen] / (w[0] + w[1 + chosen]), 1.0 / steps);
    }
}

/// Two reservoirs of two candidates each, merged by the balance heuristic, are one of four.
TEST(Reservoir, MergingIsStreaming)
{
    const size_t drawn[] = {0, 2, 3, 2};
    RisStream all;
    for (const size_t x : drawn) all.add(sample_of(x), target[x], weight_of(x, 4), 0.0f, 0.0f);
    const Reservoir whole = all.finish();

    RisStream merged;
    for (int half = 0; half < 2; ++half) {
        RisStream part;
        part.count(1.0f);
        for (int i = 0; i < 2; ++i) {
            const size_t x = drawn[2 * half + i];
            part.add(sample_of(x), target[x], weight_of(x, 2), 0.0f, 0.0f);
        }
        const Reservoir r = part.finish();
        const float p = r.p_hat;
        TargetSum both;
        both.add(1.0f, p);
        both.add(1.0f, p);
        const float m = both.share(1.0f, p);
        merged.count(r.M);
        merged.add(r.y, p, static_cast<double>(m * p * r.W), 0.0f, 0.0f);
    }
    const Reservoir together = merged.finish();
    EXPECT_NEAR(together.W * together.p_hat, whole.W * whole.p_hat, 1e-6f);
    EXPECT_EQ(together.M, 2.0f);
}

TEST(Reservoir, EmptyInputsCountAndUselessWeightsAreNeverChosen)
{
    RisStream stream;
    EXPECT_EQ(stream.finish().W, 0.0f);
    for (const double w : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
        stream.count(1.0f);
        EXPECT_FALSE(stream.add(sample_of(0), 1.0f, w, 0.0f, 0.0f));
    }
    EXPECT_EQ(stream.finish().W, 0.0f);
    EXPECT_EQ(stream.finish().M, 4.0f);
    EXPECT_TRUE(stream.add(sample_of(2), 2.0f, 3.0, 5.0f, one_minus_epsilon));
    EXPECT_EQ(stream.finish().W, 1.5f);
    EXPECT_EQ(stream.finish().age, 5.0f);
}

TEST(Reservoir, APassCountsOnceWhateverItDrew)
{
    Rng rng(1, 0, Stream::Test, 0, 0);
    Spectrum color;
    EXPECT_EQ(resample({}, rng, color).r.M, 1.0f);
    EXPECT_EQ(color, Spectrum(0.0f));
    std::vector<Candidate> candidates(5);
    for (Candidate& c : candidates) c.density = 2.0f;
    EXPECT_EQ(resample(candidates, rng, color).r.W, 0.0f);
    candidates[3].f = Spectrum(1.0f, 2.0f, 3.0f);
    const PixelReservoir one = resample(candidates, rng, color);
    EXPECT_EQ(one.r.M, 1.0f);
    EXPECT_EQ(one.r.W, 0.5f);
    EXPECT_EQ(color, candidates[3].f / 2.0f);
}

}  // namespace
}  // namespace mote
