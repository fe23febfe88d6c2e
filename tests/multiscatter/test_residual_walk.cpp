// Residual walks over caches of any quality, against plain paths; and wrong ones, which the same
// test must find out.

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "core/sampling.h"
#include "multiscatter/batches.h"
#include "multiscatter/next_event.h"
#include "multiscatter/residual_walk.h"
#include "reference/path_tracer.h"
#include "restir/room_scenes.h"

namespace mote {
namespace {

constexpr double alarm = 1e-5;  // false alarms, each comparison

enum class Cache { Good, Empty, Garbage };

Scene cloud(Phase phase)
{
    Scene scene = test::sun_and_sky(8.0f).scene;
    scene.media.volumes[0].phase = phase;
    return scene;
}

/// An event in a scene, and caches for it.
struct Setting {
    Scene scene;
    PathTracerParams path;
    LightSampler lights;
    AimedLights aims;
    ScatterEvent event;
    RadianceCache cache;

    Setting(Scene s, int max_bounces, Cache kind = Cache::Good)
        : scene(std::move(s)),
          path{.max_bounces = max_bounces},
          lights(scene, path),
          aims(find_aimed_lights(scene)),
          event{Vec3(0.1f, 0.05f, 0.2f), glm::normalize(Vec3(-0.4f, -0.6f, 0.3f)), 0.0f,
                &scene.media.volumes[0].phase},
          cache(make_radiance_cache(context(), {kind == Cache::Good ? 64 : 1, 256, 1}))
    {
        if (kind == Cache::Good) return;
        Rng rng(7, 0, Stream::Test, 0, 0);
        for (RadianceCache::Node& node : cache.incident) {
            for (Spectrum& c : node) {
                c = kind == Cache::Empty ? Spectrum(0.0f) : 10.0f * rng.uniform3() - Vec3(2.0f);
            }
        }
    }
    Setting(const Setting&) = delete;
    Setting& operator=(const Setting&) = delete;

