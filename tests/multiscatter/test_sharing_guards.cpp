// Vertices in one place, out of sight, or in smoke beyond what transmittances tell: shared light
// stays a number, and what is assumed of the smoke does not matter.
#include <gtest/gtest.h>

#include "multiscatter/cached_shadows.h"
#include "multiscatter/gather_light.h"
#include "multiscatter/send_paths.h"
#include "multiscatter/shared_paths.h"
#include "multiscatter/vertex_lanes.h"
#include "restir/room_scenes.h"
#include "restir/scenes.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

/// A scene, and first vertices around a place in it.
struct Sharing {
    Scene scene;
    PathTracerParams path{.max_bounces = 5};
    LightSampler lights;
    CoarseExtinction extinction;
    std::vector<PathVertex> first;

    explicit Sharing(Scene s, Vec3 place = Vec3(0.1f, 0.05f, 0.1f), float spread = 0.3f)
        : scene(std::move(s)),
          lights(scene, path),
          extinction(make_coarse_extinction(scene.media, find_smoke_cells(scene.media, 4.0f, 1000)))
    {
        for (uint32_t i = 0; i < 12; ++i) {
            Rng rng(11, 0, Stream::Test, i, 0);
            PathVertex v;
            v.x = place + spread * (rng.uniform3() - Vec3(0.5f));
            v.wo = glm::normalize(Vec3(0.5f, 0.4f, 3.2f));
            v.phase = &scene.media.volumes[0].phase;
            v.lobe = *v.phase;
            first.push_back(v);
        }
    }

    [[nodiscard]] TraceContext trace() const { return {scene, lights, path}; }

    [[nodiscard]] Spectrum light(uint32_t seed, const PathSharing& sharing = {}) const
    {
        std::vector<Spectrum> sum(1, Spectrum(0.0f));
        WalkCounts counts;
        float cut = 0.0f;
        Rng rng(seed, 0, Stream::Test, 0, 0);
        share_paths(trace(), extinction, sharing, first, rng, sum, counts, cut);
        return sum[0];
    }
};

/// Smoke so small and far off that floats have one place for all of it.
TEST(SharingGuards, VerticesInOnePlaceShareTheirLight)
{
    const float size = 0.01f;
    const Vec3d far_off(1e6, 2e6, -1e6);
    Scene scene = test::sun_and_sky(6.0f / size).scene;
    Volume& volume = scene.media.volumes[0];
    volume.world_from_object.keys[0].translate = far_off;
    volume.world_from_object.keys[0].scale = Vec3d(static_cast<double>(size));
    finalize(volume);
    const Sharing sharing(scene, Vec3(far_off), 0.0f);
    double sum = 0.0;
    for (uint32_t seed = 1; seed <= 100; ++seed) {
        const Spectrum light = sharing.light(seed);
        ASSERT_TRUE(is_finite(light)) << seed;
        sum += static_cast<double>(light.y);
    }
    EXPECT_GT(sum, 0.0);
}

/// What is assumed of the smoke may be anything: here much too thin, there much too thick, so that
/// vertices hardly see what they have found themselves.
TEST(SharingGuards, AssumedTransmittancesMayBeAnything)
{
    for (const float size : {1.0f, 1e4f}) {
        Scene scene = test::sun_and_sky(8.0f / size).scene;
        scene.media.volumes[0].world_from_object.keys[0].scale = Vec3d(static_cast<double>(size));
        finalize(scene.media.volumes[0]);
        Sharing sharing(scene, Vec3(0.0f), size);
        const std::vector<float> sigma_t = sharing.extinction.sigma_t;
        for (const float thick : {1.0f, 1e6f, 1e12f, 1e20f, 1e30f}) {
            for (const float thin : {0.0f, 1.0f}) {
                for (size_t i = 0; i < sigma_t.size(); ++i) {
                    const float wrong = 2 * i < sigma_t.size() ? thick : thin;
                    sharing.extinction.sigma_t[i] = wrong * sigma_t[i];
                }
                for (uint32_t seed = 1; seed <= 60; ++seed) {
                    EXPECT_TRUE(is_finite(sharing.light(seed))) << size << ' ' << thick;
                }
            }
        }
    }
}

/// However wrong what was assumed of a path has been.
TEST(SharingGuards, RatiosOfTransmittancesAreNumbers)
{
    const Sharing sharing(test::sun_and_sky(8.0f).scene);
    const TraceContext trace = sharing.trace();
    WalkCounts counts;
    float cut = 0.0f;
    const SharingContext context{trace, sharing.extinction, 64, cache_time, counts, cut};
    double sum = 0.0;
    for (uint32_t seed = 1; seed <= 20; ++seed) {
        PathLevel level;
        PathLevel next;
        level.vertices = sharing.first;
        Rng rng(seed, 0, Stream::Test, 0, 0);
        send_paths(context, 1, true, level, next, rng);
        for (PathVertex& v : next.vertices) v.log_excess = 150.0f;
        std::vector<Spectrum> light(1, Spectrum(0.0f));
        gather_light(context, level, next, rng, light);
        EXPECT_TRUE(is_finite(light[0])) << seed;
        sum += static_cast<double>(light[0].y);
    }
    EXPECT_GT(sum, 1e20);
}

