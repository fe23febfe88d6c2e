#include <embree3/rtcore.h>

#include <benchmark/benchmark.h>

#include "surfaces/meshes.h"
#include "surfaces/surfaces.h"

// Camera rays of 16 x 16 tiles into a room with 24 objects, on one thread: one at a time, as mote
// traces them, and in Embree's packets of eight.
namespace mote {
namespace {

constexpr int width = 640;
constexpr int height = 368;

Surfaces make_room()
{
    Surfaces surfaces;
    surfaces.materials = {Material{}};
    std::vector<MeshInstance> instances;
    const auto add = [&](Mesh mesh, Vec3d place) {
        surfaces.objects.push_back({"object", 0});
        MeshInstance instance{std::make_shared<const MeshBvh>(std::move(mesh)), {}};
        Trs trs;
        trs.translate = place;
        instance.world_from_object.keys = {trs};
        instances.push_back(std::move(instance));
    };
    add(test::box_mesh(Vec3(-3.0f, 0.0f, -4.0f), Vec3(3.0f, 3.0f, 4.0f), true), Vec3d(0.0));
    add(test::box_mesh(Vec3(-1.0f, 0.0f, -0.5f), Vec3(1.0f, 0.1f, 0.5f)), Vec3d(0.0, 0.6, -0.6));
    add(test::sphere_mesh(0.3f, 100), Vec3d(0.4, 0.95, -0.6));
    add(test::sphere_mesh(0.4f, 100), Vec3d(1.5, 0.4, 0.2));
    for (int k = 0; k < 20; ++k) {
        add(test::box_mesh(Vec3(-0.1f), Vec3(0.1f)),
            Vec3d(-2.0 + 0.2 * k, 0.1 * (k % 5), -2.0 + 0.15 * k));
    }
    surfaces.bvh = std::make_shared<const InstanceBvh>(std::move(instances));
    return surfaces;
}

/// Tile by tile, in blocks of 4 x 2 pixels.
std::vector<Ray> camera_rays()
{
    std::vector<Ray> rays;
    for (int tile = 0; tile < width / 16 * (height / 16); ++tile) {
        for (int i = 0; i < 256; ++i) {
            const int x = tile % (width / 16) * 16 + i / 8 % 4 * 4 + i % 4;
            const int y = tile / (width / 16) * 16 + i / 32 * 2 + i / 4 % 2;
            const Vec2 film((static_cast<float>(x) + 0.5f) / width,
                            (static_cast<float>(y) + 0.5f) / height);
            constexpr float aspect = static_cast<float>(height) / width;
            const Vec3 d(2.0f * film.x - 1.0f, (1.0f - 2.0f * film.y) * aspect, -1.6f);
            rays.push_back({Vec3(0.0f, 1.7f, 3.6f), glm::normalize(d), 0.0f});
        }
    }
    return rays;
}

void one_at_a_time(benchmark::State& state)
{
    const Surfaces room = make_room();
    const std::vector<Ray> rays = camera_rays();
    for (auto _ : state) {
        for (const Ray& ray : rays) {
            benchmark::DoNotOptimize(intersect(room, ray, {0.0f, infinity}));
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(rays.size()));
}
BENCHMARK(one_at_a_time);

/// Argument: whether Embree is told that they are coherent.
void packets(benchmark::State& state)
{
    const Surfaces room = make_room();
    const std::vector<Ray> rays = camera_rays();
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = state.range(0) != 0 ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                        : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    alignas(32) const int valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
    for (auto _ : state) {
        for (size_t first = 0; first < rays.size(); first += 8) {
            RTCRayHit8 packet{};
            for (size_t i = 0; i < 8; ++i) {
                const Ray& ray = rays[first + i];
                packet.ray.org_x[i] = ray.o.x;
                packet.ray.org_y[i] = ray.o.y;
                packet.ray.org_z[i] = ray.o.z;
                packet.ray.dir_x[i] = ray.d.x;
                packet.ray.dir_y[i] = ray.d.y;
                packet.ray.dir_z[i] = ray.d.z;
                packet.ray.tfar[i] = infinity;
                packet.ray.mask[i] = ~0u;
                packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
                packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
            }
            rtcIntersect8(valid, room.bvh->embree(), &context, &packet);
            benchmark::DoNotOptimize(packet);
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(rays.size()));
}
BENCHMARK(packets)->Arg(0)->Arg(1);

}  // namespace
}  // namespace mote

BENCHMARK_MAIN();