    [[nodiscard]] TraceContext context(bool aim = true) const
    {
        return {scene, lights, path, nullptr, nullptr, aim ? &aims : nullptr};
    }
    [[nodiscard]] MeanEstimate truth(const test::Batches& batches = {32, 600}) const
    {
        return test::mean_of(batches, 1, [&](Rng& rng) {
            return trace_after_event(context(false), event, rng).indirect;
        });
    }
    [[nodiscard]] MeanEstimate walks(const ResidualParams& params = {3, 2, 0.5f},
                                     const test::Batches& batches = {32, 300}) const
    {
        return test::mean_of(batches, 2, [&](Rng& rng) {
            return residual_light(context(), cache, params, event, rng).indirect;
        });
    }
    [[nodiscard]] double p(const ResidualParams& params = {3, 2, 0.5f}) const
    {
        return welch_test(walks(params), truth()).p;
    }
};

TEST(ResidualWalkStat, AnyCacheLeavesTheMean)
{
    for (const float g : {-0.4f, 0.0f, 0.85f}) {
        for (const int max_bounces : {2, 3, 20}) {
            const Setting good(cloud({g}), max_bounces);
            const Setting empty(cloud({g}), max_bounces, Cache::Empty);
            const Setting garbage(cloud({g}), max_bounces, Cache::Garbage);
            const MeanEstimate truth = good.truth();
            EXPECT_GT(welch_test(good.walks(), truth).p, alarm) << g << ' ' << max_bounces;
            EXPECT_GT(welch_test(empty.walks(), truth).p, alarm) << g << ' ' << max_bounces;
            EXPECT_GT(welch_test(garbage.walks(), truth).p, alarm) << g << ' ' << max_bounces;
        }
    }
}

TEST(ResidualWalkStat, AnyEffortLeavesTheMean)
{
    for (const Cache kind : {Cache::Good, Cache::Garbage}) {
        const Setting setting(cloud({0.5f}), 5, kind);
        const MeanEstimate truth = setting.truth();
        for (const ResidualParams& params :
             {ResidualParams{}, ResidualParams{1, 1, 1.0f}, ResidualParams{8, 2, 0.1f},
              ResidualParams{3, 1, 0.5f}}) {
            EXPECT_GT(welch_test(setting.walks(params), truth).p, alarm) << params.directions;
        }
    }
}

/// Lamps and skies that rays meet, glowing media, several phase functions, surfaces on the way.
TEST(ResidualWalkStat, AnySceneLeavesTheMean)
{
    Scene image = test::sky_with_a_sun().scene;
    Scene lamps = test::spheres_in_smoke().scene;
    Scene several = test::overlapping().scene;
    several.media.volumes[0].phase = {0.9f, -0.4f, 0.3f};
    Scene flame = test::flame_in_smoke().scene;
    Scene walls = test::courtyard(true);
    walls.media.volumes[0].phase = {0.8f};
    for (Scene* scene : {&image, &lamps, &several, &flame, &walls}) {
        const Setting setting(std::move(*scene), 4, Cache::Garbage);
        EXPECT_GT(setting.p(), alarm);
    }
}

enum class Mistake {
    None,
    WrongFactor,    ///< less of the cache is taken away than was added
    NoSurvival,     ///< what is carried on is not divided by its chance
    CacheAtTheEnd,  ///< the last event brings what the cache says of the rest
};

/// Two events behind the first, put together by hand, lit by the sun alone.
Spectrum second_and_third(const Setting& setting, Mistake mistake, Rng& rng)
{
    constexpr float survival = 0.5f;
    const TraceContext context = setting.context(false);
    Spectrum sum(0.0f);
    Spectrum beta(1.0f);
    ScatterEvent event = setting.event;
    for (const bool is_last : {false, true}) {
        const ScatteredDirection s = *sample_scattering(event, rng);
        LightRay ray{Ray{event.x, s.wi, 0.0f}, s.scattering.pdf_dir, false};
        const TracedSegment segment = trace_segment(context, ray, false, rng);
        const std::optional<NextEvent> next = next_event(setting.scene, ray.ray, segment);
        if (!next) return sum;
        event = next->event;
        beta *= next->albedo;
        const Spectrum C = eval_cached_light(setting.cache, event);
        sum += beta * estimate_direct_light(context, event, rng);
        if (!is_last || mistake == Mistake::CacheAtTheEnd) sum += beta * C;
        if (rng.uniform() >= survival) return sum;
        if (mistake != Mistake::NoSurvival) beta /= survival;
        if (!is_last) sum -= beta * (mistake == Mistake::WrongFactor ? 0.7f : 1.0f) * C;
    }
    return sum;
}

TEST(ResidualWalkStat, WrongWalksAreFoundOut)
{
    Scene scene = cloud({0.3f});
    scene.environment.reset();
    const Setting setting(std::move(scene), 3);
    const MeanEstimate truth = setting.truth({32, 1500});
    const auto judge = [&](Mistake mistake) {
        const MeanEstimate found = test::mean_of(
            {32, 1500}, 3, [&](Rng& rng) { return second_and_third(setting, mistake, rng); });
        return welch_test(found, truth).p;
    };
    EXPECT_GT(judge(Mistake::None), alarm);
    EXPECT_LT(judge(Mistake::WrongFactor), alarm);
    EXPECT_LT(judge(Mistake::NoSurvival), alarm);
    EXPECT_LT(judge(Mistake::CacheAtTheEnd), alarm);
}

TEST(ResidualWalkStat, OneEventTooFewIsFoundOut)
{
    const Setting two(cloud({0.0f}), 2);
    const Setting three(cloud({0.0f}), 3);
    EXPECT_LT(welch_test(two.walks(), three.truth()).p, alarm);
}

/// What the cache is for: walks may end early. Measured 0.18 of the variance.
TEST(ResidualWalkStat, AGoodCacheTakesRouletteNoiseAway)
{
    const ResidualParams early{4, 4, 0.1f};
    const Setting good(cloud({0.3f}), 20);
    const Setting empty(cloud({0.3f}), 20, Cache::Empty);
    EXPECT_LT(good.walks(early).variance, 0.5 * empty.walks(early).variance);
}

/// What is cut has the same mean as that of plain paths: Welch.
TEST(ResidualWalkStat, CountsWhatMaxBouncesCuts)
{
    const Setting setting(cloud({0.3f}), 4);
    const MeanEstimate walks = test::mean_of({}, 2, [&](Rng& rng) {
        return Spectrum(
            residual_light(setting.context(), setting.cache, {}, setting.event, rng).cut);
    });
    const MeanEstimate paths = test::mean_of({}, 1, [&](Rng& rng) {
        return Spectrum(trace_after_event(setting.context(false), setting.event, rng).cut);
    });
    EXPECT_GT(walks.mean, 0.0);
    EXPECT_GT(welch_test(walks, paths).p, alarm);
}

/// Light of order 2 is scattered without error: against quadrature, to its error.
TEST(RadianceCache, ScattersSmoothLightExactly)
{
    const auto arriving = [](Vec3 wi) {
        const float b = glm::dot(wi, Vec3(0.3f, -0.5f, 0.6f));
        const float c = glm::dot(wi, Vec3(0.7f, 0.2f, -0.4f));
        return Spectrum(2.0f + b, 1.0f + c * c, 1.5f + b * c);
    };
    Setting setting(cloud({}), 2);
    constexpr int n = 512;
    RadianceCache::Node node;
    node.fill(Spectrum(0.0f));
    const auto for_directions = [&](auto&& f) {
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                f(sample_sphere(Vec2(static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f) /
                                static_cast<float>(n)),
                  4.0f * pi / static_cast<float>(n * n));
            }
        }
    };
    for_directions([&](Vec3 wi, float area) {
        const ShBasis basis = eval_sh(wi);
        for (size_t k = 0; k < sh_count; ++k) node[k] += area * basis[k] * arriving(wi);
    });
    std::fill(setting.cache.incident.begin(), setting.cache.incident.end(), node);
    for (const Phase& phase : {Phase{}, Phase{0.6f}, Phase{-0.5f}, Phase{0.7f, -0.4f, 0.3f}}) {
        Vec3d exact(0.0);
        for_directions([&](Vec3 wi, float area) {
            exact += Vec3d(area * eval_phase(phase, setting.event.wo, wi) * arriving(wi));
        });
        ScatterEvent event = setting.event;
        event.phase = &phase;
        const Spectrum cached = eval_cached_light(setting.cache, event);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(cached[c], exact[c], 1e-3) << phase.g;
    }
}

