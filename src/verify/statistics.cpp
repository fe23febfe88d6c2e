#include "verify/statistics.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "core/error.h"
#include "core/math.h"

namespace mote {

namespace {

bool is_known(const MeanEstimate& e)
{
    return std::isfinite(e.mean) && std::isfinite(e.variance) && e.freedom > 0.0;
}

/// Probability that Student's t exceeds x.
double upper_tail(double x, double freedom)
{
    if (std::isinf(x)) return x > 0.0 ? 0.0 : 1.0;
    return boost::math::cdf(boost::math::complement(boost::math::students_t(freedom), x));
}

/// The t that is exceeded with probability p.
double upper_quantile(double p, double freedom)
{
    return boost::math::quantile(boost::math::complement(boost::math::students_t(freedom), p));
}

/// x / error, where exact values (error 0) are certainly above, below or at 0.
double standardised(double x, double error)
{
    if (error > 0.0) return x / error;
    return x == 0.0 ? 0.0 : std::copysign(infinity, x);
}

/// p-value of "true mean <= 0", the evidence that the mean is positive.
double p_not_positive(const MeanEstimate& e)
{
    if (!is_known(e)) return 1.0;
    // A mean that is exactly 0 is not positive.
    if (e.variance == 0.0) return e.mean > 0.0 ? 0.0 : 1.0;
    return upper_tail(e.mean / e.standard_error(), e.freedom);
}

/// Probability that a two-sided t-test with this critical value rejects, for a true mean of
/// `shift` standard errors.
double power_of(double shift, double critical, double freedom)
{
    const boost::math::non_central_t distribution(freedom, shift);
    return boost::math::cdf(boost::math::complement(distribution, critical)) +
           boost::math::cdf(distribution, -critical);
}

}  // namespace

MeanEstimate estimate_mean(const RunningStats& runs)
{
    if (runs.count < 2) return {runs.mean, infinity, 0.0};
    return {runs.mean, runs.variance_of_mean(), static_cast<double>(runs.count - 1)};
}

MeanEstimate combine(const MeanEstimate& a, double weight_a, const MeanEstimate& b, double weight_b)
{
    const double mean = weight_a * a.mean + weight_b * b.mean;
    if (!is_known(a) || !is_known(b)) return {mean, infinity, 0.0};
    const double variance_a = weight_a * weight_a * a.variance;
    const double variance_b = weight_b * weight_b * b.variance;
    const double variance = variance_a + variance_b;
    if (variance == 0.0) return {mean, 0.0, a.freedom + b.freedom};
    // Shares instead of squares of variances, which would underflow for dark pixels.
    const double share_a = variance_a / variance;
    const double share_b = variance_b / variance;
    const double spread = share_a * share_a / a.freedom + share_b * share_b / b.freedom;
    return {mean, variance, 1.0 / spread};
}

TestResult test_zero(const MeanEstimate& difference, double tolerance)
{
    MOTE_ASSERT(tolerance >= 0.0);
    TestResult result;
    result.difference = difference;
    if (!is_known(difference)) return result;
    const double error = difference.standard_error();
    result.t = standardised(difference.mean, error);
    const double excess = std::max(std::abs(difference.mean) - tolerance, 0.0);
    result.p = std::min(2.0 * upper_tail(standardised(excess, error), difference.freedom), 1.0);
    return result;
}

TestResult welch_test(const MeanEstimate& a, const MeanEstimate& b, double tolerance)
{
    return test_zero(combine(a, 1.0, b, -1.0), tolerance);
}

double equivalence_p(const MeanEstimate& difference, double budget)
{
    MOTE_ASSERT(budget > 0.0);
    MeanEstimate above_lower_end = difference;
    above_lower_end.mean = budget + difference.mean;
    MeanEstimate below_upper_end = difference;
    below_upper_end.mean = budget - difference.mean;
    return std::max(p_not_positive(above_lower_end), p_not_positive(below_upper_end));
}

double ratio_equivalence_p(const MeanEstimate& a, const MeanEstimate& b, double budget)
{
    MOTE_ASSERT(budget > 0.0 && budget < 1.0);
    // 1 - budget < a/b < 1 + budget, without dividing by the uncertain b. Both together hold only
    // for positive b.
    return std::max(p_not_positive(combine(a, 1.0, b, budget - 1.0)),
                    p_not_positive(combine(a, -1.0, b, 1.0 + budget)));
}

ConfidenceInterval confidence_interval(const MeanEstimate& mean, double confidence)
{
    MOTE_ASSERT(confidence > 0.0 && confidence < 1.0);
    if (!is_known(mean)) return {-infinity, infinity};
    const double half_width =
        upper_quantile(0.5 * (1.0 - confidence), mean.freedom) * mean.standard_error();
    return {mean.mean - half_width, mean.mean + half_width};
}

ConfidenceInterval ratio_interval(const MeanEstimate& a, const MeanEstimate& b, double confidence)
{
    MOTE_ASSERT(confidence > 0.0 && confidence < 1.0);
    if (b.mean == 0.0) return {-infinity, infinity};
    const MeanEstimate residual = combine(a, 1.0, b, -a.mean / b.mean);
    if (!is_known(residual)) return {-infinity, infinity};
    // All r with (a - r b)^2 <= q^2 (var_a + r^2 var_b): a quadratic inequality in r.
    const double q = upper_quantile(0.5 * (1.0 - confidence), residual.freedom);
    const double denominator = b.mean * b.mean - q * q * b.variance;
    if (!(denominator > 0.0)) return {-infinity, infinity};
    const double product = a.mean * b.mean;
    const double constant = a.mean * a.mean - q * q * a.variance;
    const double root = std::sqrt(std::max(product * product - denominator * constant, 0.0));
    return {(product - root) / denominator, (product + root) / denominator};
}

double smallest_detectable_bias(const MeanEstimate& difference, double significance, double power)
{
    MOTE_ASSERT(significance > 0.0 && significance < 1.0 && power > significance && power < 1.0);
    if (!is_known(difference)) return infinity;
    const double freedom = difference.freedom;
    const double critical = upper_quantile(0.5 * significance, freedom);
    // Next to so large a threshold (a few runs, a tiny significance) the noise of the mean itself
    // is nothing beside that of its estimated error, and the noncentral t fails to evaluate.
    if (critical > 1000.0) {
        const double chi_squared = boost::math::quantile(boost::math::chi_squared(freedom), power);
        return critical * std::sqrt(chi_squared / freedom) * difference.standard_error();
    }
    double low = 0.0;
    double high = critical;
    while (power_of(high, critical, freedom) < power) high *= 2.0;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (power_of(middle, critical, freedom) < power ? low : high) = middle;
    }
    return high * difference.standard_error();
}

}  // namespace mote
