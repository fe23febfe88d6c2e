// Cameras on the borders and corners of cells, bricks and grids, and lights inside voxels.
#include <gtest/gtest.h>

#include "stress/play.h"
#include "stress/stress_scenes.h"

namespace mote {
namespace {

/// 24 voxels of 1/8 m, the first at the origin: cells, bricks and voxels at round numbers.
Volume round_cube()
{
    std::vector<float> values(24 * 24 * 24);
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = 0.5f + 0.5f * std::sin(0.7f * static_cast<float>(i % 577));
    Volume volume;
    volume.name = "round";
    volume.density = make_dense_bricks(Vec3i(24), values, {Mat3(8.0f), Vec3(0.0f)});
    volume.albedo = Spectrum(0.8f);
    volume.density_scale = 2.0f;
    finalize(volume);
    return volume;
}

/// On a voxel, a face of a cell, an edge of a cell, a corner of bricks, the outermost voxel, the
/// end of the reconstruction (one voxel beyond), and just outside.
const Vec3 places[] = {
    {1.0f, 1.0f, 1.0f},       {0.5f, 0.53f, 0.57f},     {0.5f, 0.5f, 0.57f},
    {2.0f, 2.0f, 2.0f},       {2.875f, 2.875f, 2.875f}, {3.0f, 1.5f, 1.5f},
    {-0.125f, -0.125f, 1.0f}, {0.0f, 0.0f, 0.0f},       {3.0f + 1e-6f, 1.0f, 1.0f}};

Scene camera_at(Vec3 place)
{
    Scene scene = test::lit_by_all(round_cube());
    Trs pose;
    pose.translate = Vec3d(place);
    scene.camera.world_from_camera.keys = {pose};
    scene.camera.tan_half_fov_y = 1.0f;
    return scene;
}

TEST(StressPlaces, CamerasOnBordersSeeSoundPictures)
{
    for (const Vec3& place : places) {
        test::expect_sound_in_every_way(camera_at(place), "camera " + std::to_string(place.x), 2);
    }
}

TEST(StressPlacesStat, CamerasOnBordersSeeThePathTracersPicture)
{
    for (const Vec3& place : {places[0], places[4]}) {
        Scene scene = camera_at(place);
        scene.camera.width = 8;
        scene.camera.height = 6;
        test::expect_agreement(scene, "camera " + std::to_string(place.x), {12, 2, 8, 200});
    }
}

TEST(StressPlaces, AStepAcrossABorderIsNotSeen)
{
    // Density is continuous: 1e-6 m to either side, depths differ by some 1e-6 times sigma_t.
    const Volume volume = round_cube();
    for (const Vec3& place : places) {
        for (uint32_t i = 0; i < 200; ++i) {
            Rng rng(4, 0, Stream::Test, i, 0);
            const Vec3 d = glm::normalize(rng.uniform3() - 0.5f);
            const float at = optical_depth(volume, {place, d, 0.0f}, {0.0f, infinity});
            for (const float step : {-1e-6f, 1e-6f}) {
                const Ray beside{place + Vec3(step), d, 0.0f};
                EXPECT_NEAR(optical_depth(volume, beside, {0.0f, infinity}), at, 1e-4f)
                    << place.x << " " << place.y << " " << place.z;
            }
        }
    }
}

TEST(StressPlaces, LightsOnBordersAndInOneAnother)
{
    for (const float density : {2.0f, 1e6f}) {
        Scene scene = camera_at({1.5f, 1.5f, 6.0f});
        scene.media.volumes[0].density_scale = density;
        finalize(scene.media.volumes[0]);
        for (const Vec3& place : places) {
            scene.lights.push_back(PointLight{place, Spectrum(1.0f)});
            scene.lights.push_back(PointLight{place, Spectrum(1.0f)});
            scene.lights.push_back(SphereLight{place, 1e-3f, Spectrum(100.0f)});
            scene.lights.push_back(
                QuadLight{place, {0.125f, 0.0f, 0.0f}, {0.0f, 0.125f, 0.0f}, Spectrum(1.0f), true});
        }
        scene.lights.push_back(PointLight{{1.5f, 1.5f, 6.0f}, Spectrum(1.0f)});  // in the camera
        test::expect_sound_in_every_way(scene, "density " + std::to_string(density), 2);
    }
}

}  // namespace
}  // namespace mote
