#pragma once

#include "multiscatter/batches.h"
#include "multiscatter/shared_paths.h"
#include "reference/path_tracer.h"
#include "restir/scenes.h"
#include "volumes/media_extent.h"

namespace mote::test {

/// First vertices in a scene's first medium, about (0.1, 0.05, 0.1), of different weights.
inline std::vector<PathVertex> first_vertices(const Scene& scene, uint32_t count, float spread)
{
    std::vector<PathVertex> first;
    for (uint32_t i = 0; i < count; ++i) {
        Rng rng(11, 0, Stream::Test, i, 0);
        PathVertex v;
        v.x = Vec3(0.1f, 0.05f, 0.1f) + spread * (rng.uniform3() - Vec3(0.5f));
        v.wo = glm::normalize(Vec3(0.5f, 0.4f, 3.2f) - v.x);
        v.phase = &scene.media.volumes[0].phase;
        v.lobe = *v.phase;
        v.weight = 0.2f + rng.uniform3();
        first.push_back(v);
    }
    return first;
}

/// Their light by paths of their own: what sharing must bring in the mean.
inline Spectrum light_alone(const TraceContext& trace, const std::vector<PathVertex>& first,
                            Rng& rng)
{
    Spectrum sum(0.0f);
    for (const PathVertex& v : first) {
        const ScatterEvent event{v.x, v.wo, cache_time, v.phase};
        sum += v.weight * trace_after_event(trace, event, rng).indirect;
    }
    return sum;
}

inline CoarseExtinction extinction_of(const Media& media)
{
    return make_coarse_extinction(media, find_smoke_cells(media, 4.0f, 1000));
}

/// A scene, and first vertices in it: some close together, some not.
struct Sharing {
    Scene scene;
    PathTracerParams path;
    LightSampler lights;
    CoarseExtinction extinction;
    AimedLights aims;
    std::vector<PathVertex> first;

    Sharing(Scene s, int max_bounces, float spread)
        : scene(std::move(s)),
          path{.max_bounces = max_bounces},
          lights(scene, path),
          extinction(extinction_of(scene.media)),
          aims(find_aimed_lights(scene)),
          first(first_vertices(scene, 6, spread))
    {
    }
    Sharing(const Sharing&) = delete;
    Sharing& operator=(const Sharing&) = delete;

    [[nodiscard]] TraceContext trace() const { return {scene, lights, path}; }

    [[nodiscard]] Spectrum alone(Rng& rng) const { return light_alone(trace(), first, rng); }

    [[nodiscard]] Spectrum shared(const PathSharing& sharing, Rng& rng) const
    {
        std::vector<Spectrum> light(1, Spectrum(0.0f));
        WalkCounts counts;
        float cut = 0.0f;
        const TraceContext aiming{scene, lights, path, nullptr, nullptr, &aims};
        share_paths(aiming, extinction, sharing, first, rng, light, counts, cut);
        return light[0];
    }
};

inline Scene cloud(float density, float g)
{
    Scene scene = sun_and_sky(density).scene;
    scene.media.volumes[0].phase = {g};
    return scene;
}

template <class F>
TestResult compare_with_alone(const Sharing& sharing, const Batches& batches, F&& shared)
{
    const MeanEstimate expected = mean_of(batches, 1, [&](Rng& rng) { return sharing.alone(rng); });
    const MeanEstimate found = mean_of(batches, 2, shared);
    return welch_test(found, expected);
}

}  // namespace mote::test
