// Places that are drawn around lamps beside those which paths find.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "multiscatter/gather_light.h"
#include "multiscatter/near_lamps.h"
#include "multiscatter/send_paths.h"
#include "multiscatter/sharing.h"

namespace mote {
namespace {

constexpr double alarm = 1e-5;  // false alarms, each comparison

/// Smoke with a small lamp in it, and first vertices beside the lamp.
struct LampInSmoke {
    Scene scene = test::sun_and_sky(8.0f).scene;
    PathTracerParams path{.max_bounces = 2};
    LightSampler lights;
    CoarseExtinction extinction;
    std::vector<PathVertex> first;

    explicit LampInSmoke(float radius)
    {
        scene.lights = {SphereLight{Vec3(0.1f, 0.2f, 0.0f), radius, Spectrum(1.0f / sqr(radius))}};
        scene.environment.reset();
        scene.media.volumes[0].phase = {0.3f};
        lights = LightSampler(scene, path);
        extinction = test::extinction_of(scene.media);
        first = test::first_vertices(scene, 16, 0.1f);
    }

    [[nodiscard]] TraceContext trace() const { return {scene, lights, path}; }

    [[nodiscard]] Spectrum alone(Rng& rng) const { return test::light_alone(trace(), first, rng); }

    /// `of_places`: their light, times as bright as it should be.
    [[nodiscard]] Spectrum shared(float near_share, Rng& rng, float of_places = 1.0f) const
    {
        WalkCounts counts;
        float cut = 0.0f;
        const TraceContext context = trace();
        const SharingContext sharing{context, extinction, 16, cache_time, counts, cut, near_share};
        PathLevel level;
        PathLevel next;
        level.vertices = first;
        send_paths(sharing, 1, true, level, next, rng);
        for (PathVertex& y : next.vertices) {
            if (y.goes_on) {
                follow_own_path(sharing, next.event(y, cache_time), 2, y, rng);
            } else {
                y.weight *= of_places;
            }
        }
        std::vector<Spectrum> light(1, Spectrum(0.0f));
        gather_light(sharing, level, next, rng, light);
        return light[0];
    }
};

TEST(NearLampsStat, BringWhatPathsOfTheirOwnBring)
{
    // A large lamp, as what is near a small one has heavy tails where it is not looked for.
    const LampInSmoke smoke(0.05f);
    const test::Batches batches{32, 400};
    const MeanEstimate expected =
        test::mean_of(batches, 1, [&](Rng& rng) { return smoke.alone(rng); });
    const auto p = [&](float near_share, float of_places) {
        const MeanEstimate found = test::mean_of(
            batches, 2, [&](Rng& rng) { return smoke.shared(near_share, rng, of_places); });
        return welch_test(found, expected).p;
    };
    EXPECT_GT(p(0.0f, 1.0f), alarm);
    EXPECT_GT(p(0.25f, 1.0f), alarm);
    EXPECT_GT(p(2.0f, 1.0f), alarm);
    // Negative controls: weights that do not sum to 1.
    EXPECT_LT(p(0.25f, 0.0f), alarm);
    EXPECT_LT(p(2.0f, 1.2f), alarm);
}

/// What they are for; seeds are fixed.
TEST(NearLamps, TakeMostOfTheNoiseAway)
{
    const LampInSmoke smoke(0.005f);
    const auto variance = [&](float near_share) {
        RunningStats stats;
        for (uint32_t i = 0; i < 2000; ++i) {
            Rng rng(1, i, Stream::Test, 0, 0);
            stats.add(static_cast<double>(luminance(smoke.shared(near_share, rng))));
        }
        return stats.variance();
    };
    EXPECT_LT(variance(0.25f), 0.25 * variance(0.0f));
}

/// One over their density, summed over all places, is the volume they are drawn in: 2000 rounds of
/// 16 places; one standard error is 0.5 %.
TEST(NearLampsStat, PlacesHaveTheirDensity)
{
    const LampInSmoke smoke(0.02f);
    const Vec3 center(0.1f, 0.05f, 0.1f);
    const float distance =
        glm::length(center - std::get<SphereLight>(smoke.scene.lights[0]).position);
    RunningStats volume;
    for (uint32_t i = 0; i < 2000; ++i) {
        Rng rng(1, i, Stream::Test, 0, 0);
        NearLamps near;
        near.choose(smoke.trace(), center, 0.0f, 16, rng);
        double sum = 0.0;
        int count = 0;
        near.for_each_point(rng, [&](Vec3 y) {
            sum += 1.0 / static_cast<double>(near.density(y));
            ++count;
        });
        EXPECT_EQ(count, 16);
        volume.add(sum);
    }
    const double outer = static_cast<double>(0.02f + distance);
    const double expected = 4.0 / 3.0 * std::numbers::pi * (std::pow(outer, 3) - std::pow(0.02, 3));
    EXPECT_NEAR(volume.mean, expected, 5.0 * volume.standard_error());
    EXPECT_LT(volume.standard_error(), 0.01 * expected);
}

TEST(NearLamps, NothingIsDrawnWhereLampsAreFarSmallOrNotThere)
{
    LampInSmoke smoke(0.02f);
    Rng rng(1, 0, Stream::Test, 0, 0);
    NearLamps near;
    const auto places = [&](Vec3 center, int count) {
        near.choose(smoke.trace(), center, 0.0f, count, rng);
        int drawn = 0;
        near.for_each_point(rng, [&](Vec3) { ++drawn; });
        return drawn;
    };
    EXPECT_EQ(places(Vec3(0.0f), 3), 3);
    EXPECT_EQ(places(Vec3(0.0f), 0), 0);
    EXPECT_EQ(near.density(Vec3(0.1f)), 0.0f);
    EXPECT_EQ(places(Vec3(0.1f, 0.2f, 0.0f), 8), 0) << "no room around it";
    EXPECT_TRUE(has_small_lamps(smoke.scene));
    smoke.scene.lights = {DistantLight{}};
    smoke.lights = LightSampler(smoke.scene, smoke.path);
    EXPECT_EQ(places(Vec3(0.0f), 8), 0);
    EXPECT_FALSE(has_small_lamps(smoke.scene));
}

}  // namespace
}  // namespace mote
