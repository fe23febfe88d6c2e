// Walks that aim at distant lights, against walks that do not; and wrong ways to aim, which the
// same test must find out.

#include <gtest/gtest.h>

#include "multiscatter/batches.h"
#include "multiscatter/constant_guess.h"
#include "reference/direct_light.h"
#include "reference/path_tracer.h"
#include "reference/trace_segment.h"
#include "restir/room_scenes.h"

namespace mote {
namespace {

constexpr double alarm = 1e-5;  // false alarms, each comparison

enum class Mistake {
    None,
    NoWeight,         ///< light that was sought counts in full where rays come upon it as well
    ForgottenChance,  ///< weights take every event to have sought
    OneEventTooMany   ///< the last event seeks, too
};

Scene forward_cloud(float g = 0.85f)
{
    Scene scene = test::sun_and_sky(8.0f).scene;
    scene.media.volumes[0].phase = {g};
    return scene;
}

/// An event in a scene, seen along with the sun nearly behind it.
struct Setting {
    Scene scene;
    PathTracerParams path;
    LightSampler lights;
    AimedLights aims;
    ScatterEvent event;

    Setting(Scene s, int max_bounces)
        : scene(std::move(s)),
          path{.max_bounces = max_bounces},
          lights(scene, path),
          aims(find_aimed_lights(scene)),
          event{Vec3(0.1f, 0.05f, 0.2f), glm::normalize(Vec3(-0.4f, -0.6f, 0.3f)), 0.0f,
                &scene.media.volumes[0].phase}
    {
    }

    [[nodiscard]] MeanEstimate mean(const ShadowGuess* guess, bool aim, uint32_t seed) const
    {
        const TraceContext context{scene, lights, path, guess, nullptr, aim ? &aims : nullptr};
        return test::mean_of({32, 1500}, seed, [&](Rng& rng) {
            return trace_after_event(context, event, rng).indirect;
        });
    }

