#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/rng.h"
#include "restir/edge_weights.h"

namespace mote {
namespace {

/// Weights of both edges of one bin of depth D, in double: integrals of exp(-t) (1 - t/D) and
/// exp(-t) t/D. Below 1e-3 by their series, to 1e-13.
struct BinWeights {
    double near, far;
};
BinWeights exact_weights(double D)
{
    if (D < 1e-3) {
        return {D * (0.5 - D * (1.0 / 6 - D / 24)), D * (0.5 - D * (1.0 / 3 - D / 8))};
    }
    const double lost = -std::expm1(-D);
    const double far = (lost - D * std::exp(-D)) / D;
    return {lost - far, far};
}

RayBins random_bins(uint32_t index, int count, float mean_depth)
{
    Rng rng(1, 0, Stream::Test, index, 0);
    RayBins bins;
    bins.count = count;
    bins.tau[0] = 0.0f;
    for (int k = 0; k <= count; ++k) bins.s[k] = static_cast<float>(k);
    for (int k = 0; k < count; ++k) {
        // Gaps, thin and thick bins.
        const float u = rng.uniform();
        const float depth = u < 0.1f ? 0.0f : mean_depth * std::exp(6.0f * rng.uniform() - 4.0f);
        bins.tau[k + 1] = bins.tau[k] + depth;
    }
    return bins;
}

TEST(EdgeWeights, AreThoseOfTheClosedForm)
{
    // Tolerance: what is lost in a bin is a difference of two numbers near 1, so errors are of the
    // size of float rounding (6e-8) times a few, absolute within a bin. Transmittances are held at
    // exp(-87) = 1.6e-38, of both bins at an edge.
    for (uint32_t i = 0; i < 600; ++i) {
        const int count = 1 + static_cast<int>(i % RayBins::capacity);
        const float mean_depth = i % 3 == 0 ? 0.01f : i % 3 == 1 ? 0.3f : 5.0f;
        const RayBins bins = random_bins(i, count, mean_depth);
        EdgeWeights weights;
        weigh_edges(bins, weights);
        std::vector<double> exact(static_cast<size_t>(count) + 1, 0.0);
        for (int k = 0; k < count; ++k) {
            const double T = std::exp(-static_cast<double>(bins.tau[k]));
            const auto D = static_cast<double>(bins.depth_of_bin(k));
            exact[static_cast<size_t>(k)] += T * exact_weights(D).near;
            exact[static_cast<size_t>(k) + 1] += T * exact_weights(D).far;
        }
        double sum = 0.0;
        for (int k = 0; k <= count; ++k) {
            const double of = exact[static_cast<size_t>(k)];
            sum += static_cast<double>(weights.of[k]);
            EXPECT_NEAR(static_cast<double>(weights.of[k]), of,
                        1e-6 * of + (of > 0.05 ? 3e-7 : 4e-38))
                << i << ' ' << k;
        }
        // All together: the light that collides on the ray.
        const double lost = -std::expm1(-static_cast<double>(bins.tau[count]));
        EXPECT_NEAR(sum, lost, 1e-6 * lost) << i;
    }
}

TEST(EdgeWeights, StayFiniteHoweverDeepTheSmoke)
{
    RayBins bins;
    bins.count = 3;
    for (int k = 0; k <= 3; ++k) bins.s[k] = static_cast<float>(k);
    bins.tau[0] = 0.0f;
    bins.tau[1] = 1e20f;
    bins.tau[2] = 1e30f;
    bins.tau[3] = 3e38f;
    EdgeWeights weights;
    weigh_edges(bins, weights);
    EXPECT_NEAR(weights.of[0], 1.0f, 1e-6f);
    for (int k = 1; k <= 3; ++k) {
        EXPECT_GE(weights.of[k], 0.0f);
        EXPECT_LT(weights.of[k], 1e-6f);
    }
}

}  // namespace
}  // namespace mote
