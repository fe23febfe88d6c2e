#include <gtest/gtest.h>

#include <vector>

#include "core/sampling.h"
#include "support/trials.h"
#include "volumes/phase.h"

namespace mote {
namespace {

const Phase phases[] = {{0.0f, 0.0f, 0.0f},  {0.6f, 0.0f, 0.0f},   {-0.6f, 0.0f, 0.0f},
                        {0.95f, 0.0f, 0.0f}, {0.999f, 0.0f, 0.0f}, {-0.999f, 0.0f, 0.0f},
                        {1e-4f, 0.0f, 0.0f}, {0.8f, -0.3f, 0.25f}, {0.9f, -0.5f, 0.5f}};

double mean_cosine(const Phase& phase)
{
    const double b = static_cast<double>(phase.weight_b);
    return (1.0 - b) * static_cast<double>(phase.g) + b * static_cast<double>(phase.g_b);
}

/// Phase function in terms of the scattering angle, wo along -z so that +1 continues along +z.
double eval_at(const Phase& phase, double cos_theta)
{
    const Vec3 wo(0.0f, 0.0f, -1.0f);
    const float z = static_cast<float>(cos_theta);
    const Vec3 wi(std::sqrt(std::max(0.0f, 1.0f - z * z)), 0.0f, z);
    return static_cast<double>(eval_phase(phase, wo, wi));
}

TEST(Phase, IntegratesToOneAndTheMeanCosineIsG)
{
    for (const Phase& phase : phases) {
        // Midpoints in u = (1 - cos)^(1/4) from either end, where the lobes peak: 200000 points.
        double sum = 0.0;
        double cosine = 0.0;
        constexpr int n = 100'000;
        for (int i = 0; i < n; ++i) {
            const double u = (i + 0.5) / n;
            const double away = u * u * u * u;  // 1 - |cos|, in (0,1)
            const double weight = 4.0 * u * u * u / n * 2.0 * 3.14159265358979;
            for (const double sign : {-1.0, 1.0}) {
                const double f = weight * eval_at(phase, sign * (1.0 - away));
                sum += f;
                cosine += f * sign * (1.0 - away);
            }
        }
        // Floats resolve 1 - cos to 6e-8 near the peaks; at |g| = 0.999 the lobe is 5e-7 wide.
        const double tolerance = std::abs(phase.g) > 0.99f ? 3e-2 : 2e-5;
        EXPECT_NEAR(sum, 1.0, tolerance) << phase.g;
        EXPECT_NEAR(cosine, mean_cosine(phase), tolerance) << phase.g;
    }
}

TEST(Phase, HenyeyGreensteinKeepsItsPeakAtExtremeG)
{
    // The closed form at cos = 1 is (1 + g) / (4 pi (1 - g)^2); at g = 0.999 in floats.
    for (const float g : {0.5f, 0.9f, 0.99f, 0.999f}) {
        const double exact = (1.0 + static_cast<double>(g)) /
                             (4.0 * 3.14159265358979 * std::pow(1.0 - static_cast<double>(g), 2));
        EXPECT_NEAR(static_cast<double>(eval_hg(1.0f, g)) / exact, 1.0, 1e-3);
        EXPECT_GT(eval_hg(-1.0f, g), 0.0f);
    }
}

TEST(PhaseStat, SampledDirectionsHaveMeanCosineG)
{
    const Vec3 wo = glm::normalize(Vec3(0.3f, -0.5f, 0.8f));
    for (const Phase& phase : phases) {
        const RunningStats stats = test::run_trials(200'000, 3, [&](Rng& rng) {
            const Vec3 wi = sample_phase(phase, wo, rng.uniform2());
            EXPECT_NEAR(glm::length(wi), 1.0f, 1e-5f);
            return -glm::dot(wo, wi);
        });
        // 5 standard errors: false alarm once in 1.7 million seeds per phase; 2e-6 for floats.
        EXPECT_NEAR(stats.mean, mean_cosine(phase), 5.0 * stats.standard_error() + 2e-6) << phase.g;
    }
}

/// Cosine of the angle to +z of a unit vector, from its distance off the axis: near the axis z
/// itself is rounded to 6e-8, as wide as a bin at g = 0.999, but x and y are not.
double fine_cosine(Vec3 v)
{
    const Vec3d d(v);
    const double off_axis = (d.x * d.x + d.y * d.y) / (1.0 + std::abs(d.z));
    return std::copysign(1.0 - off_axis, d.z);
}

/// Chi-squared statistic of samples against the phase function over cos x azimuth bins, as a
/// standard score. Cosine bins are quantiles of the phase itself, so that none is thin.
double chi_squared_score(const Phase& drawn, const Phase& expected)
{
    constexpr int cos_bins = 20;
    constexpr int azimuth_bins = 12;
    constexpr int count = 400'000;
    // The distribution function of cos, by fine midpoints that crowd both ends.
    std::vector<double> edges{-1.0};
    std::vector<double> mass;
    double running = 0.0;
    constexpr int n = 400'000;
    double previous = -1.0;
    double since_edge = 0.0;
    const auto map = [](double u) {  // smooth map of [0,1] to [-1,1], dense at the ends
        const double v = 2.0 * u - 1.0;
        return (v < 0.0 ? -1.0 : 1.0) * (1.0 - std::pow(1.0 - std::abs(v), 4.0));
    };
    for (int i = 1; i <= n; ++i) {
        const double cos_theta = map(static_cast<double>(i) / n);
        const double middle = 0.5 * (previous + cos_theta);
        since_edge += 2.0 * 3.14159265358979 * (cos_theta - previous) * eval_at(expected, middle);
        previous = cos_theta;
        if (since_edge >= 1.0 / cos_bins || i == n) {
            edges.push_back(cos_theta);
            mass.push_back(since_edge);
            running += since_edge;
            since_edge = 0.0;
        }
    }
    for (double& m : mass) m /= running;
    std::vector<double> observed(mass.size() * azimuth_bins, 0.0);
    const Vec3 wo = glm::normalize(Vec3(-0.2f, 0.9f, 0.4f));
    const Mat3 frame = make_frame(-wo);
    for (uint32_t i = 0; i < count; ++i) {
        Rng rng(17, 0, Stream::Test, i, 0);
        const Vec3 local = glm::transpose(frame) * sample_phase(drawn, wo, rng.uniform2());
        const auto at = std::upper_bound(edges.begin() + 1, edges.end() - 1, fine_cosine(local));
        const auto row = static_cast<size_t>(at - edges.begin() - 1);
        const float turn = std::atan2(local.y, local.x) / (2.0f * pi) + 0.5f;
        const auto column = std::min(static_cast<size_t>(turn * azimuth_bins),
                                     static_cast<size_t>(azimuth_bins - 1));
        observed[row * azimuth_bins + column] += 1.0;
    }
    double chi2 = 0.0;
    for (size_t i = 0; i < observed.size(); ++i) {
        const double mean = count * mass[i / azimuth_bins] / azimuth_bins;
        if (mean < 5.0) continue;
        chi2 += (observed[i] - mean) * (observed[i] - mean) / mean;
    }
    const double freedom = static_cast<double>(observed.size() - 1);
    // Wilson and Hilferty 1931: (chi2 / k)^(1/3) is close to normal.
    const double spread = 2.0 / (9.0 * freedom);
    return (std::cbrt(chi2 / freedom) - (1.0 - spread)) / std::sqrt(spread);
}

TEST(PhaseStat, SamplesFollowThePdf)
{
    for (const Phase& phase : phases) {
        EXPECT_LT(chi_squared_score(phase, phase), 4.5) << phase.g;  // once in 300,000 seeds
    }
}

TEST(PhaseStat, NegativeControlAWrongLobeIsFound)
{
    EXPECT_GT(chi_squared_score({0.61f, 0.0f, 0.0f}, {0.6f, 0.0f, 0.0f}), 4.5);
    EXPECT_GT(chi_squared_score({-0.6f, 0.0f, 0.0f}, {0.6f, 0.0f, 0.0f}), 4.5);
    EXPECT_GT(chi_squared_score({0.99897f, 0.0f, 0.0f}, {0.999f, 0.0f, 0.0f}), 4.5);
}

TEST(Phase, IsReciprocalAndSamplesAreNeverNan)
{
    for (const Phase& phase : phases) {
        for (uint32_t i = 0; i < 2000; ++i) {
            Rng rng(23, 0, Stream::Test, i, 0);
            const Vec3 wo = sample_sphere(rng.uniform2());
            const Vec3 wi = sample_sphere(rng.uniform2());
            EXPECT_EQ(eval_phase(phase, wo, wi), eval_phase(phase, wi, wo));
            EXPECT_EQ(eval_phase(phase, wo, wi), phase_pdf(phase, wo, wi));
            for (const Vec2& u : {Vec2(0.0f), Vec2(one_minus_epsilon), Vec2(0.0f, 0.5f)}) {
                const Vec3 sampled = sample_phase(phase, wo, u);
                EXPECT_TRUE(is_finite(sampled));
                EXPECT_GT(phase_pdf(phase, wo, sampled), 0.0f);
            }
        }
    }
}

}  // namespace
}  // namespace mote
