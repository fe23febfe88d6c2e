#include <gtest/gtest.h>

#include "core/rng.h"
#include "core/sampling.h"
#include "surfaces/meshes.h"
#include "surfaces/one_mesh.h"

namespace mote {
namespace {

using test::make_surfaces;

Trs placed(double scale, Vec3d translate, bool is_turned)
{
    Trs trs;
    trs.scale = Vec3d(scale);
    trs.translate = translate;
    if (is_turned) trs.rotate = glm::angleAxis(0.7, glm::normalize(Vec3d(1.0, -2.0, 0.5)));
    return trs;
}

/// Follows mirror-free random bounces inside a closed mesh and counts rays that get out.
int count_leaks(const Surfaces& surfaces, Vec3 start, uint32_t bounces, uint32_t seed,
                float offset_scale = 1.0f)
{
    Rng rng(seed, 0, Stream::Test, 0, 0);
    Ray ray{start, sample_sphere(rng.uniform2()), 0.0f};
    int leaks = 0;
    for (uint32_t i = 0; i < bounces; ++i) {
        const auto hit = intersect(surfaces, ray, {0.0f, infinity});
        if (!hit) {
            ++leaks;
            ray.o = start;
            continue;
        }
        SurfaceVertex vertex = make_vertex(surfaces, *hit, 0.0f);
        vertex.offset *= offset_scale;
        Vec3 d = sample_sphere(rng.uniform2());
        // A tenth of the rays graze the surface, where they are most likely to slip through.
        if (i % 10 == 0) d = glm::normalize(d - glm::dot(d, vertex.ng) * vertex.ng * 0.999f);
        if (glm::dot(d, vertex.ng) * glm::dot(-ray.d, vertex.ng) < 0.0f) d = -d;
        ray = {ray_origin(vertex, d), d, 0.0f};
    }
    return leaks;
}

TEST(Intersect, NothingLeaksFromClosedMeshesAtAnyScale)
{
    // Size in the mesh and size by transform, at the origin and 10 sizes away from it.
    for (const double scale : {1e-3, 1.0, 1e4}) {
        for (const bool in_mesh : {false, true}) {
            for (const double shift : {0.0, 10.0}) {
                const auto size = static_cast<float>(in_mesh ? scale : 1.0);
                const Vec3d away = scale * shift * Vec3d(1.0, 0.7, -0.4);
                const Trs trs = placed(in_mesh ? 1.0 : scale, away, true);
                const Vec3 start(away);
                // Away from the origin points are rounded to coarser floats: those of a thin slab
                // that lie within half a float of its edges are outside, whatever is done.
                const float thin = shift > 0.0 ? 0.2f : 1e-3f;
                const Mesh meshes[] = {
                    test::box_mesh(Vec3(-size), Vec3(size), true, 3),
                    test::sphere_mesh(size, 40),
                    test::box_mesh(size * Vec3(-1.0f, -thin, -0.3f), size * Vec3(1.0f, thin, 0.3f)),
                };
                for (const Mesh& mesh : meshes) {
                    const Surfaces surfaces = make_surfaces(mesh, trs);
                    EXPECT_EQ(count_leaks(surfaces, start, 20'000, 1), 0)
                        << scale << (in_mesh ? " in the mesh, " : " by transform, ") << shift
                        << ", triangles: " << mesh.triangles.size();
                }
            }
        }
    }
}

/// Hits within a few floats of where two walls meet: the rays that leave from there stay in.
TEST(Intersect, NothingLeaksAtTheEdgesOfClosedMeshes)
{
    for (const double shift : {0.0, 10.0}) {
        const Vec3d away = shift * Vec3d(1.0, 0.7, -0.4);
        const Trs trs = placed(1.0, away, true);
        const Surfaces surfaces = make_surfaces(test::box_mesh(Vec3(-1.0f), Vec3(1.0f), true), trs);
        const InstanceFrame frame = surfaces.bvh->frame_at(0, 0.0f);
        Rng rng(1, 0, Stream::Test, 0, 0);
        int leaks = 0;
        for (int i = 0; i < 20'000; ++i) {
            const double aside = 2e-6 * (rng.uniform() - 0.5);
            const Vec3d at_edge = frame.point({1.0 + aside, 1.0, 2.0 * rng.uniform() - 1.0});
            const Ray to_edge{Vec3(away), Vec3(glm::normalize(at_edge - away)), 0.0f};
            const auto hit = intersect(surfaces, to_edge, {0.0f, infinity});
            if (!hit) continue;  // between two walls; nothing starts there
            const SurfaceVertex vertex = make_vertex(surfaces, *hit, 0.0f);
            const Vec3 d = sample_sphere(rng.uniform2());
            const Vec3 inwards =
                glm::dot(d, vertex.ng) * glm::dot(to_edge.d, vertex.ng) > 0.0f ? -d : d;
            const Ray away_from_edge{ray_origin(vertex, inwards), inwards, 0.0f};
            if (!intersect(surfaces, away_from_edge, {0.0f, infinity})) ++leaks;
        }
        EXPECT_EQ(leaks, 0) << shift;
    }
}

TEST(Intersect, OffsetsAreNeededAndSmall)
{
    // Negative control: without them, or with a hundredth, rays slip through or meet their start.
    const double scale = 1e4;
    const Trs trs = placed(scale, scale * 100.0 * Vec3d(1.0, 0.7, -0.4), true);
    const Surfaces surfaces = make_surfaces(test::sphere_mesh(1.0f, 40), trs);
    EXPECT_GT(count_leaks(surfaces, Vec3(trs.translate), 20'000, 1, 0.0f), 50);
    EXPECT_GT(count_leaks(surfaces, Vec3(trs.translate), 20'000, 1, 0.01f), 5);
    // Where an object is at the origin, they are a few units in the last place of its size.
    const Surfaces unit = make_surfaces(test::box_mesh(Vec3(-1.0f), Vec3(1.0f)), {});
    const auto hit =
        intersect(unit, {Vec3(0.1f, 0.2f, 5.0f), Vec3(0.0f, 0.0f, -1.0f)}, {0.0f, infinity});
    ASSERT_TRUE(hit);
    const SurfaceVertex vertex = make_vertex(unit, *hit, 0.0f);
    EXPECT_GT(vertex.offset, 1e-7f);
    EXPECT_LT(vertex.offset, 1e-5f);
}

TEST(Intersect, HitsAndNormalsInTheWorld)
{
    Trs trs = placed(1.0, Vec3d(3.0, -1.0, 2.0), true);
    trs.scale = Vec3d(2.0, -0.5, 1.5);  // mirrored: the front stays outside
    const Surfaces surfaces = make_surfaces(test::box_mesh(Vec3(-1.0f), Vec3(1.0f), false, 2), trs);
    const Affine world_from_object = to_affine(matrix(trs));
    const glm::mat3 normal_matrix = glm::transpose(glm::inverse(world_from_object.linear));
    for (uint32_t i = 0; i < 200; ++i) {
        Rng rng(2, 0, Stream::Test, i, 0);
        const int axis = static_cast<int>(i % 3);
        Vec3 p = 2.0f * rng.uniform3() - 1.0f;
        p[axis] = i % 2 == 0 ? 1.0f : -1.0f;
        Vec3 n(0.0f);
        n[axis] = p[axis];
        const Vec3 outside = world_from_object.point(p + 3.0f * n);
        const Vec3 target = world_from_object.point(p);
        const float distance = glm::length(target - outside);
        const Ray ray{outside, (target - outside) / distance, 0.0f};
        const auto hit = intersect(surfaces, ray, {0.0f, infinity});
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->t, distance, 1e-5f * distance);
        const SurfaceVertex vertex = make_vertex(surfaces, *hit, 0.0f);
        EXPECT_LT(glm::length(vertex.p - target), 1e-5f);
        EXPECT_LT(glm::length(vertex.ng - glm::normalize(normal_matrix * n)), 1e-5f);
        EXPECT_EQ(vertex.ns, vertex.ng);
        EXPECT_TRUE(is_occluded(surfaces, ray, {0.0f, 1.001f * distance}));
        EXPECT_FALSE(is_occluded(surfaces, ray, {0.0f, 0.999f * distance}));
        EXPECT_FALSE(is_occluded(surfaces, {ray_origin(vertex, -ray.d), -ray.d}, {0.0f, infinity}));
    }
}

TEST(Intersect, TrianglesInTheWorldFaceTheirFront)
{
    Trs trs = placed(0.7, Vec3d(3.0, -1.0, 2.0), true);
    trs.scale.y = -0.5;
    const Surfaces surfaces = make_surfaces(test::box_mesh(Vec3(-1.0f), Vec3(1.0f)), trs);
    double area = 0.0;
    for (size_t i = 0; i < 12; ++i) {
        const WorldTriangle t =
            world_triangle(surfaces.bvh->frame_at(0, 0.0f), surfaces.mesh(0), i);
        const Vec3 n = glm::cross(t.edge_u, t.edge_v);
        area += 0.5 * static_cast<double>(glm::length(n));
        EXPECT_GT(glm::dot(n, t.corner - Vec3(trs.translate)), 0.0f);
        EXPECT_GT(t.offset, 0.0f);
    }
    EXPECT_NEAR(area, 8.0 * (0.49 + 0.35 + 0.35), 1e-5);
}

TEST(Intersect, SmoothNormalsOfASphere)
{
    const Surfaces surfaces =
        make_surfaces(test::sphere_mesh(2.0f, 60), placed(1.5, Vec3d(1.0), true));
    for (uint32_t i = 0; i < 100; ++i) {
        Rng rng(3, 0, Stream::Test, i, 0);
        const Vec3 d = sample_sphere(rng.uniform2());
        const auto hit = intersect(surfaces, {Vec3(1.0f), d}, {0.0f, infinity});
        ASSERT_TRUE(hit);
        const SurfaceVertex vertex = make_vertex(surfaces, *hit, 0.0f);
        EXPECT_LT(glm::length(vertex.ns - d), 2e-3f);
        EXPECT_GT(glm::length(vertex.ng - d), 1e-5f);
    }
}

TEST(Intersect, InstancesMoveWhileTheShutterIsOpen)
{
    MeshInstance moving{std::make_shared<const MeshBvh>(test::box_mesh(Vec3(-1.0f), Vec3(1.0f))),
                        {}};
    MeshInstance still = moving;  // shares the mesh and its tree
    still.world_from_object.keys[0].translate = Vec3d(0.0, 10.0, 0.0);
    for (int i = 0; i <= 4; ++i) {
        Trs key = placed(1.0, Vec3d(2.0 * i, 0.0, 0.0), false);
        key.rotate = glm::angleAxis(0.2 * i, Vec3d(0.0, 0.0, 1.0));
        if (i == 0)
            moving.world_from_object.keys = {key};
        else
            moving.world_from_object.keys.push_back(key);
    }
    Surfaces surfaces;
    surfaces.objects = {{"moving", 0}, {"still", 0}};
    surfaces.materials = {Material{}};
    surfaces.bvh = std::make_shared<const InstanceBvh>(std::vector<MeshInstance>{moving, still});
    for (const float time : {0.0f, 0.1f, 0.25f, 0.6f, 1.0f}) {
        const Trs trs = moving.world_from_object.at(time);
        const Vec3 n(trs.rotate * Vec3d(0.0, 1.0, 0.0));
        // Off the edges between triangles, which points keep clear of.
        const Vec3 top(trs.translate + trs.rotate * Vec3d(0.3, 1.0, 0.1));
        const auto hit = intersect(surfaces, {top + 2.0f * n, -n, time}, {0.0f, infinity});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->object, 0);
        EXPECT_NEAR(hit->t, 2.0f, 1e-5f);
        const SurfaceVertex vertex = make_vertex(surfaces, *hit, time);
        EXPECT_LT(glm::length(vertex.p - top), 1e-5f);
        EXPECT_LT(glm::length(vertex.ng - n), 1e-5f);
        EXPECT_FALSE(is_occluded(surfaces, {ray_origin(vertex, n), n, time}, {0.0f, 1.0f}));
    }
    const Bounds3 box = surfaces.bvh->bounds();
    EXPECT_LE(box.lo.x, -1.0f);
    EXPECT_GE(box.hi.x, 9.0f);
    EXPECT_GE(box.hi.y, 11.0f);
}

}  // namespace
}  // namespace mote