TEST(SharingGuards, GroupsHaveAtLeastOneVertex)
{
    const Sharing sharing(test::courtyard(false));
    for (const int size : {1, 2, 3, 4}) {
        EXPECT_TRUE(is_finite(sharing.light(1, {.group_size = size}))) << size;
    }
}

TEST(SharingGuards, PlacesOutOfSightHaveNoMiddle)
{
    LaneGroup group;
    const Sharing sharing(test::sun_and_sky(8.0f).scene);
    const std::vector<int> members{0, 1, 2};
    const std::vector<float> shares(3, 1.0f / 3.0f);
    fill_lanes(sharing.first, members, shares, group);
    const std::vector<float> kernel(group.width(), 0.0f);
    const GroupView view = view_of(group, Vec3(0.0f), kernel);
    EXPECT_EQ(view.density, 0.0f);
    EXPECT_EQ(view.middle, Vec3(0.0f));
}

/// Lobes get no narrower by rounding, and have a direction where all ways cancel out.
TEST(SharingGuards, LobesForAllWaysOnAreNoNarrowerThanThePhaseFunction)
{
    const Phase phase{0.999f, -0.999f, 0.3f};
    PathVertex v;
    v.phase = &phase;
    for (uint32_t i = 0; i < 1000; ++i) {
        Rng rng(12, 0, Stream::Test, i, 0);
        const Vec3 middle = sample_phase(Phase{}, Vec3(0.0f, 0.0f, 1.0f), rng.uniform2());
        const float length = i % 2 == 0 ? 1.00001f : rng.uniform();
        aim_lobe({1.0f, length * middle}, v);
        EXPECT_LE(v.lobe.g, phase.g);
        EXPECT_GE(v.lobe.g_b, phase.g_b);
        EXPECT_NEAR(glm::length(v.wo), 1.0f, 2e-5f);
    }
    aim_lobe({1.0f, Vec3(0.0f)}, v);
    EXPECT_EQ(glm::length(v.wo), 1.0f);
    EXPECT_EQ(v.lobe.g, 0.0f);
}

/// A vertex lies where rays leave the surface that another one's path has found.
TEST(SharingGuards, SurfacesDoNotHideWhatLiesOnThem)
{
    Sharing sharing(test::courtyard(false));
    sharing.first.resize(2);
    sharing.first[1].weight = Spectrum(0.0f);  // it sends no path
    const TraceContext trace = sharing.trace();
    WalkCounts counts;
    float cut = 0.0f;
    const SharingContext context{trace, sharing.extinction, 64, cache_time, counts, cut};
    const auto send = [&](uint32_t seed, PathLevel& level, PathLevel& next) {
        level.vertices = sharing.first;
        Rng rng(seed, 0, Stream::Test, 0, 0);
        send_paths(context, 1, true, level, next, rng);
    };
    int met = 0;
    for (uint32_t seed = 1; seed <= 60; ++seed) {
        PathLevel level;
        PathLevel next;
        send(seed, level, next);
        if (next.vertices.empty() || next.vertices[0].surface < 0) continue;
        const PathVertex& found = next.vertices[0];
        const ScatterEvent event = next.event(found, cache_time);
        const Vec3 to_first = sharing.first[0].x - found.x;
        sharing.first[1].x = ray_origin(event, to_first);
        PathLevel level_again;
        PathLevel next_again;
        send(seed, level_again, next_again);
        ASSERT_FALSE(next_again.vertices.empty());
        EXPECT_EQ(next_again.vertices[0].x, found.x);
        EXPECT_GT(level_again.kernels[1], 0.0f);
        EXPECT_TRUE(is_finite(sharing.light(seed)));
        sharing.first[1].x = found.x;
        EXPECT_TRUE(is_finite(sharing.light(seed)));
        ++met;
    }
    EXPECT_GT(met, 5);
}

/// Linear between values of 1 may be more, by rounding.
TEST(CachedShadowsGuards, GuessesAreShares)
{
    const Scene scene = test::sun_and_sky(8.0f).scene;
    const auto caches = make_light_caches(scene, {}, nullptr);
    const CachedShadows guess(*caches);
    const Vec3 to_sun = std::get<DistantLight>(scene.lights[0]).direction;
    for (uint32_t i = 0; i < 5000; ++i) {
        Rng rng(13, 0, Stream::Test, i, 0);
        const Vec3 x = 8.0f * rng.uniform3() - 4.0f;
        const Vec3 wi = sample_phase(Phase{}, Vec3(0.0f, 0.0f, 1.0f), rng.uniform2());
        for (const Vec3& w : {wi, to_sun}) {
            const std::optional<float> T = guess.to_infinity(x, w);
            ASSERT_TRUE(T);
            EXPECT_TRUE(*T >= 0.0f && *T <= 1.0f) << *T;
        }
    }
}

}  // namespace
}  // namespace mote
