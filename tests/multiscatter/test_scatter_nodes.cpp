#include <gtest/gtest.h>

#include "core/parallel.h"
#include "multiscatter/batches.h"
#include "multiscatter/scatter_along.h"
#include "reference/path_tracer.h"
#include "restir/room_scenes.h"
#include "restir/runs.h"

namespace mote {
namespace {

struct Nodes {
    explicit Nodes(Scene s, int max_bounces = 8) : scene(std::move(s))
    {
        path.max_bounces = max_bounces;
        lights = LightSampler(scene, path);
    }
    [[nodiscard]] ScatterNodes make(uint32_t seed) const
    {
        return make_scatter_nodes({scene, lights, path}, {3000.0f, 0.2f, 1, seed});
    }
    Scene scene;
    PathTracerParams path;
    LightSampler lights;
};

/// A node's light over seeds against paths from its place: Welch, false alarms 1e-5 each.
TEST(ScatterNodesStat, NodesHaveTheRightMean)
{
    const Nodes nodes(test::sun_and_sky().scene);
    const ScatterNodes first = nodes.make(0);
    std::vector<RunningStats> stats(first.lattice.nodes.size());
    std::vector<int> lit(stats.size(), 0);
    for (uint32_t seed = 0; seed < 40; ++seed) {
        const ScatterNodes made = nodes.make(seed);
        for (size_t i = 1; i < stats.size(); ++i) {
            const float light = luminance(made.at(0, static_cast<int32_t>(i)));
            stats[i].add(static_cast<double>(light));
            lit[i] += light > 0.0f ? 1 : 0;
        }
    }
    const TraceContext context{nodes.scene, nodes.lights, nodes.path};
    int judged = 0;
    for (size_t i = 1; i < stats.size() && judged < 5; i += 7) {
        // Nodes out of view get a path so rarely that a t-test would not hold.
        if (lit[i] < 40) continue;
        ++judged;
        const Vec3 x = first.lattice.position(first.lattice.nodes[i]);
        const ScatterEvent event{x, first.wo(x), 0.0f, &nodes.scene.media.volumes[0].phase};
        const MeanEstimate truth = test::mean_of(
            {}, 9, [&](Rng& rng) { return trace_after_event(context, event, rng).indirect; });
        EXPECT_GT(welch_test(estimate_mean(stats[i]), truth).p, 1e-5) << i;
    }
    EXPECT_EQ(judged, 5);
}

TEST(ScatterNodes, AreTheSameForAnyThreadCount)
{
    const Nodes nodes(test::courtyard(true), 4);
    std::vector<Spectrum> one;
    run_with_threads(1, [&] { one = nodes.make(3).radiance; });
    for (const int threads : {2, 3, 8}) {
        run_with_threads(threads, [&] { EXPECT_EQ(nodes.make(3).radiance, one); });
    }
}

TEST(ScatterNodes, OnlyServeScenesThatNeedThem)
{
    Scene scene = test::sun_and_sky().scene;
    PathTracerParams path;
    path.max_bounces = 1;
    EXPECT_FALSE(can_have_scatter_nodes(scene, path));
    path.max_bounces = 2;
    EXPECT_TRUE(can_have_scatter_nodes(scene, path));
    scene.media.volumes[0].world_from_object.keys.push_back({});
    EXPECT_FALSE(can_have_scatter_nodes(scene, path));
    EXPECT_FALSE(can_have_scatter_nodes(Scene{}, path));
}

/// Previews are biased, but not by much: within 10 % of the light of many events.
TEST(ScatterNodesStat, PreviewsAreCloseToTheTruth)
{
    test::TestScene scene = test::sun_and_sky();
    scene.max_bounces = 16;
    scene.scene.camera.width = 32;
    scene.scene.camera.height = 24;
    const TileStats reference = test::reference_runs(scene, {8, 1, 32});
    RenderDescription render = test::description(scene, EstimatorKind::Restir, 4);
    render.restir = make_restir_params(RestirPreset::Preview);
    render.restir.reuse = ReuseMode::Off;
    render.restir.node_spacing = 0.1f;
    render.restir.node_paths = 8.0f;
    const RunComparison comparison =
        compare_runs(test::render_runs(scene, render, 8, 1), reference);
    for (const ChannelComparison& c : comparison.channels) {
        if (c.name.find("indirect") == std::string::npos || c.reference.mean == 0.0) continue;
        EXPECT_NEAR(c.tested.mean / c.reference.mean, 1.0, 0.1) << c.name;
    }
}

}  // namespace
}  // namespace mote