/// At a node and for even scattering there is nothing but noise: a node over seeds against paths.
TEST(RadianceCacheStat, NodesHaveTheRightMean)
{
    const Setting setting(cloud({0.6f}), 4);
    const SmokeLattice& lattice = setting.cache.lattice;
    const Phase even;
    ScatterEvent event = setting.event;
    event.phase = &even;
    const SmokeLattice::Corners corners = lattice.corners(event.x);
    ASSERT_NE(corners.slot[0], 0);
    event.x = lattice.position(corners.node(0));
    RunningStats nodes;
    for (uint32_t seed = 0; seed < 32; ++seed) {
        const RadianceCache cache = make_radiance_cache(setting.context(), {16, 256, seed});
        nodes.add(static_cast<double>(luminance(eval_cached_light(cache, event))));
    }
    const MeanEstimate truth = test::mean_of(
        {}, 9, [&](Rng& rng) { return trace_after_event(setting.context(), event, rng).indirect; });
    EXPECT_GT(welch_test(estimate_mean(nodes), truth).p, alarm);
}

TEST(RadianceCache, IsTheSameForAnyThreadCount)
{
    const Setting setting(test::courtyard(true), 4);
    const auto make = [&] { return make_radiance_cache(setting.context(), {4, 256, 3}).incident; };
    std::vector<RadianceCache::Node> one;
    run_with_threads(1, [&] { one = make(); });
    for (const int threads : {2, 3, 8}) {
        run_with_threads(threads, [&] { EXPECT_EQ(make(), one); });
    }
}

TEST(RadianceCache, NothingIsKnownWhereThereIsNoSmoke)
{
    Setting setting(cloud({}), 4);
    setting.scene.media.volumes.clear();
    const RadianceCache cache = make_radiance_cache(setting.context(), {});
    EXPECT_EQ(cache.lattice.active_count(), 0);
    const Phase even;
    ScatterEvent event = setting.event;
    event.phase = &even;
    EXPECT_EQ(eval_cached_light(cache, event), Spectrum(0.0f));
}

}  // namespace
}  // namespace mote
