#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace mote {

/// Chance that the smallest of `count` independent p-values is at most `smallest`. Also an upper
/// bound of it for two-sided tests of correlated normal means, as neighbouring tiles and colour
/// channels are. Source: Sidak 1967.
[[nodiscard]] double sidak_p(double smallest, int64_t count);

/// p-values adjusted for being one of many, in the order given: those <= alpha may all be rejected
/// with at most chance alpha of any false rejection, whatever their dependence. Source: Holm 1979.
[[nodiscard]] std::vector<double> holm_adjusted(std::span<const double> p_values);

/// Kolmogorov and Smirnov's test of independent numbers against the uniform distribution on [0,1].
struct UniformityTest {
    int64_t count = 0;
    double distance = 0.0;  ///< largest |empirical - uniform distribution function|
    double p = 1.0;         ///< chance of such a distance; 1 for no values
};

/// Are these p-values uniform, as they must be when all null hypotheses hold? Small p: the tests
/// are miscalibrated or many hold a small bias. Only for independent values: spatial reuse
/// correlates neighbouring tiles, and light of one path all colour channels.
[[nodiscard]] UniformityTest test_uniformity(std::span<const double> p_values);

/// Distribution function of the Kolmogorov-Smirnov distance of n uniform numbers. Exact (Marsaglia,
/// Tsang and Wang 2003) for n <= 100, above it Kolmogorov's limit with the correction of Vrbik
/// 2018, which is within 2e-4 there.
[[nodiscard]] double kolmogorov_cdf(int64_t n, double distance);

/// Numbers of equal-width bins over [0,1].
[[nodiscard]] std::vector<int64_t> histogram(std::span<const double> p_values, int bins);

/// Upper limit of a rate of which `count` of `trials` were seen, at one-sided `confidence`.
/// Source: Clopper and Pearson 1934.
[[nodiscard]] double binomial_upper_limit(int64_t count, int64_t trials, double confidence);

/// Smallest c such that more than c events in `trials` of probability `rate` have a chance of at
/// most `false_alarm`: what a repeated test may reject before its rate is doubted.
[[nodiscard]] int64_t binomial_bound(int64_t trials, double rate, double false_alarm);

}  // namespace mote
