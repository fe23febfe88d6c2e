// The same picture at any scale of the world, in voxels of 1e-4 to 1e4 m, and far from the origin.
#include <gtest/gtest.h>

#include "stress/play.h"
#include "stress/stress_scenes.h"

namespace mote {
namespace {

void scale_light(Light& light, float s)
{
    if (auto* point = std::get_if<PointLight>(&light)) {
        point->position *= s;
        point->intensity *= s * s;
    } else if (auto* sphere = std::get_if<SphereLight>(&light)) {
        sphere->position *= s;
        sphere->radius *= s;
    } else if (auto* quad = std::get_if<QuadLight>(&light)) {
        quad->corner *= s;
        quad->edge_u *= s;
        quad->edge_v *= s;
    }
}

enum class ScaleBy { Transform, VoxelSize };

/// Lengths times s, extinctions over s, intensities of points times s^2: the same picture.
Scene scaled(const Scene& one, float s, ScaleBy by)
{
    Scene scene = one;
    for (Trs& pose : scene.camera.world_from_camera.keys) {
        pose.translate *= static_cast<double>(s);
    }
    scene.camera.focus_distance *= s;
    for (Light& light : scene.lights) scale_light(light, s);
    for (Volume& volume : scene.media.volumes) {
        volume.density_scale /= s;
        volume.emission_params.emission_scale /= s;
        if (by == ScaleBy::Transform) {
            volume.world_from_object.keys[0].scale *= static_cast<double>(s);
            volume.world_from_object.keys[0].translate *= static_cast<double>(s);
        } else {
            auto grid = std::make_shared<BrickGrid>(*volume.density);
            grid->index_from_object.linear /= s;
            if (volume.emission == volume.density) volume.emission = grid;
            volume.density = grid;
        }
        finalize(volume);
    }
    return scene;
}

Scene one_scene()
{
    Volume volume = test::clumps(5.0f);
    volume.emission = volume.density;
    volume.emission_params.emission_scale = 0.2f;
    finalize(volume);
    Scene scene = test::lit_by_all(volume);
    scene.camera = test::small_camera({0.5f, 0.4f, 3.2f});
    return scene;
}

void move(Scene& scene, Vec3 by)
{
    for (Trs& pose : scene.camera.world_from_camera.keys) pose.translate += Vec3d(by);
    for (Light& light : scene.lights) {
        if (auto* point = std::get_if<PointLight>(&light)) point->position += by;
        if (auto* sphere = std::get_if<SphereLight>(&light)) sphere->position += by;
        if (auto* quad = std::get_if<QuadLight>(&light)) quad->corner += by;
    }
    for (Volume& volume : scene.media.volumes) {
        for (Trs& pose : volume.world_from_object.keys) pose.translate += Vec3d(by);
        finalize(volume);
    }
}

/// Image means over runs with the same random numbers in both scenes. Rounding sends a path another
/// way now and then: Student's test of the paired differences, false-alarm rate 1e-5, after a
/// tolerance for rounding that is a share of the mean.
void expect_same_picture(const Scene& a, const Scene& b, const test::Way& way, double rounding,
                         const std::string& what)
{
    RunningStats difference;
    RunningStats mean;
    const int frames = uses_history(way.render) ? 2 : 1;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        const auto light = [&](const Scene& scene) {
            return test::mean_of(test::play(test::repeated(scene, frames), way, what, seed).back(),
                                 "G");
        };
        mean.add(light(a));
        difference.add(light(b) - light(a));
    }
    if (std::getenv("MOTE_REPORT")) {
        std::printf("%s, %s: %g +- %g\n", way.name.c_str(), what.c_str(),
                    difference.mean / mean.mean, difference.standard_error() / mean.mean);
    }
    EXPECT_GT(test_zero(estimate_mean(difference), rounding * mean.mean).p, test::alarm)
        << way.name << ", " << what << ": " << difference.mean / mean.mean << " +- "
        << difference.standard_error() / mean.mean;
    EXPECT_LT(difference.standard_error(), 0.05 * mean.mean) << way.name << ", " << what;
}

std::vector<test::Way> some_ways()
{
    std::vector<test::Way> ways = test::restir_ways(2, 1);
    ways.push_back(test::path_way(2, 2));
    return ways;
}

TEST(StressScaleStat, TheWorldsScaleIsNotSeen)
{
    const Scene one = one_scene();
    for (const float s : {1e-6f, 1e-3f, 1e3f, 1e6f}) {
        const Scene other = scaled(one, s, ScaleBy::Transform);
        for (const test::Way& way : some_ways()) {
            expect_same_picture(one, other, way, 1e-3, "scale " + std::to_string(s));
        }
    }
}

TEST(StressScale, PowersOfTwoChangeNoBitOfTheMean)
{
    // They scale floats without rounding, so nothing may differ: there is no hidden length.
    const Scene one = one_scene();
    for (const float s : {0x1p-20f, 0x1p20f}) {
        const Scene other = scaled(one, s, ScaleBy::Transform);
        for (const test::Way& way : test::all_ways(2, 1)) {
            const auto light = [&](const Scene& scene) {
                return test::mean_of(test::play(test::repeated(scene, 2), way, "scale").back(),
                                     "G");
            };
            EXPECT_EQ(light(other), light(one)) << way.name << " " << s;
        }
    }
}

TEST(StressScaleStat, TheVoxelsSizeIsNotSeen)
{
    // Edges of 1e-4 and 1e4 m instead of 2/23 m.
    const Scene one = one_scene();
    for (const float voxel : {1e-4f, 1e4f}) {
        const Scene other = scaled(one, voxel * 23.0f / 2.0f, ScaleBy::VoxelSize);
        for (const test::Way& way : some_ways()) {
            expect_same_picture(one, other, way, 1e-3, "voxel " + std::to_string(voxel));
        }
    }
}

TEST(StressScaleStat, AForgottenFactorIsRejected)
{
    const Scene one = one_scene();
    Scene wrong = scaled(one, 1e3f, ScaleBy::Transform);
    wrong.media.volumes[0].density_scale *= 1.2f;
    finalize(wrong.media.volumes[0]);
    RunningStats difference;
    for (uint32_t seed = 1; seed <= 24; ++seed) {
        const auto light = [&](const Scene& scene) {
            return test::mean_of(
                test::play(test::repeated(scene, 1), test::restir_ways(2, 2)[0], "forgotten", seed)
                    .back(),
                "G");
        };
        difference.add(light(wrong) - light(one));
    }
    EXPECT_LT(test_zero(estimate_mean(difference), 1e-4).p, test::alarm);
}

TEST(StressScaleStat, AMillionMetresFromTheOrigin)
{
    // A world of 10 km: floats hold places there to 1/16 m, 6e-6 of it.
    const Scene near = scaled(one_scene(), 1e4f, ScaleBy::Transform);
    Scene far = near;
    move(far, {1e6f, -1e6f, 1e6f});
    for (const test::Way& way : some_ways()) expect_same_picture(near, far, way, 2e-3, "far");
}

TEST(StressScaleStat, ACameraAMillionMetresAway)
{
    Scene one = one_scene();
    one.camera = test::small_camera({0.0f, 0.0f, 100.0f});
    one.camera.tan_half_fov_y = 0.0125f;
    const Scene far = scaled(one, 1e4f, ScaleBy::Transform);
    for (const test::Way& way : some_ways()) expect_same_picture(one, far, way, 2e-3, "away");
}

TEST(StressScale, SmallThingsAMillionMetresAwayStaySound)
{
    // Floats hold places there to 1/16 m: the picture is coarse, but it is one.
    Scene scene = one_scene();
    move(scene, {1e6f, 1e6f, -1e6f});
    test::expect_sound_in_every_way(scene, "2 m at 1e6 m", 2);
}

}  // namespace
}  // namespace mote
