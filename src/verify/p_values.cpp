#include "verify/p_values.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>

#include "core/error.h"

namespace mote {

namespace {

constexpr int64_t largest_exact_count = 100;

/// Square matrix, row-major.
struct Matrix {
    explicit Matrix(size_t matrix_size) : size(matrix_size), values(size * size) {}
    [[nodiscard]] double& at(size_t row, size_t column) { return values[row * size + column]; }
    [[nodiscard]] double at(size_t row, size_t column) const { return values[row * size + column]; }

    size_t size;
    std::vector<double> values;
};

Matrix multiply(const Matrix& a, const Matrix& b)
{
    Matrix product(a.size);
    for (size_t i = 0; i < a.size; ++i) {
        for (size_t k = 0; k < a.size; ++k) {
            for (size_t j = 0; j < a.size; ++j) product.at(i, j) += a.at(i, k) * b.at(k, j);
        }
    }
    return product;
}

/// Exponent >= 1.
Matrix power(const Matrix& base, int64_t exponent)
{
    if (exponent == 1) return base;
    const Matrix root = power(base, exponent / 2);
    Matrix result = multiply(root, root);
    return exponent % 2 == 1 ? multiply(result, base) : result;
}

/// Marsaglia, Tsang and Wang 2003. Entries stay below e^n, so doubles hold them up to n = 100.
double exact_kolmogorov_cdf(int64_t n, double distance)
{
    const double scaled = static_cast<double>(n) * distance;
    const auto k = static_cast<size_t>(scaled) + 1;
    const size_t m = 2 * k - 1;
    const double h = static_cast<double>(k) - scaled;
    Matrix matrix(m);
    for (size_t i = 0; i < m; ++i) {
        for (size_t j = 0; j < m; ++j) matrix.at(i, j) = i + 1 >= j ? 1.0 : 0.0;
    }
    for (size_t i = 0; i < m; ++i) {
        matrix.at(i, 0) -= std::pow(h, static_cast<double>(i + 1));
        matrix.at(m - 1, i) -= std::pow(h, static_cast<double>(m - i));
    }
    matrix.at(m - 1, 0) += std::pow(std::max(2.0 * h - 1.0, 0.0), static_cast<double>(m));
    for (size_t i = 0; i < m; ++i) {
        for (size_t j = 0; j <= i; ++j) {
            matrix.at(i, j) /= std::tgamma(static_cast<double>(i - j) + 2.0);
        }
    }
    double probability = power(matrix, n).at(k - 1, k - 1);
    for (int64_t i = 1; i <= n; ++i) probability *= static_cast<double>(i) / static_cast<double>(n);
    return std::clamp(probability, 0.0, 1.0);
}

double asymptotic_kolmogorov_cdf(int64_t n, double distance)
{
    const double root = std::sqrt(static_cast<double>(n));
    const double raw = root * distance;
    const double x = raw + 1.0 / (6.0 * root) + (raw - 1.0) / (4.0 * static_cast<double>(n));
    if (x < 0.2) return 0.0;  // below 1e-12, where the series converges badly
    double tail = 0.0;
    double sign = 1.0;
    for (int i = 1; i <= 30; ++i) {
        tail += sign * std::exp(-2.0 * i * i * x * x);
        sign = -sign;
    }
    return std::clamp(1.0 - 2.0 * tail, 0.0, 1.0);
}

}  // namespace

double sidak_p(double smallest, int64_t count)
{
    MOTE_ASSERT(count >= 1 && smallest >= 0.0 && smallest <= 1.0);
    return -std::expm1(static_cast<double>(count) * std::log1p(-smallest));
}

std::vector<double> holm_adjusted(std::span<const double> p_values)
{
    std::vector<size_t> order(p_values.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return p_values[a] < p_values[b]; });
    std::vector<double> adjusted(p_values.size());
    double largest = 0.0;
    for (size_t rank = 0; rank < order.size(); ++rank) {
        const auto still_tested = static_cast<double>(order.size() - rank);
        largest = std::max(largest, std::min(still_tested * p_values[order[rank]], 1.0));
        adjusted[order[rank]] = largest;
    }
    return adjusted;
}

double kolmogorov_cdf(int64_t n, double distance)
{
    MOTE_ASSERT(n >= 1);
    if (distance <= 0.0) return 0.0;
    if (distance >= 1.0) return 1.0;
    return n <= largest_exact_count ? exact_kolmogorov_cdf(n, distance)
                                    : asymptotic_kolmogorov_cdf(n, distance);
}

UniformityTest test_uniformity(std::span<const double> p_values)
{
    UniformityTest test;
    test.count = static_cast<int64_t>(p_values.size());
    if (test.count == 0) return test;
    std::vector<double> sorted(p_values.begin(), p_values.end());
    std::sort(sorted.begin(), sorted.end());
    const auto n = static_cast<double>(sorted.size());
    for (size_t i = 0; i < sorted.size(); ++i) {
        const double below = static_cast<double>(i) / n;
        const double up_to = static_cast<double>(i + 1) / n;
        test.distance = std::max({test.distance, sorted[i] - below, up_to - sorted[i]});
    }
    test.p = 1.0 - kolmogorov_cdf(test.count, test.distance);
    return test;
}

std::vector<int64_t> histogram(std::span<const double> p_values, int bins)
{
    MOTE_ASSERT(bins >= 1);
    std::vector<int64_t> counts(static_cast<size_t>(bins));
    for (const double p : p_values) {
        const auto bin = static_cast<int>(p * bins);
        ++counts[static_cast<size_t>(std::clamp(bin, 0, bins - 1))];
    }
    return counts;
}

double binomial_upper_limit(int64_t count, int64_t trials, double confidence)
{
    MOTE_ASSERT(trials >= 1 && count >= 0 && count <= trials);
    if (count == trials) return 1.0;
    const boost::math::beta_distribution<> rate(static_cast<double>(count + 1),
                                                static_cast<double>(trials - count));
    return boost::math::quantile(rate, confidence);
}

int64_t binomial_bound(int64_t trials, double rate, double false_alarm)
{
    MOTE_ASSERT(trials >= 1 && rate >= 0.0 && rate <= 1.0);
    const boost::math::binomial_distribution<> events(static_cast<double>(trials), rate);
    int64_t bound = 0;
    while (bound < trials && boost::math::cdf(boost::math::complement(
                                 events, static_cast<double>(bound))) > false_alarm) {
        ++bound;
    }
    return bound;
}

}  // namespace mote
