// Particles at the ends: one, many in one place, without size, larger than their grid, nonsense.
#include <gtest/gtest.h>

#include "particles/clouds.h"
#include "particles/rasterize.h"
#include "stress/play.h"
#include "stress/stress_scenes.h"
#include "support/expect_error.h"
#include "volumes/make_bricks.h"

namespace mote {
namespace {

/// The scene of a set of particles, in voxels of `size`.
Scene scene_of(const ParticleSet& particles, float size)
{
    const ParticleGrids grids = rasterize(particles, voxels_of(size));
    GridLoadReport report;
    Volume volume;
    volume.density = make_bricks(*grids.density, {}, report);
    EXPECT_EQ(report.non_finite + report.negative, 0);
    volume.density_scale = 0.3f;
    volume.albedo = Spectrum(0.8f);
    finalize(volume);
    return test::lit_by_all(volume);
}

TEST(StressParticles, OneParticleOfAnySizeKeepsItsMassAndIsSeen)
{
    // Zero radius and radii below a voxel cover one; 200 voxels are near the limit of 256.
    for (const auto& [radius, voxel] :
         std::initializer_list<std::pair<float, float>>{{0.0f, 0.1f},
                                                        {1e-30f, 0.1f},
                                                        {0.5f, 0.1f},
                                                        {1.0f, 1.0f},
                                                        {1.0f, 30.0f},
                                                        {0.4f, 0.02f}}) {
        const ParticleSet set = one_particle(Vec3(0.03f, 0.01f, -0.02f), radius);
        EXPECT_NEAR(mass_in(*rasterize(set, voxels_of(voxel)).density), 1.0, 1e-5) << radius;
        const Scene scene = scene_of(set, voxel);
        test::expect_sound_in_every_way(scene, "radius " + std::to_string(radius));
        const LayeredImage image =
            test::play(test::repeated(scene, 1), test::restir_ways()[0], "seen").back();
        EXPECT_GT(test::mean_of(image, "opticalDepth.Y"), 0.0) << radius;
    }
}

TEST(StressParticles, VoxelsOfAnySizeKeepMass)
{
    for (const float voxel : {1e-4f, 1e-2f, 1.0f, 1e4f}) {
        ParticleSet set = random_cloud(50, 10.0f * voxel, 0.0f, 3.0f * voxel, 3);
        EXPECT_NEAR(mass_in(*rasterize(set, voxels_of(voxel)).density) / total_mass(set), 1.0, 1e-5)
            << voxel;
    }
}

TEST(StressParticles, ManyInOnePlaceAreOneOfTheirMass)
{
    ParticleSet many;
    many.position.assign(10'000, Vec3(0.03f, 0.01f, -0.02f));
    many.radius.assign(many.size(), 0.4f);
    many.mass.assign(many.size(), 1e-4f);
    const Scene scene = scene_of(many, 0.1f);
    const Scene single = scene_of(one_particle(many.position[0], 0.4f), 0.1f);
    test::expect_sound_in_every_way(scene, "in one place");
    const auto light = [](const Scene& of) {
        return test::mean_of(
            test::play(test::repeated(of, 1), test::restir_ways()[0], "one place").back(), "G");
    };
    EXPECT_NEAR(light(scene), light(single), 1e-3 * light(single));  // sums of 10,000 floats
}

TEST(StressParticles, RadiiOverTheWholeGridAreRefused)
{
    // Documented: more than 256 voxels are refused, with a way out, before anything is allocated.
    for (const float radius : {30.0f, 1e30f}) {
        expect_error([&] { (void)rasterize(one_particle(Vec3(0.0f), radius), voxels_of(0.1f)); },
                     ExitCode::Memory, {"radius", "voxel_size"});
    }
}

TEST(StressParticles, NonsenseIsLeftOutAndTheRestIsSeen)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    ParticleSet set;
    for (const float bad : {nan, infinity, -infinity, -1.0f}) {
        for (int attribute = 0; attribute < 3; ++attribute) {
            if (attribute == 0 && bad == -1.0f) continue;  // a fine position
            set.position.push_back(Vec3(attribute == 0 ? bad : 0.1f));
            set.radius.push_back(attribute == 1 ? bad : 0.4f);
            set.mass.push_back(attribute == 2 ? bad : 1.0f);
        }
    }
    EXPECT_TRUE(rasterize(set, voxels_of(0.1f)).density->empty());
    set.position.emplace_back(0.0f);
    set.radius.push_back(0.4f);
    set.mass.push_back(1.0f);
    EXPECT_NEAR(mass_in(*rasterize(set, voxels_of(0.1f)).density), 1.0, 1e-5);
    test::expect_sound_in_every_way(scene_of(set, 0.1f), "nonsense beside one particle");
}

TEST(StressParticles, MassesAtBothEndsOfFloat)
{
    for (const float mass : {1e-45f, 1e-38f, 1e-20f, 1e20f, 1e30f, 3e38f}) {
        const Scene scene = scene_of(one_particle(Vec3(0.03f), 0.4f, mass), 0.1f);
        test::expect_sound_in_every_way(scene, "mass " + std::to_string(mass));
    }
}

}  // namespace
}  // namespace mote