    /// Light of the second event, put together by hand.
    [[nodiscard]] Spectrum second_event(Mistake mistake, Rng& rng) const
    {
        const TraceContext context{scene, lights, path, nullptr, nullptr, &aims};
        Aim aim = aim_at_lights(context, event);
        for (float& q : aim.q) q *= 0.1f;
        Spectrum sum = estimate_aimed_light(context, event, aim, rng);
        const ScatteredDirection s = *sample_scattering(event, rng);
        LightRay ray{Ray{event.x, s.wi, 0.0f}, s.scattering.pdf_dir, false};
        const TracedSegment segment = trace_segment(context, ray, false, rng);
        if (!segment.collision) return sum;
        const Collision& c = *segment.collision;
        const Volume& volume = scene.media.volumes[static_cast<size_t>(c.volume)];
        const Spectrum albedo = albedo_at(volume, c.p_object);
        const ScatterEvent second{ray.ray.at(c.t), -s.wi, 0.0f, &volume.phase};
        Aim before = aim;
        if (mistake == Mistake::NoWeight) before = {};
        if (mistake == Mistake::ForgottenChance) {
            for (float& q : before.q) q = 1.0f;
        }
        sum += albedo *
               estimate_direct_light_after(context, second, before, s.scattering.pdf_dir, rng);
        if (mistake == Mistake::OneEventTooMany) {
            sum +=
                albedo * estimate_aimed_light(context, second, aim_at_lights(context, second), rng);
        }
        return sum;
    }
};

TEST(AimedLightStat, AnyGuessOfShadowsLeavesTheMean)
{
    for (const int max_bounces : {2, 3, 50}) {
        const Setting setting(forward_cloud(), max_bounces);
        const MeanEstimate exact = setting.mean(nullptr, false, 1);
        EXPECT_GT(welch_test(setting.mean(nullptr, true, 2), exact).p, alarm) << max_bounces;
        uint32_t seed = 3;
        for (const float T : {0.0f, 0.7f, 1.0f, std::numeric_limits<float>::quiet_NaN()}) {
            const test::ConstantGuess guess(T);
            // As a guess of shadows themselves it would have to be finite.
            if (std::isfinite(T)) {
                EXPECT_GT(welch_test(setting.mean(&guess, true, seed++), exact).p, alarm) << T;
            } else {
                const TraceContext context{setting.scene, setting.lights, setting.path,
                                           &guess,        nullptr,        &setting.aims};
                const Aim aim = aim_at_lights(context, setting.event);
                EXPECT_TRUE(aim.q[0] >= 0.0f && aim.q[0] <= 1.0f);
            }
        }
    }
}

TEST(AimedLightStat, SeveralLightsAndMediaLeaveTheMean)
{
    Scene suns = test::two_suns().scene;
    suns.media.volumes[0].phase = {0.8f};
    suns.lights.emplace_back(suns.lights[0]);
    suns.lights.emplace_back(DistantLight{Vec3(0.0f, 1.0f, 0.0f), Spectrum(0.3f)});
    suns.lights.emplace_back(PointLight{Vec3(1.0f), Spectrum(1.0f)});
    Scene lobes = forward_cloud();
    lobes.media.volumes[0].phase = {-0.3f, 0.8f, 0.6f};
    Scene several = test::overlapping().scene;
    several.media.volumes[0].phase = {0.9f, -0.4f, 0.3f};
    for (Scene* scene : {&suns, &lobes, &several}) {
        const Setting setting(std::move(*scene), 4);
        EXPECT_GT(welch_test(setting.mean(nullptr, true, 2), setting.mean(nullptr, false, 1)).p,
                  alarm);
    }
}

TEST(AimedLightStat, SurfacesMayBeInTheWay)
{
    Scene scene = test::courtyard(true);
    scene.media.volumes[0].phase = {0.8f};
    const Setting setting(std::move(scene), 4);
    EXPECT_GT(welch_test(setting.mean(nullptr, true, 2), setting.mean(nullptr, false, 1)).p, alarm);
}

TEST(AimedLightStat, WrongWaysAreFoundOut)
{
    Scene scene = forward_cloud();
    scene.environment.reset();
    const Setting setting(std::move(scene), 2);
    const MeanEstimate exact = setting.mean(nullptr, false, 1);
    uint32_t seed = 2;
    const auto judge = [&](Mistake mistake) {
        const MeanEstimate found = test::mean_of(
            {32, 1500}, seed++, [&](Rng& rng) { return setting.second_event(mistake, rng); });
        return welch_test(found, exact).p;
    };
    EXPECT_GT(judge(Mistake::None), alarm);
    EXPECT_LT(judge(Mistake::NoWeight), alarm);
    EXPECT_LT(judge(Mistake::ForgottenChance), alarm);
    EXPECT_LT(judge(Mistake::OneEventTooMany), alarm);
}

/// What aiming is for. Bounds: measured a third; the negative control scatters too evenly to aim.
TEST(AimedLightStat, LessNoiseWhereMediaScatterForwards)
{
    const Setting forward(forward_cloud(), 50);
    EXPECT_LT(forward.mean(nullptr, true, 1).variance,
              0.7 * forward.mean(nullptr, false, 1).variance);
    const Setting even(forward_cloud(0.3f), 50);
    EXPECT_EQ(even.mean(nullptr, true, 1).variance, even.mean(nullptr, false, 1).variance);
}

TEST(AimedLights, AreTheBrightestDirections)
{
    Scene scene = forward_cloud();
    const Vec3 up(0.0f, 1.0f, 0.0f);
    const Vec3 left(-1.0f, 0.0f, 0.0f);
    scene.lights = {DistantLight{left, Spectrum(2.0f)}, PointLight{up, Spectrum(100.0f)},
                    DistantLight{up, Spectrum(1.5f)},   DistantLight{up, Spectrum(1.5f)},
                    DistantLight{-up, Spectrum(1.0f)},  DistantLight{-left, Spectrum(0.0f)}};
    const AimedLights aims = find_aimed_lights(scene);
    ASSERT_EQ(aims.count, 2);
    EXPECT_EQ(aims.direction[0], up);
    EXPECT_EQ(aims.irradiance[0], Spectrum(3.0f));
    EXPECT_EQ(aims.direction[1], left);
    EXPECT_FLOAT_EQ(aims.share[1], 2.0f / 3.0f);
    scene.lights.clear();
    EXPECT_EQ(find_aimed_lights(scene).count, 0);
}

}  // namespace
}  // namespace mote
