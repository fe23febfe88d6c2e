#include <gtest/gtest.h>

#include "multiscatter/batches.h"
#include "multiscatter/cached_shadows.h"
#include "multiscatter/constant_guess.h"
#include "reference/path_tracer.h"
#include "restir/room_scenes.h"

namespace mote {
namespace {

constexpr double alarm = 1e-5;

/// Mean of the light that an event scatters by way of others.
MeanEstimate mean_with(const Scene& scene, const ShadowGuess* guess, uint32_t seed)
{
    PathTracerParams path;
    path.max_bounces = 4;
    const LightSampler lights(scene, path);
    const TraceContext context{scene, lights, path, guess};
    const ScatterEvent event{Vec3(0.1f, 0.05f, 0.2f), glm::normalize(Vec3(0.4f, 0.3f, 3.0f)), 0.0f,
                             &scene.media.volumes[0].phase};
    return test::mean_of({32, 1500}, seed,
                         [&](Rng& rng) { return trace_after_event(context, event, rng).indirect; });
}

TEST(ShadowGuessStat, AnyGuessLeavesTheMean)
{
    const Scene scene = test::sun_and_sky().scene;
    const MeanEstimate exact = mean_with(scene, nullptr, 1);
    uint32_t seed = 2;
    for (const float T : {0.0f, 0.5f, 1.0f}) {
        const test::ConstantGuess guess(T);
        EXPECT_GT(welch_test(mean_with(scene, &guess, seed++), exact).p, alarm) << T;
    }
}

TEST(ShadowGuessStat, CachesLeaveTheMeanAndMakeLittleNoise)
{
    for (const Scene& scene : {test::sun_and_sky().scene, test::courtyard(false)}) {
        const auto caches = make_light_caches(scene, {}, nullptr);
        const CachedShadows guess(*caches);
        const MeanEstimate exact = mean_with(scene, nullptr, 1);
        const MeanEstimate guessed = mean_with(scene, &guess, 2);
        EXPECT_GT(welch_test(guessed, exact).p, alarm);
        EXPECT_LT(guessed.variance, 3.0 * exact.variance);
    }
}

TEST(CachedShadows, KnowDistantLightsAndTheSkyAndNothingElse)
{
    Scene scene = test::sun_and_sky().scene;
    const auto caches = make_light_caches(scene, {}, nullptr);
    const CachedShadows guess(*caches);
    const Vec3 x(0.1f, 0.0f, 0.1f);
    const Vec3 to_sun = std::get<DistantLight>(scene.lights[0]).direction;
    const float exact = std::exp(-optical_depth(scene.media, {x, to_sun}, {0.0f, infinity}));
    ASSERT_TRUE(guess.to_infinity(x, to_sun));
    EXPECT_NEAR(*guess.to_infinity(x, to_sun), exact, 0.1f);
    EXPECT_TRUE(guess.to_infinity(x, Vec3(0.0f, 1.0f, 0.0f)));
    scene.environment.reset();
    const auto sun_only = make_light_caches(scene, {}, nullptr);
    const CachedShadows sun_guess(*sun_only);
    EXPECT_FALSE(sun_guess.to_infinity(x, Vec3(0.0f, 1.0f, 0.0f)));
}

}  // namespace
}  // namespace mote
