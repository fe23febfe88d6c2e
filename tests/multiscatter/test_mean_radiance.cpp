// What is known of the light of many events, and what shared paths make of it: right in the mean
// whatever it is, less noisy where it is close.

#include <cmath>

#include <gtest/gtest.h>

#include "multiscatter/gather_light.h"
#include "multiscatter/mean_radiance.h"
#include "multiscatter/send_paths.h"
#include "multiscatter/sharing.h"
#include "restir/room_scenes.h"

namespace mote {
namespace {

using test::Sharing;

constexpr double alarm = 1e-5;  // false alarms, each comparison

/// A guess that says the same at all nodes, or a different random one at each.
MeanRadiance guess(const Media& media, Spectrum value, bool is_random = false)
{
    MeanRadiance known;
    known.lattice = make_smoke_lattice(media, 0.1f, 4096);
    known.values.assign(known.lattice.nodes.size(), value);
    Rng rng(3, 0, Stream::Test, 0, 0);
    for (Spectrum& v : known.values) {
        if (is_random) v *= 4.0f * rng.uniform3() - Vec3(1.0f);
    }
    known.values[0] = Spectrum(0.0f);
    return known;
}

TEST(MeanRadianceStat, SharedPathsAreRightWhateverIsKnown)
{
    for (const float g : {0.0f, 0.85f}) {
        const Sharing sharing(test::cloud(8.0f, g), 6, 0.4f);
        for (const bool is_random : {false, true}) {
            const MeanRadiance known = guess(sharing.scene.media, Spectrum(2.0f), is_random);
            for (const int levels : {1, 3}) {
                const TestResult result =
                    test::compare_with_alone(sharing, {32, 80}, [&](Rng& rng) {
                        return sharing.shared({.group_size = 4, .levels = levels, .known = &known},
                                              rng);
                    });
                EXPECT_GT(result.p, alarm) << g << ' ' << is_random << ' ' << levels;
            }
        }
    }
}

TEST(MeanRadianceStat, SurfacesMayBeMetOnTheWay)
{
    const Sharing sharing(test::room(), 4, 0.3f);
    const MeanRadiance known = guess(sharing.scene.media, Spectrum(0.5f), true);
    const TestResult result = test::compare_with_alone(sharing, {32, 100}, [&](Rng& rng) {
        return sharing.shared({.group_size = 32, .levels = 2, .known = &known}, rng);
    });
    EXPECT_GT(result.p, alarm);
}

enum class Mistake {
    None,
    NotGivenBack,  ///< what is known is taken from shared paths alone
    NotTakenOff,   ///< or given to the vertices alone
    NotInBetween,  ///< or only at the ends of levels
};

/// Two levels of sharing, open to mistakes.
Spectrum shared_with(const Sharing& setting, const MeanRadiance& known, Mistake mistake, Rng& rng)
{
    WalkCounts counts;
    float cut = 0.0f;
    const TraceContext context = setting.trace();
    SharingContext sharing{context, setting.extinction, 64, cache_time, counts, cut, 0.0f, &known};
    PathLevel levels[3];
    levels[0].vertices = setting.first;
    send_paths(sharing, 1, true, levels[0], levels[1], rng);
    if (mistake == Mistake::NotInBetween) sharing.known = nullptr;
    send_paths(sharing, 2, false, levels[1], levels[2], rng);
    sharing.known = mistake == Mistake::NotTakenOff ? nullptr : &known;
    for (PathVertex& y : levels[2].vertices) {
        if (y.surface < 0) follow_own_path(sharing, levels[2].event(y, cache_time), 3, y, rng);
    }
    if (mistake == Mistake::NotGivenBack) {
        for (PathVertex& v : levels[0].vertices) v.known = Spectrum(0.0f);
    }
    std::vector<Spectrum> light(1, Spectrum(0.0f));
    gather_light(sharing, levels[1], levels[2], rng, {});
    gather_light(sharing, levels[0], levels[1], rng, light);
    return light[0];
}

TEST(MeanRadianceStat, WhatIsKnownCountsOnce)
{
    for (const bool has_surfaces : {false, true}) {
        const Sharing sharing(has_surfaces ? test::room() : test::cloud(8.0f, 0.6f), 5, 0.5f);
        const MeanRadiance known = guess(sharing.scene.media, Spectrum(1.0f));
        const auto judge = [&](Mistake mistake) {
            return test::compare_with_alone(
                       sharing, {32, 60},
                       [&](Rng& rng) { return shared_with(sharing, known, mistake, rng); })
                .p;
        };
        EXPECT_GT(judge(Mistake::None), alarm) << has_surfaces;
        EXPECT_LT(judge(Mistake::NotGivenBack), alarm) << has_surfaces;
        EXPECT_LT(judge(Mistake::NotTakenOff), alarm) << has_surfaces;
        EXPECT_LT(judge(Mistake::NotInBetween), alarm) << has_surfaces;
    }
}

/// Deep in white smoke under an even sky all paths find the same light, and only how many of them a
/// vertex gets is noise. A guess that is nowhere near is the negative control.
TEST(MeanRadianceStat, TakesNoiseFromSharedPaths)
{
    Scene scene = test::cloud(20.0f, 0.3f);
    scene.media.volumes[0].albedo = Spectrum(1.0f);
    scene.lights.clear();
    scene.environment = EnvironmentLight{Spectrum(1.0f), nullptr, Mat3(1.0f)};
    const Sharing sharing(std::move(scene), 1000, 0.1f);
    const auto noise = [&](const MeanRadiance* known) {
        RunningStats stats;
        for (uint32_t i = 0; i < 200; ++i) {
            Rng rng(1, i, Stream::Test, 0, 0);
            stats.add(static_cast<double>(luminance(sharing.shared({.known = known}, rng))));
        }
        return estimate_mean(stats).standard_error();
    };
    const MeanRadiance right = guess(sharing.scene.media, Spectrum(1.0f));
    const MeanRadiance wrong = guess(sharing.scene.media, Spectrum(4.0f));
    const double without = noise(nullptr);
    EXPECT_LT(noise(&right), 0.5 * without);
    EXPECT_GT(noise(&wrong), without);
}

RadianceCache even_cache(const Media& media, Spectrum radiance)
{
    RadianceCache cache;
    cache.lattice = make_smoke_lattice(media, 0.2f, 4096);
    RadianceCache::Node node;
    node.fill(Spectrum(0.7f));                  // of directions, which do not count
    node[0] = std::sqrt(4.0f * pi) * radiance;  // order 0 of what is the same everywhere
    cache.incident.assign(cache.lattice.nodes.size(), node);
    cache.incident[0].fill(Spectrum(0.0f));
    return cache;
}

TEST(MeanRadiance, OfEvenLightIsThatLight)
{
    const Media media = test::sun_and_sky().scene.media;
    const Spectrum radiance(1.0f, 2.0f, 3.0f);
    const MeanRadiance mean = mean_radiance(even_cache(media, radiance));
    for (size_t slot = 1; slot < mean.values.size(); ++slot) {
        EXPECT_LT(glm::length(mean.values[slot] - radiance), 1e-4f) << slot;
    }
    EXPECT_EQ(mean.values[0], Spectrum(0.0f));
    EXPECT_EQ(mean.at(Vec3(1e6f)), Spectrum(0.0f));
}

TEST(MeanRadiance, SmoothsSpikesAndKeepsThemWhereTheyAre)
{
    const Media media = test::sun_and_sky().scene.media;
    RadianceCache cache = even_cache(media, Spectrum(0.0f));
    const size_t spike = cache.incident.size() / 2;
    cache.incident[spike][0] = Spectrum(100.0f);
    const MeanRadiance mean = mean_radiance(cache);
    const float there = mean.values[spike].x;
    EXPECT_LT(there, 0.1f * 100.0f * 0.2821f);
    for (const Spectrum& value : mean.values) {
        EXPECT_GE(value.x, 0.0f);
        EXPECT_LE(value.x, 1.5f * there);  // borders have fewer neighbours
    }
}

TEST(MeanRadiance, IsAMeanOverFrames)
{
    const Media media = test::sun_and_sky().scene.media;
    MeanRadiance mean = mean_radiance(even_cache(media, Spectrum(1.0f)));
    for (int frame = 2; frame <= 3; ++frame) {
        MeanRadiance next = mean_radiance(even_cache(media, Spectrum(static_cast<float>(frame))));
        blend_in(mean, 31, next);
        mean = next;
    }
    EXPECT_EQ(mean.frames, 3);
    EXPECT_NEAR(mean.values[1].x, 2.0f, 1e-5f);
    MeanRadiance next = mean_radiance(even_cache(media, Spectrum(6.0f)));
    blend_in(mean, 1, next);  // as if it were of one frame
    EXPECT_EQ(next.frames, 2);
    EXPECT_NEAR(next.values[1].x, 4.0f, 1e-5f);
}

/// Where smoke has only just arrived nothing is known: that is not the same as black.
TEST(MeanRadiance, LatticesMayDiffer)
{
    Media media = test::sun_and_sky().scene.media;
    const MeanRadiance before = mean_radiance(even_cache(media, Spectrum(5.0f)));
    media.volumes[0].world_from_object.keys[0].translate += Vec3d(50.0, 0.0, 0.0);
    MeanRadiance now = mean_radiance(even_cache(media, Spectrum(1.0f)));
    blend_in(before, 31, now);
    for (size_t slot = 1; slot < now.values.size(); ++slot) {
        EXPECT_NEAR(now.values[slot].x, 1.0f, 1e-5f);
    }
}

/// A path too bright for floats would else spread to all nodes around, and last.
TEST(MeanRadiance, NodesThatAreNotFiniteAreBlack)
{
    const Media media = test::sun_and_sky().scene.media;
    RadianceCache cache = even_cache(media, Spectrum(1.0f));
    cache.incident[cache.incident.size() / 2][0].x = infinity;
    cache.incident[cache.incident.size() / 3][0].y = std::nanf("");
    for (const Spectrum& value : mean_radiance(cache).values) EXPECT_TRUE(is_finite(value));
}

TEST(RadianceCache, CountsEventsFromWhereMediaCollide)
{
    const auto events = [](float density, float albedo) {
        Scene scene = test::cloud(density, 0.0f);
        scene.media.volumes[0].albedo = Spectrum(albedo);
        const PathTracerParams path{.max_bounces = 8};
        const LightSampler lights(scene, path);
        return make_radiance_cache({scene, lights, path}, {16, 1000, 1}).mean_events;
    };
    EXPECT_NEAR(events(1e4f, 0.9f), 10.0f, 0.5f);
    EXPECT_LT(events(1e-3f, 1.0f), 1.1f);
    EXPECT_GT(events(1e4f, 1.0f), 100.0f);
    EXPECT_EQ(events(0.0f, 1.0f), 1.0f);
    // Walls keep walks in, but what they do there is not shared.
    Scene room = test::room();
    room.media.volumes[0].density_scale *= 1e-3f;
    const PathTracerParams path{.max_bounces = 8};
    const LightSampler lights(room, path);
    EXPECT_LT(make_radiance_cache({room, lights, path}, {16, 1000, 1}).mean_events, 1.1f);
}

TEST(PathSharing, IsWiderWhereWalksAreLongAndLobesNarrow)
{
    Media media = test::cloud(8.0f, 0.85f).media;
    EXPECT_GT(sharing_for(media, 100.0f).levels, PathSharing().levels);
    EXPECT_EQ(sharing_for(media, 10.0f).levels, PathSharing().levels);
    media.volumes[0].phase = {-0.85f};
    EXPECT_GT(sharing_for(media, 100.0f).group_size, PathSharing().group_size);
    media.volumes[0].phase = {0.95f, -0.5f, 0.5f};
    EXPECT_EQ(sharing_for(media, 100.0f).group_size, PathSharing().group_size);
    media.volumes[0].phase = {-0.3f};
    EXPECT_EQ(sharing_for(media, 100.0f).group_size, PathSharing().group_size);
}

}  // namespace
}  // namespace mote
