// Rays with zero components, along faces and edges of cells.
#include <gtest/gtest.h>

#include "restir/domains.h"
#include "stress/play.h"
#include "stress/stress_scenes.h"

namespace mote {
namespace {

/// All directions with components -1, 0, 1, with zeros of both signs and almost-zeros among them.
std::vector<Vec3> odd_directions()
{
    std::vector<Vec3> out;
    const float parts[] = {-1.0f, -1e-30f, -0.0f, 0.0f, 1e-30f, 1.0f};
    for (const float x : parts) {
        for (const float y : parts) {
            for (const float z : parts) {
                if (std::max({std::abs(x), std::abs(y), std::abs(z)}) < 0.5f) continue;
                const Vec3 d = glm::normalize(Vec3(x, y, z));
                out.emplace_back(x == 0.0f ? x : d.x, y == 0.0f ? y : d.y, z == 0.0f ? z : d.z);
            }
        }
    }
    return out;
}

TEST(StressDirections, DomainsAreSoundAndTheirNumbersComeBack)
{
    // A grid whose cells lie on round numbers of 1/8 m, so that rays run in their faces and edges.
    Volume volume;
    std::vector<float> values(16 * 16 * 16, 1.0f);
    for (size_t i = 0; i < values.size(); i += 3) values[i] = 0.0f;
    volume.density = make_dense_bricks(Vec3i(16), values, {Mat3(8.0f), Vec3(8.0f)});
    volume.density_scale = 3.0f;
    finalize(volume);
    const Scene scene = test::lit_by_all(volume);
    const FrameDomain frame = test::make_domain(scene);
    for (const Vec3& d : odd_directions()) {
        for (const Vec3& through : {Vec3(0.0f), Vec3(0.125f), Vec3(0.06f, 0.125f, 0.031f)}) {
            const Ray ray{through - 4.0f * d, d, 0.0f};
            PixelDomain domain;
            BinCounts counts;
            make_pixel_domain(frame, ray, domain, counts);
            // Against the walk that serves shadow rays: rounding of depths, and of the ray's place.
            EXPECT_NEAR(domain.bins.depth(), optical_depth(scene.media, ray, {0.0f, infinity}),
                        1e-3f * domain.bins.depth() + 1e-4f);
            ASSERT_FALSE(domain.bins.empty());
            weigh_bins(frame, domain);
            ASSERT_TRUE(std::isfinite(domain.Z()) && domain.Z() > 0.0f);
            for (const float u : {0.0f, 0.3f, one_minus_epsilon}) {
                const RayPoint point = point_at(frame, domain, u);
                ASSERT_TRUE(is_finite(point.x) && std::isfinite(point.weight));
                ASSERT_GE(point.weight, 0.0f);
            }
        }
    }
}

TEST(StressDirections, CamerasThatLookAlongAxesSeeSoundPictures)
{
    // Odd film sizes and a narrow lens: rays within 1e-7 of the axis.
    for (const Vec3& from : {Vec3(3.0f, 0.0f, 0.0f), Vec3(0.0f, 0.0f, -3.0f),
                             Vec3(0.0f, 3.0f, 1e-6f), Vec3(3.0f, 0.0f, 3.0f)}) {
        Scene scene = test::lit_by_all(test::clumps(4.0f));
        scene.camera = test::stress_camera(from);
        scene.camera.tan_half_fov_y = 1e-7f;
        test::expect_sound_in_every_way(scene, "along " + std::to_string(from.x), 2);
    }
}

}  // namespace
}  // namespace mote
