#include <gtest/gtest.h>

#include "restir/domains.h"
#include "restir/emission_along.h"
#include "support/trials.h"
#include "volumes/emission.h"

namespace mote {
namespace {

PixelDomain binned(const FrameDomain& frame, const Ray& ray)
{
    PixelDomain domain;
    BinCounts counts;
    make_pixel_domain(frame, ray, domain, counts);
    return domain;
}

/// The camera's emitted light by a midpoint rule of many steps and exact transmittances.
double quadrature(const FrameDomain& frame, const PixelDomain& domain)
{
    constexpr int steps = 20'000;
    constexpr float reach = 8.0f;
    const Media& media = frame.scene->media;
    double sum = 0.0;
    double depth = 0.0;
    for (int i = 0; i < steps; ++i) {
        const float t = (static_cast<float>(i) + 0.5f) * (reach / steps);
        const Vec3 x = domain.ray.at(t);
        const double own = static_cast<double>(sigma_t_at(media, x, domain.ray.time)) *
                           static_cast<double>(reach / steps);
        Spectrum j(0.0f);
        for (const Volume& volume : media.volumes) {
            j += emission_at(volume, object_point(volume, x, domain.ray.time));
        }
        sum += std::exp(-depth - 0.5 * own) * static_cast<double>(luminance(j)) *
               static_cast<double>(reach / steps);
        depth += own;
    }
    return sum;
}

/// Through the flame, dx metres from its centre.
Ray flame_ray(float dx)
{
    const Vec3 eye(0.5f, 0.4f, 3.2f);
    return {eye, glm::normalize(Vec3(0.2f + dx, -0.6f, 0.1f) - eye), 0.0f};
}

TEST(EmissionAlongStat, IsTheIntegralForOneAndSeveralMedia)
{
    // 5 standard errors and 0.3 % for the quadrature.
    test::TestScene both = test::flame_in_smoke();
    test::TestScene alone = both;
    alone.scene.media.volumes.erase(alone.scene.media.volumes.begin());
    for (const test::TestScene* test : {&both, &alone}) {
        const FrameDomain frame = test::make_domain(test->scene);
        double seen = 0.0;
        for (const float dx : {-0.2f, 0.0f, 0.2f}) {
            const PixelDomain domain = binned(frame, flame_ray(dx));
            const double exact = quadrature(frame, domain);
            const RunningStats stats = test::run_trials(
                2000, 31, [&](Rng& rng) { return luminance(emission_along(frame, domain, rng)); });
            EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 3e-3 * exact)
                << dx << ": " << stats.mean << ", exact " << exact;
            // An estimate that is wrong by 2 % would be noticed.
            EXPECT_LE(5.0 * stats.standard_error() + 3e-3 * exact, 0.02 * exact);
            // One sample is good to a tenth.
            EXPECT_LT(stats.standard_error() * std::sqrt(2000.0), 0.1 * exact + 1e-6);
            seen += exact;
        }
        EXPECT_GT(seen, 0.0);
    }
}

TEST(EmissionAlong, AConstantSourceMakesNoNoise)
{
    test::TestScene test = test::flame_in_smoke();
    test.scene.media.volumes.erase(test.scene.media.volumes.begin());
    Volume& volume = test.scene.media.volumes.front();
    volume.temperature = nullptr;
    volume.emission = nullptr;
    volume.emission_params = {};
    volume.emission_params.blackbody_scale = 0.7f;
    volume.emission_params.temperature_offset = 2000.0f;
    const FrameDomain frame = test::make_domain(test.scene);
    const PixelDomain domain = binned(frame, flame_ray(0.0f));
    ASSERT_GT(domain.bins.depth(), 0.1f);
    const Spectrum expected =
        (1.0f - std::exp(-domain.bins.depth())) * source_at(volume, Vec3(0.0f));
    for (uint32_t i = 0; i < 10; ++i) {
        Rng rng(i, 0, Stream::Test, 0, 0);
        const Spectrum L = emission_along(frame, domain, rng);
        EXPECT_LT(glm::length(L - expected), 1e-5f * glm::length(expected));
    }
}

}  // namespace
}  // namespace mote
