#include "restir/reuse_mis.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.h"

namespace mote {
namespace {

/// Targets of the inputs at one sample, pulled back to the pixel; index 0 is the pixel's own.
struct Inputs {
    std::vector<float> confidence;
    std::vector<float> target;

    [[nodiscard]] Confidences confidences() const
    {
        Confidences c{confidence[0], 0.0f};
        for (size_t i = 1; i < confidence.size(); ++i) c.others += confidence[i];
        return c;
    }
};

/// Zeros and twelve orders of magnitude.
float random_target(Rng& rng)
{
    const float u = rng.uniform();
    if (u < 0.2f) return 0.0f;
    return std::pow(10.0f, 12.0f * rng.uniform() - 6.0f);
}

Inputs random_inputs(Rng& rng, int others)
{
    Inputs in;
    for (int i = 0; i <= others; ++i) {
        in.confidence.push_back(0.05f + 16.0f * rng.uniform());
        in.target.push_back(random_target(rng));
    }
    return in;
}

std::vector<float> weights(MisForm form, const Inputs& in)
{
    const Confidences c = in.confidences();
    std::vector<float> m;
    if (form == MisForm::Balance) {
        TargetSum all;
        for (size_t i = 0; i < in.target.size(); ++i) all.add(in.confidence[i], in.target[i]);
        for (size_t i = 0; i < in.target.size(); ++i) {
            m.push_back(all.share(in.confidence[i], in.target[i]));
        }
        return m;
    }
    m.push_back(c.own / c.sum());
    for (size_t i = 1; i < in.target.size(); ++i) {
        m[0] += own_weight_term(form, c, in.confidence[i], in.target[i], in.target[0]);
        m.push_back(other_weight(form, c, in.confidence[i], in.target[i], in.target[0]));
    }
    return m;
}

void expect_partition(MisForm form, const Inputs& in)
{
    const std::vector<float> m = weights(form, in);
    double sum = 0.0;
    for (const float each : m) {
        // Sums of up to 17 floats.
        EXPECT_GE(each, -2e-6f);
        EXPECT_LE(each, 1.0f + 2e-6f);
        sum += static_cast<double>(each);
    }
    // The own weight matters only where the own pixel can have made the sample, and so does what
    // an empty combination adds up to.
    if (form == MisForm::Constant || in.target[0] > 0.0f) {
        EXPECT_NEAR(sum, 1.0, 3e-6);
    }
    if (form == MisForm::Constant) return;
    for (size_t i = 1; i < m.size(); ++i) {
        if (in.target[i] == 0.0f) {
            EXPECT_EQ(m[i], 0.0f);
        }
    }
}

TEST(ReuseMis, WeightsAddUpToOne)
{
    for (uint32_t trial = 0; trial < 10'000; ++trial) {
        Rng rng(1, 0, Stream::Test, trial, 0);
        const int others = 1 + static_cast<int>(16.0f * rng.uniform());
        expect_partition(MisForm::Pairwise, random_inputs(rng, others));
        expect_partition(MisForm::Constant, random_inputs(rng, others));
        expect_partition(MisForm::Balance, random_inputs(rng, others));
    }
}

/// One other input of no use, or of all.
TEST(ReuseMis, NothingIsLostWhereOneTargetIsZero)
{
    for (const MisForm form : {MisForm::Pairwise, MisForm::Balance}) {
        EXPECT_EQ(weights(form, {{1.0f, 3.0f}, {2.0f, 0.0f}})[0], 1.0f);
    }
    EXPECT_EQ(weights(MisForm::Pairwise, {{1.0f, 3.0f}, {0.0f, 0.0f}})[0], 1.0f);
    // What only the other can make: all its weight, and the pixel's share is for nothing.
    EXPECT_EQ(weights(MisForm::Balance, {{1.0f, 3.0f}, {0.0f, 2.0f}})[1], 1.0f);
    EXPECT_EQ(weights(MisForm::Pairwise, {{1.0f, 3.0f}, {0.0f, 2.0f}})[1], 0.75f);
}

/// What the defensive form promises: an input whose target is far below the pixel's own can never
/// bring a large weight, whatever its confidence.
TEST(ReuseMis, PairwiseKeepsItsBounds)
{
    for (uint32_t trial = 0; trial < 10'000; ++trial) {
        Rng rng(2, 0, Stream::Test, trial, 0);
        const Inputs in = random_inputs(rng, 1 + static_cast<int>(16.0f * rng.uniform()));
        const std::vector<float> m = weights(MisForm::Pairwise, in);
        const float C = in.confidences().sum();
        EXPECT_GE(m[0], in.confidence[0] / C * (1.0f - 1e-6f));
        for (size_t i = 1; i < m.size(); ++i) {
            const float share = in.confidence[i] / C * (1.0f + 1e-5f);
            EXPECT_LE(m[i], share);
            EXPECT_LE(m[i] * in.target[0], share * in.target[i]);
        }
    }
}

TEST(ReuseMis, ExtremeTargetsGiveFiniteWeights)
{
    for (const float own : {0.0f, 1e-38f, 1e38f}) {
        for (const float other : {0.0f, 1e-38f, 1e38f}) {
            for (const MisForm form : {MisForm::Pairwise, MisForm::Balance, MisForm::Constant}) {
                for (const float each : weights(form, {{1.0f, 16.0f}, {own, other}})) {
                    EXPECT_TRUE(std::isfinite(each)) << own << " " << other;
                }
            }
        }
    }
}

}  // namespace
}  // namespace mote
