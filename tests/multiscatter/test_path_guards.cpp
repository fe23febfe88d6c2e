// Nodes where the camera is or out of its sight, walks that floats hold in one place, paths without
// light, and walks towards lights in full shadow.
#include <gtest/gtest.h>

#include "multiscatter/combine_paths.h"
#include "multiscatter/constant_guess.h"
#include "multiscatter/path_worlds.h"
#include "multiscatter/scatter_along.h"
#include "reference/aimed_light.h"
#include "restir/room_scenes.h"
#include "support/surface_scene.h"

namespace mote {
namespace {

ScatterNodes nodes_of(const Scene& scene)
{
    PathTracerParams path;
    path.max_bounces = 4;
    const LightSampler lights(scene, path);
    return make_scatter_nodes({scene, lights, path}, {300.0f, 0.2f, 1, 1});
}

/// Nodes that shine; all of them hold numbers.
int lit_nodes(const ScatterNodes& nodes)
{
    int lit = 0;
    for (const Spectrum& light : nodes.radiance) {
        EXPECT_TRUE(is_finite(light));
        lit += max_component(light) > 0.0f ? 1 : 0;
    }
    return lit;
}

TEST(ScatterNodesGuards, TheCameraMayBeOnANode)
{
    Scene scene = test::courtyard(false);
    const SmokeLattice lattice = nodes_of(scene).lattice;
    const auto middle = static_cast<size_t>(lattice.active_count() / 2);
    const Vec3 place = lattice.position(lattice.nodes[middle]);
    scene.camera.world_from_camera.keys[0].translate = Vec3d(place);
    const ScatterNodes nodes = nodes_of(scene);
    ASSERT_EQ(nodes.eye, nodes.lattice.position(nodes.lattice.nodes[middle]));
    EXPECT_GT(lit_nodes(nodes), 0);
    // Those around it matter most and have paths, which few others have.
    int near = 0;
    int lit = 0;
    for (size_t i = 1; i < nodes.lattice.nodes.size(); ++i) {
        const Vec3 to_node = nodes.lattice.position(nodes.lattice.nodes[i]) - place;
        if (!(glm::length(to_node) < 1.1f * nodes.lattice.spacing)) continue;
        ++near;
        lit += max_component(nodes.at(0, static_cast<int32_t>(i))) > 0.0f ? 1 : 0;
    }
    EXPECT_GE(near, 5);
    EXPECT_GE(lit, near / 2);
}

/// They get a path now and then, as pixels at the border of the view may use them.
TEST(ScatterNodesGuards, NodesMayAllBeHidden)
{
    Scene scene = test::sun_and_sky().scene;
    const Vec3 eye(scene.camera.world_from_camera.keys[0].translate);
    test::add_surfaces(
        scene,
        {{test::quad_mesh(eye - Vec3(5.0f, 5.0f, 0.1f), {10.0f, 0.0f, 0.0f}, {0.0f, 10.0f, 0.0f}),
          test::diffuse(Spectrum(0.5f))}});
    const ScatterNodes nodes = nodes_of(scene);
    EXPECT_EQ(nodes.lattice.spacing, 0.2f);
    EXPECT_GT(lit_nodes(nodes), 0);
}

/// Where every node shows the same there is what is lost of it, where there are none nothing; nor
/// on rays that meet no smoke.
TEST(ScatterAlongGuards, LightIsThatOfTheNodesThereAre)
{
    const Scene scene = test::sun_and_sky().scene;
    ScatterNodes nodes = nodes_of(scene);
    std::fill(nodes.radiance.begin(), nodes.radiance.end(), Spectrum(1.0f));
    const Vec3 eye(scene.camera.world_from_camera.keys[0].translate);
    const Ray ray{eye, glm::normalize(Vec3(0.1f) - eye)};
    RayBins bins;
    BinCounts counts;
    make_ray_bins(scene.media, ray, 0.0f, bins, counts);
    ASSERT_FALSE(bins.empty());
    const Spectrum lost = -std::expm1(-bins.depth()) * scene.media.volumes[0].albedo;
    EXPECT_NEAR(scatter_along(nodes, scene.media, ray, bins).y, lost.y, 1e-4f);
    std::fill(nodes.lattice.slots.begin(), nodes.lattice.slots.end(), 0);
    EXPECT_EQ(scatter_along(nodes, scene.media, ray, bins), Spectrum(0.0f));
    make_ray_bins(scene.media, {eye, -ray.d}, 0.0f, bins, counts);
    EXPECT_EQ(scatter_along(nodes, scene.media, ray, bins), Spectrum(0.0f));
}

const Vec3d far_off(1e6, 2e6, -1e6);

/// Smoke at a place far from the origin, where floats are as far apart as `size` or further.
Scene smoke_at(Vec3d place, double size)
{
    Scene scene = test::sun_and_sky(static_cast<float>(6.0 / size)).scene;
    Volume& volume = scene.media.volumes[0];
    volume.world_from_object.keys[0].translate = place;
    volume.world_from_object.keys[0].scale = Vec3d(size);
    finalize(volume);
    scene.media.volumes.push_back(volume);  // of one alone nobody asks where it is
    return scene;
}

/// The next event may be where this one is, for floats: no reason to lose it. One that is rounded
/// out of the smoke is none.
TEST(WalkGuards, WalksOfNoLengthScatterOn)
{
    int of_no_length = 0;
    int lost = 0;
    for (const double size : {0.01, 0.1, 1.0}) {
        for (const double beside : {0.0, 0.03}) {  // a place that floats have, and one between
            const Vec3d place = far_off + beside;
            const test::PathScene paths(smoke_at(place, size), 4);
            const PathWorld world = paths.world();
            std::vector<DrawnPath> drawn;
            float cut = 0.0f;
            for (uint32_t i = 0; i < 500; ++i) {
                Rng rng(1, 0, Stream::Test, i, 0);
                const Vec3d o = far_off + Vec3d(0.5, 0.5, 3.0);
                const Vec3d to = place + 0.5 * size * Vec3d(rng.uniform3() - 0.5f) - o;
                PixelDomain domain;
                BinCounts counts;
                make_path_domain(paths.frame, {Vec3(o), Vec3(glm::normalize(to))}, domain, counts);
                ASSERT_FALSE(domain.bins.empty());
                const float u = rng.uniform();
                draw_paths(world, domain, u, {0, i, 0}, drawn, cut);
                const auto second = walk_to_second(world, domain, u, {0, i, 0});
                lost += second ? 0 : 1;
                if (!second) continue;
                EXPECT_NEAR(glm::length(second->w1), 1.0f, 1e-5f);
                EXPECT_TRUE(is_finite(second->carried));
                of_no_length += second->collision && !(second->r > 0.0f) ? 1 : 0;
            }
            for (const DrawnPath& path : drawn) EXPECT_TRUE(is_finite(path.value));
        }
    }
    EXPECT_GT(of_no_length, 200);
    EXPECT_GT(lost, 500);
}

/// What paths are combined in.
struct Combining {
    test::PathScene scene{test::sun_and_sky().scene, 4};
    PathWorld world = scene.world();
    PixelDomain domain;
    PathEndpoint end{world, domain};

