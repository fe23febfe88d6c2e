#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>

#include "restir/candidates.h"
#include "restir/direction_hits.h"
#include "restir/domains.h"
#include "restir/mixed_phase.h"
#include "support/chi_squared.h"
#include "support/trials.h"

namespace mote {
namespace {

using test::TestScene;

/// Lights of every kind in and around two overlapping media.
TestScene all_lights()
{
    TestScene test = test::everything_at_once();
    test.scene.lights.push_back(PointLight{{1.2f, 0.9f, 0.8f}, {0.5f, 1.0f, 0.5f}});
    test.scene.lights.push_back(SphereLight{{-0.7f, 0.9f, 0.8f}, 0.3f, {2.0f, 1.0f, 0.5f}});
    return test;
}

/// A weighted domain of the ray through the middle of the film.
PixelDomain middle_domain(const FrameDomain& frame)
{
    const Camera& camera = frame.scene->camera;
    const Vec2 film = 0.5f * Vec2(camera.width, camera.height);
    PixelDomain domain;
    BinCounts counts;
    make_pixel_domain(frame, generate_ray(camera, film, Vec2(0.5f), 0.5f), domain, counts);
    weigh_bins(frame, domain);
    return domain;
}

TEST(Candidates, ProbabilitiesOfLightsSumToOneAndAreThoseOfTheChoice)
{
    for (const bool control_variate : {false, true}) {
        const TestScene test = all_lights();
        RestirParams params;
        params.control_variate = control_variate;
        const FrameDomain frame = test::make_domain(test.scene, params);
        for (uint32_t i = 0; i < 50; ++i) {
            Rng rng(21, 0, Stream::Test, i, 0);
            const Vec3 x = 2.0f * rng.uniform3() - 1.0f;
            const Vec3 wo(0.0f, 0.0f, 1.0f);
            double sum = 0.0;
            for (size_t light = 0; light < frame.lights.size(); ++light) {
                sum += static_cast<double>(light_pmf(frame, static_cast<int>(light), x, wo));
            }
            ASSERT_NEAR(sum, 1.0, 1e-5);
            for (int k = 0; k < 20; ++k) {
                const SampledChoice choice = choose_light(frame, x, wo, uniform_double(rng));
                ASSERT_GE(choice.light, 0);
                const float pmf = light_pmf(frame, choice.light, x, wo);
                EXPECT_GT(pmf, 0.0f);
                EXPECT_NEAR(choice.pmf, pmf, 1e-5f * pmf);
            }
        }
    }
}

/// z of how often draw_candidates chooses each lamp, against the probability it claims. Events lie
/// within a few millimetres, so that this hardly depends on them; what it does is weighted out.
double choice_z(int lamps, int count, int draws)
{
    TestScene test = test::many_lamps(lamps);
    Volume& volume = test.scene.media.volumes[0];
    volume.world_from_object.keys[0].scale = Vec3d(1e-3);
    volume.density_scale = 1e3f;
    finalize(volume);
    test.scene.camera = test::small_camera({0.0f, 0.0f, 3.2e-3f});
    const FrameDomain frame = test::make_domain(test.scene);
    const PixelDomain domain = middle_domain(frame);
    const Vec3 x = point_at(frame, domain, 0.5f).x;
    std::vector<double> share;
    for (size_t light = 0; light < frame.lights.size(); ++light) {
        const float pmf = light_pmf(frame, static_cast<int>(light), x, domain.wo());
        share.push_back(static_cast<double>(pmf) * count);
    }
    std::vector<double> observed(share.size(), 0.0);
    std::vector<Candidate> candidates;
    for (int i = 0; i < draws; ++i) {
        candidates.clear();
        Rng rng(23, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        draw_candidates(frame, domain, count, rng, candidates);
        for (const Candidate& c : candidates) {
            const auto light = static_cast<size_t>(c.y.light);
            observed[light] += share[light] / static_cast<double>(c.density);
        }
    }
    std::vector<double> expected;
    for (const double s : share) expected.push_back(s * draws);
    return test::chi_squared_z(observed, expected);
}

TEST(CandidatesStat, LightsAreChosenAsOftenAsTheirProbabilitySays)
{
    // |z| > 5: a false alarm in 800,000 seeds for both.
    EXPECT_LT(std::abs(choice_z(10, 8, 5000)), 5.0);
    EXPECT_LT(std::abs(choice_z(8000, 8, 20'000)), 5.0);
}

TEST(CandidatesLong, ManyCandidatesStepFarThroughManyLights)
{
    // The choices of one draw have fixed distances, so that z spreads more widely than a standard
    // normal: some 3 instead of 1. Steps in single precision gave 26.
    if (!std::getenv("MOTE_LONG_TESTS")) GTEST_SKIP() << "MOTE_LONG_TESTS is not set";
    EXPECT_LT(choice_z(40'000, 256, 4000), 15.0);
}

TEST(Candidates, EvaluatingTheirNumbersGivesTheSameAgain)
{
    for (const bool control_variate : {false, true}) {
        const TestScene test = all_lights();
        RestirParams params;
        params.control_variate = control_variate;
        const FrameDomain frame = test::make_domain(test.scene, params);
        std::map<SampledLightKind, int> seen;
        std::vector<Candidate> candidates;
        for (uint32_t i = 0; i < 100; ++i) {
            Rng rng(22, 0, Stream::Test, i, 0);
            PixelDomain domain;
            BinCounts counts;
            make_pixel_domain(frame, test::random_ray(test.scene.camera, rng), domain, counts);
            weigh_bins(frame, domain);
            candidates.clear();
            draw_candidates(frame, domain, 8, rng, candidates);
            EXPECT_LE(candidates.size(), 8u * (1u + frame.lights.size()));
            for (const Candidate& c : candidates) {
                ++seen[frame.lights[static_cast<size_t>(c.y.light)].kind];
                EXPECT_GT(c.density, 0.0f);
                EXPECT_TRUE(std::isfinite(c.density));
                EXPECT_TRUE(is_finite(c.f));
                const Candidate again = evaluate(frame, domain, c.y);
                EXPECT_EQ(again.x, c.x);
                // Points on quads that a phase direction met go through their two numbers.
                EXPECT_LT(glm::length(again.arrival.wi - c.arrival.wi), 1e-5f);
                EXPECT_LT(glm::length(again.f - c.f), 1e-4f * glm::length(c.f));
            }
        }
        for (const SampledLightKind kind :
             {SampledLightKind::Lamp, SampledLightKind::EmissiveVolume}) {
            EXPECT_GT(seen[kind], 20);
        }
        for (const SampledLightKind kind :
             {SampledLightKind::Distant, SampledLightKind::Environment}) {
            EXPECT_EQ(seen[kind] > 20, !control_variate);
        }
    }
}

TEST(Candidates, NonsenseBringsNothing)
{
    const TestScene test = all_lights();
    const FrameDomain frame = test::make_domain(test.scene);
    const PixelDomain domain = middle_domain(frame);
    const float bad = std::numeric_limits<float>::quiet_NaN();
    const auto count = static_cast<int>(frame.lights.size());
    for (const PathSample& y :
         {PathSample{0.5f, -1, Vec3(0.5f)}, PathSample{0.5f, count, Vec3(0.5f)},
          PathSample{0.5f, 1, Vec3(bad)}, PathSample{0.5f, 2, Vec3(bad)},
          PathSample{0.5f, count - 1, Vec3(bad)}, PathSample{0.5f, count - 2, Vec3(bad)}}) {
        EXPECT_TRUE(is_finite(evaluate(frame, domain, y).f)) << y.light;
    }
    PixelDomain empty;
    BinCounts counts;
    make_pixel_domain(frame, Ray{{0.0f, 9.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 0.0f}, empty, counts);
    std::vector<Candidate> candidates;
    Rng rng(1, 0, Stream::Test, 0, 0);
    draw_candidates(frame, empty, 8, rng, candidates);
    EXPECT_TRUE(candidates.empty());
    EXPECT_EQ(evaluate(frame, empty, {0.5f, 0, Vec3(0.5f)}).f, Spectrum(0.0f));
}

TEST(CandidatesStat, DirectionsHaveTheirDensity)
{
    // The mean of 1 / density over hits is the size of what can be met: 4 pi for the environment,
    // 1 for the two numbers of a quad or a sphere, the glowing volume within reach. 5 standard
    // errors.
    const TestScene test = all_lights();
    const FrameDomain frame = test::candidates_domain(test.scene);
    const Vec3 x(0.1f, 0.0f, 0.1f);
    const Vec3 wo = glm::normalize(Vec3(0.5f, 0.4f, 3.2f));
    const MixedPhase phase = mixed_phase_at(frame.scene->media, x, 0.5f);
    std::set<int> lights;
    for (size_t i = 0; i < frame.lights.size(); ++i) {
        const SampledLightKind kind = frame.lights[i].kind;
        const bool is_found = kind != SampledLightKind::Distant &&
                              (kind != SampledLightKind::Lamp ||
                               !std::holds_alternative<PointLight>(test.scene.lights[i]));
        if (is_found) lights.insert(static_cast<int>(i));
    }
    ASSERT_FALSE(lights.empty());
    for (const int light : lights) {
        const RunningStats stats = test::run_trials(60'000, 25, [&](Rng& rng) {
            double sum = 0.0;
            const float choice = rng.uniform();
            const Vec3 wi = phase.sample(wo, choice, rng.uniform2());
            const float pdf_dir = phase.pdf(wo, wi);
            for_each_light_along(
                frame, frame.bsdf_finds, {x, wi, 0.5f}, rng.uniform(),
                [&](const DirectionHit& hit) {
                    if (hit.light != light || !(max_component(hit.arrival.L) > 0.0f)) return;
                    sum += 1.0 / static_cast<double>(pdf_dir * hit.per_direction);
                });
            return sum;
        });
        double exact = 1.0;
        const SampledLight& sampled = frame.lights[static_cast<size_t>(light)];
        if (sampled.kind == SampledLightKind::Environment) exact = 4.0 * static_cast<double>(pi);
        if (sampled.kind == SampledLightKind::EmissiveVolume) {
            const Volume& volume = test.scene.media.volumes[static_cast<size_t>(sampled.index)];
            const Bounds3 box = world_bounds(volume);
            const Vec3 e = box.extent();
            const RunningStats share = test::run_trials(200'000, 26, [&](Rng& rng) {
                const Vec3 p = box.lo + e * rng.uniform3();
                const float j = max_component(emission_at(volume, object_point(volume, p, 0.5f)));
                return j > 0.0f ? 1.0 : 0.0;
            });
            exact = share.mean * static_cast<double>(e.x * e.y * e.z);
        }
        EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 0.005 * exact)
            << light << ": " << stats.mean << " +- " << stats.standard_error() << ", exact "
            << exact;
        EXPECT_LT(stats.standard_error(), 0.05 * exact);
    }
}

}  // namespace
}  // namespace mote
