// Caches of media that are tiny, huge or nowhere, and rays that meet nothing: all that is known
// stays finite.
#include <gtest/gtest.h>

#include <cmath>

#include "restir/cluster_lanes.h"
#include "restir/combine.h"
#include "restir/direction_hits.h"
#include "restir/domains.h"
#include "restir/environment_cache.h"
#include "restir/light_cells_scene.h"
#include "restir/light_cut.h"
#include "restir/reproject.h"
#include "restir/room_scenes.h"

namespace mote {
namespace {

const Vec3 up(0.0f, 1.0f, 0.0f);

Volume cube_at(Vec3d place, Vec3d scale = Vec3d(1.0), float density_scale = 5.0f)
{
    Volume volume = test::constant_cube();
    volume.density_scale = density_scale;
    Trs& trs = volume.world_from_object.keys[0];
    trs.translate = place;
    trs.scale = scale;
    finalize(volume);
    return volume;
}

CoarseExtinction extinction_of(const Media& media)
{
    return make_coarse_extinction(media, find_smoke_cells(media, 4.0f, 100'000));
}

/// Lights in one place, seen from there, differ in nothing: dividing them is of no use.
TEST(LightCutGuards, LightsInOnePlaceAreDividedOnceFromThere)
{
    std::vector<LocalLight> lights = test::random_lights(100);
    for (LocalLight& light : lights) light.position = Vec3(0.1f, 0.2f, 0.0f);
    const LightClusters clusters = make_light_clusters(lights);
    const CoarseExtinction extinction = extinction_of({{cube_at(Vec3d(0.0))}});
    std::vector<int> cut;
    for (const float radius : {0.0f, 0.1f}) {
        choose_light_cut(clusters, extinction, lights[0].position, radius, 64, cut);
        EXPECT_EQ(cut.size(), 2u) << radius;
    }
}

/// Around the point, within its radius, all lights matter, in thick smoke most of all.
TEST(LightCutGuards, LightsAroundThePointAreToldApart)
{
    std::vector<LocalLight> lights = test::random_lights(16);
    for (LocalLight& light : lights) light.position *= 0.1f;
    const LightClusters clusters = make_light_clusters(lights);
    const CoarseExtinction extinction = extinction_of({{cube_at(Vec3d(0.0), Vec3d(1.0), 1e3f)}});
    std::vector<int> cut;
    for (const LightCluster& node : clusters.nodes) {
        for (const float off : {0.0f, 0.01f}) {  // right at its centre, too
            choose_light_cut(clusters, extinction, node.centre + off, 0.3f, 16, cut);
            EXPECT_EQ(cut.size(), 16u) << off;
        }
    }
}

TEST(ClusterLanesGuards, NarrowPeaksStayFinite)
{
    for (uint32_t i = 0; i < 3000; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        LightCluster cluster;
        cluster.centre = rng.uniform3();
        cluster.power = 1.0f;
        ClusterLanes lanes;
        lanes.set(0, cluster);
        Phase phase;
        phase.g = i % 2 == 0 ? 0.999f : -0.999f;
        const Vec3 x = 3.0f * rng.uniform3();
        Float8 value;
        const Vec3 ahead = glm::normalize(x - cluster.centre);
        eval_phase(lanes, x, i % 2 == 0 ? ahead : -ahead, phase, 0.0f, value);
        // The peak is 1.6e5.
        ASSERT_TRUE(value[0] > 1e3f && value[0] < 1e6f) << value[0];
    }
}

/// Mean extinction of a cube of 5 per metre: as deep as it is long, at every distance, on whatever
/// level.
TEST(CoarseExtinctionGuards, DepthsAreRightOnEveryLevel)
{
    const CoarseExtinction extinction = extinction_of({{cube_at(Vec3d(0.0))}});
    for (const float distance : {0.0f, 1e-30f, 1e-6f, 1e-3f, 0.1f, 0.7f, 1.5f}) {
        for (const int steps : {4, 16}) {
            const Vec3 from(-0.75f, 0.1f, 0.0f);
            Float8 tau;
            coarse_optical_depths(extinction, from, splat(from.x + distance), splat(from.y),
                                  splat(from.z), steps, tau);
            EXPECT_NEAR(tau[0], 5.0f * distance, 0.25f * 5.0f * distance + 1e-6f) << distance;
        }
    }
    // One step from corner to corner, longer than the cells of the last level.
    Float8 tau;
    const Vec3 low(-0.95f);
    coarse_optical_depths(extinction, low, splat(0.95f), splat(0.95f), splat(0.95f), 1, tau);
    EXPECT_GT(tau[0], 0.1f);
    // From outside: only what lies in the lattice counts.
    coarse_optical_depths(extinction, Vec3(-1e9f, 0.1f, 0.0f), splat(0.0f), splat(0.1f),
                          splat(0.0f), 16, tau);
    EXPECT_NEAR(tau[0], 5.0f, 2.0f);
    // To infinity, and to nowhere: as far as the lattice goes.
    for (const float end : {1e30f, infinity, std::nanf("")}) {
        coarse_optical_depths(extinction, Vec3(0.0f), splat(end), splat(0.0f), splat(0.0f), 16,
                              tau);
        EXPECT_NEAR(tau[0], 5.0f, 2.0f) << end;
    }
}

TEST(SmokeCellsGuards, SmokeHasABorderWhereverItIs)
{
    for (uint32_t i = 0; i < 200; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        const double far = std::pow(10.0, 7.0 * static_cast<double>(rng.uniform()));
        const Vec3d place = far * (Vec3d(rng.uniform3()) - 0.5);
        const Media media{{cube_at(place), cube_at(place + 3.0)}};
        const SmokeCells cells = find_smoke_cells(media, 4.0f, 5000);
        const Vec3i count = cells.lattice.count;
        for (size_t n = 0; n < cells.marks.size(); ++n) {
            const Vec3i c = cells.lattice.coordinates(n);
            const bool is_rim =
                glm::any(glm::equal(c, Vec3i(0))) || glm::any(glm::equal(c, count - 1));
            ASSERT_TRUE(!is_rim || cells.marks[n] != SmokeCells::Smoke) << i;
        }
        ASSERT_GT(cells.smoke_count, 0u);
        // Nodes of lattices lie in them, too.
        const SmokeLattice lattice = make_smoke_lattice(media, 0.3f, 5000);
        for (const Vec3i& node : lattice.nodes) {
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(node, Vec3i(0)))) << i;
            ASSERT_TRUE(glm::all(glm::lessThan(node, lattice.count))) << i;
        }
    }
}

TEST(SmokeLatticeGuards, MediaWithoutAPlaceAreLeftOut)
{
    const Media nowhere{{cube_at(Vec3d(1e39, 0.0, 0.0))}};
    EXPECT_EQ(find_smoke_cells(nowhere, 4.0f, 1000).smoke_count, 0u);
    EXPECT_EQ(make_smoke_lattice(nowhere, 0.5f, 1000).active_count(), 0);
    EXPECT_EQ(TransmittanceMap(nowhere, up).optical_depth(Vec3(0.0f)), 0.0f);
    const Media one_of_two{{cube_at(Vec3d(1e39, 0.0, 0.0)), cube_at(Vec3d(0.0))}};
    EXPECT_GT(make_smoke_lattice(one_of_two, 0.5f, 1000).active_count(), 0);
    const Media far_apart{{cube_at(Vec3d(-3e38, 0.0, 0.0)), cube_at(Vec3d(3e38, 0.0, 0.0))}};
    EXPECT_EQ(make_smoke_lattice(far_apart, 0.5f, 1000).active_count(), 0);
    EXPECT_EQ(make_smoke_lattice({{cube_at(Vec3d(0.0))}}, 0.0f, 1000).active_count(), 0);
}

void expect_depths(const TransmittanceMap& map, Vec3 scale, float most)
{
    for (uint32_t k = 0; k < 50; ++k) {
        const float depth = map.optical_depth(scale * test::some_point(k));
        ASSERT_TRUE(depth >= 0.0f && depth <= most) << depth;
    }
}

TEST(TransmittanceMapGuards, MediaOfAnySizeHaveFiniteDepths)
{
    const Vec3 one(1.0f);
    for (const double size : {1e-6, 1e6, 1e14, 1e20, 1e37}) {
        const Media media{{cube_at(Vec3d(0.0), Vec3d(size), static_cast<float>(5.0 / size))}};
        expect_depths(TransmittanceMap(media, up), static_cast<float>(size) * one, 15.0f);
    }
    // An axis so short that it has no direction in floating point.
    const Media flat{{cube_at(Vec3d(0.0), Vec3d(1e-170, 1.0, 1.0))}};
    TransmittanceMapParams params;
    params.spacing = 0.2f;
    expect_depths(TransmittanceMap(flat, up, params), one, 15.0f);
    // Voxels that are too fine for the distance between two media to be counted in them.
    const Media fine{{cube_at(Vec3d(0.0), Vec3d(1e-9), 1.0f), cube_at(Vec3d(20.0, 20.0, 0.0))}};
    EXPECT_NEAR(TransmittanceMap(fine, up).optical_depth(Vec3(20.0f, 18.0f, 0.0f)), 11.0f, 1.5f);
    const Media media{{cube_at(Vec3d(0.0))}};
    params.node_budget = 0;
    expect_depths(TransmittanceMap(media, up, params), one, 15.0f);
    const Vec3 no_directions[] = {Vec3(0.0f), Vec3(0.1f, 0.0f, 0.0f), Vec3(0.0f, 3.0f, 0.0f)};
    for (const Vec3& wi : no_directions) {
        EXPECT_EQ(TransmittanceMap(media, wi).optical_depth(Vec3(0.0f)), 0.0f);
    }
}

/// Parabolas that start at 0 dip below it by rounding; planes lie before, between and behind cells.
TEST(TransmittanceMapGuards, DepthsAreNeverNegativeAndGrow)
{
    for (uint32_t i = 0; i < 40; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        const Vec3 n = sample_sphere(rng.uniform2());
        Volume volume = test::cube_volume(30, 2.0f, [&](Vec3 p) {
            const float along = glm::dot(p, n);
            return along > 0.4f ? along - 0.4f : (along < -0.4f ? sqr(along + 0.4f) : 0.0f);
        });
        finalize(volume);
        const Vec3 wi = sample_sphere(rng.uniform2());
        TransmittanceMapParams params;
        params.spacing = 0.01f + 0.05f * rng.uniform();
        params.node_budget = 300'000;
        const TransmittanceMap map({{volume}}, wi, params);
        for (int k = 0; k < 200; ++k) {
            const Vec3 x = 2.4f * (rng.uniform3() - 0.5f);
            float before = 0.0f;
            for (int step = 0; step < 20; ++step) {
                const float depth = map.optical_depth(x - 0.1f * static_cast<float>(step) * wi);
                ASSERT_GE(depth, 0.0f);
                // Rounding of coordinates, at slopes of up to 4 per metre.
                ASSERT_GE(depth, before - 2e-5f);
                before = depth;
            }
        }
    }
}

/// A camera on a node sees light of that node, and finite light.
TEST(EnvironmentCacheGuards, CamerasMaySitOnNodes)
{
    for (const float g : {0.0f, 0.9f}) {
        Volume volume = cube_at(Vec3d(0.0));
        volume.phase.g = g;
        const Media media{{volume}};
        DirectionTransmittanceParams params;
        params.node_spacing = 0.5f;
        const auto directions = std::make_shared<const DirectionTransmittance>(media, params);
        const SmokeLattice& lattice = directions->lattice();
        const auto hats = static_cast<size_t>(directions->hats().count());
        for (const Vec3i& node : {lattice.nodes[1], lattice.nodes[lattice.nodes.size() / 2]}) {
            const Vec3 eye = lattice.position(node);
            const EnvironmentCache cache(directions, std::vector<Spectrum>(hats, Spectrum(1.0f)),
                                         media, eye);
            for (const Vec3& x : {eye, eye + 0.1f, eye - 0.3f}) {
                const Spectrum light = cache.inscatter(0, x);
                // A furnace of radiance 1, shadowed.
                EXPECT_TRUE(light.x > 0.0f && light.x < 1.1f) << light.x << ", g " << g;
            }
        }
    }
}

/// Every square of a spot that shines is sampled, also where the spot hardly has anything: around
/// a pixel that is only just bright enough to belong to it.
TEST(EnvironmentSpotsGuards, EverySquareIsSampled)
{
    Buffer2D<Spectrum> pixels(128, 64, Spectrum(0.001f));
    pixels.at(40, 32) = Spectrum(1000.0f);
    pixels.at(41, 32) = Spectrum(20.0001f);  // 2 % of the peak
    EnvironmentLight light;
    light.map = make_environment_map(pixels, "spot");
    const EnvironmentParts parts = split_environment(light);
    ASSERT_EQ(parts.spots.size(), 1u);
    const EnvironmentSpot& spot = parts.spots[0];
    EXPECT_EQ(spot.pixels.size(), 12u);
    float most = 0.0f;
    for (size_t i = 0; i < spot.pixels.size(); ++i) most = std::max(most, spot.table.pmf(i));
    for (size_t i = 0; i < spot.pixels.size(); ++i) {
        EXPECT_GE(spot.table.pmf(i), 0.99e-3f * most) << i;
    }
}

TEST(ReprojectGuards, ProfilesOfAlmostNothingAgree)
{
    RayBins bins;
    bins.count = 2;
    for (int k = 0; k <= 2; ++k) {
        bins.s[k] = static_cast<float>(k);
        bins.tau[k] = k > 0 ? 0x1p-149f : 0.0f;
    }
    EXPECT_NEAR(profile_agreement(bins, bins, {}, 10.0f), 1.0f, 1e-6f);
}

/// Emissive media far from the origin: differences of large squares.
TEST(LocalLightGuards, SpreadsAreNeverNegative)
{
    Volume volume = test::flame();
    for (int i = 0; i < 50; ++i) {
        volume.world_from_object.keys[0].translate = Vec3d(1e5 + 777.7 * i, -2e5, 3e5);
        volume.world_from_object.keys[0].scale = Vec3d(1e-4);
        finalize(volume);
        std::vector<LocalLight> lights;
        add_emissive_volume(volume, make_emissive_bricks(volume), 0, lights);
        ASSERT_EQ(lights.size(), 1u);
        EXPECT_GE(lights[0].spread2, 0.0f);
    }
}

/// Numbers of points on a triangle's rim stay below 1.
TEST(DirectionHitsGuards, NumbersOfTrianglesStayBelowOne)
{
    Scene scene = test::lit_clumps(2.0f);
    const Vec3 corner(-0.3f, 1.0f, -0.2f);
    const Vec3 u(0.7f, 0.0f, 0.1f);
    const Vec3 v(0.1f, 0.2f, 0.9f);
    test::add_surfaces(
        scene, {{test::quad_mesh(corner, v, u), test::diffuse(Spectrum(0.0f), Spectrum(1.0f))}});
    const FrameDomain frame = test::make_domain(scene);
    DirectionTargets finds;
    finds.triangles = true;
    int hits = 0;
    for (uint32_t i = 0; i < 20'000; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        const float along = rng.uniform();
        const Vec3 on_rim[] = {corner + along * u, corner + along * v, corner + u + along * (v - u),
                               corner + u + along * v, corner + v + along * u};
        const Vec3 x(0.1f, -0.5f, 0.2f);
        const Vec3 wi = glm::normalize(on_rim[i % 5] - x);
        for_each_light_along(frame, finds, {x, wi, 0.5f}, 0.5f, [&](const DirectionHit& hit) {
            ++hits;
            ASSERT_TRUE(hit.v.x >= 0.0f && hit.v.x < 1.0f) << hit.v.x;
            ASSERT_TRUE(hit.v.y >= 0.0f && hit.v.y < 1.0f) << hit.v.y;
        });
    }
    EXPECT_GT(hits, 1000);
}

/// Weights beyond all floats, and none at all.
TEST(CombineGuards, ResultsAreFinite)
{
    const Scene scene = test::suns_in_the_image().scene;
    const FrameDomain frame = test::candidates_domain(scene);
    PixelDomain domain;
    BinCounts counts;
    make_pixel_domain(frame, generate_ray(scene.camera, Vec2(4.0f, 3.0f), Vec2(0.5f), 0.5f), domain,
                      counts);
    weigh_bins(frame, domain);
    std::vector<Candidate> candidates;
    Rng rng(1, 0, Stream::Test, 0, 0);
    draw_candidates(frame, domain, 8, rng, candidates);
    Spectrum color;
    const PixelReservoir own = resample(candidates, rng, color);
    ASSERT_GT(own.r.W, 0.0f);
    const ShiftEnd end{frame, domain};
    const auto combined = [&](const CombineRules& rules, const PixelReservoir& mine, float W) {
        Reservoir other = own.r;
        other.W = W;
        Combination combination(rules);
        combination.begin_pixel(mine);
        combination.add_other(end, end, other, 1.0f, {});
        WalkCounts walked;
        combination.trace(scene, scene, walked);
        const PixelReservoir out = combination.finish(0, rng, color);
        EXPECT_TRUE(is_finite(color));
        EXPECT_TRUE(std::isfinite(out.r.W) && std::isfinite(out.r.V));
        return out;
    };
    CombineRules rules;
    EXPECT_GT(combined(rules, own, infinity).r.W, 0.0f);
    rules.averages_V = true;
    PixelReservoir empty;
    empty.r.M = 1.0f;
    EXPECT_EQ(combined(rules, empty, 0.0f).r.W, 0.0f);
}

}  // namespace
}  // namespace mote