    Combining()
    {
        scene.make_domain(
            0.5f * Vec2(scene.frame.scene->camera.width, scene.frame.scene->camera.height), domain);
    }
    Combining(const Combining&) = delete;
    Combining& operator=(const Combining&) = delete;
};

/// The second vertex is nowhere: rounding may take it out of the smoke.
TEST(PathReservoirGuards, PathsThatBringNothingAfterAllAreNotKept)
{
    const Combining c;
    DrawnPath path;
    path.y.form = PathForm::ToRay;
    path.y.u = 0.5f;
    path.y.x2 = Vec3(100.0f);
    path.y.E = path.value = Spectrum(1.0f);
    Rng rng(1, 0, Stream::Test, 0, 0);
    Spectrum color;
    const PathPixel out = resample_paths(c.end, {&path, 1}, 1.0f, rng, color);
    EXPECT_EQ(color, path.value);
    EXPECT_EQ(out.r.M, 1.0f);
    EXPECT_EQ(out.r.W, 0.0f);
}

/// Reservoirs without a path on either side, or on both.
TEST(PathReservoirGuards, EmptyOnesAddConfidenceAlone)
{
    PathPixel full;
    full.r.p_hat = full.r.W = full.r.M = 1.0f;
    full.f = Spectrum(1.0f);
    PathPixel empty;
    empty.r.M = 1.0f;
    OtherPath nothing;
    nothing.M = 1.0f;
    OtherPath something = nothing;
    something.W = something.p_hat_there = 1.0f;
    something.here.f = Spectrum(1.0f);
    for (const MisForm form : {MisForm::Pairwise, MisForm::Balance, MisForm::Constant}) {
        for (const PathPixel& own : {full, empty}) {
            for (const OtherPath& other : {something, nothing}) {
                Rng rng(1, 0, Stream::Test, 0, 0);
                Spectrum color;
                const PathPixel out = combine_paths(own, {&other, 1}, form, rng, color);
                const bool is_empty = own.r.W == 0.0f && other.W == 0.0f;
                EXPECT_TRUE(is_finite(color));
                EXPECT_EQ(max_component(color) > 0.0f, !is_empty);
                EXPECT_EQ(out.r.W > 0.0f, !is_empty);
                EXPECT_TRUE(std::isfinite(out.r.W));
                EXPECT_EQ(out.r.M, 2.0f);
            }
        }
    }
}

TEST(AimedLightGuards, BlackLightsAreNotSought)
{
    const DistantLight black{Vec3(0.0f, 1.0f, 0.0f), Spectrum(0.0f)};
    const DistantLight bright{Vec3(1.0f, 0.0f, 0.0f), Spectrum(1.0f)};
    Scene scene;
    scene.lights = {black};
    EXPECT_EQ(find_aimed_lights(scene).count, 0);
    scene.lights = {black, bright};
    EXPECT_EQ(find_aimed_lights(scene).count, 1);
}

/// Chances, and small ones where there is next to nothing to find.
TEST(AimedLightGuards, FullShadowIsHardlyWorthARay)
{
    Scene scene = test::sun_and_sky(8.0f).scene;
    scene.media.volumes[0].phase = {0.6f};
    const PathTracerParams path;
    const LightSampler lights(scene, path);
    const AimedLights aims = find_aimed_lights(scene);
    const auto chance = [&](float T) {
        const test::ConstantGuess guess(T);
        const TraceContext context{scene, lights, path, &guess, nullptr, &aims};
        const ScatterEvent event{Vec3(0.1f), -aims.direction[0], 0.0f,
                                 &scene.media.volumes[0].phase};
        return aim_at_lights(context, event).q[0];
    };
    EXPECT_GT(chance(0.0f), 0.0f);
    EXPECT_LT(chance(0.0f), chance(1e-2f));
    EXPECT_NEAR(chance(0.0f), chance(1.0f), 1e-3f);
    for (const float T : {0.0f, 1e-30f, 0.3f, 1.0f}) EXPECT_LE(chance(T), 1.0f);
}

}  // namespace
}  // namespace mote
