// Particles at the edge of what can be rasterised, and beyond it.
#include <gtest/gtest.h>

#include <openvdb/openvdb.h>

#include "core/error.h"
#include "particles/clouds.h"
#include "particles/rasterize.h"
#include "particles/rasterize_plan.h"

namespace mote {
namespace {

TEST(Rasterize, ManyCoincidentParticlesAddUp)
{
    // Half a million equal numbers: a plain float sum would drift by percents.
    ParticleSet set;
    set.position.assign(500'000, Vec3(0.797f));  // touches eight leaves
    set.mass.assign(set.size(), 0.1f);
    const ParticleGrids grids = rasterize(set, voxels_of(0.1f));
    EXPECT_NEAR(mass_in(*grids.density) / 50'000.0, 1.0, 1e-5);
}

TEST(Rasterize, EmptyAndMasslessInputGivesAnEmptyGrid)
{
    EXPECT_TRUE(rasterize({}, {}).density->empty());
    EXPECT_TRUE(rasterize(one_particle(Vec3(0.0f), 1.0f, 0.0f), {}).density->empty());
}

TEST(Rasterize, FadedParticlesAreNoFaultButBadValuesAre)
{
    // The log warns of what plan.invalid counts: here a negative and an endless mass, not the 0.
    ParticleSet set = random_cloud(8, 1.0f, 0.1f, 0.2f, 2);
    set.mass[0] = 0.0f;
    EXPECT_EQ(make_raster_plan(set, voxels_of(0.1f)).invalid, 0u);
    set.mass[1] = -1.0f;
    set.mass[2] = infinity;
    EXPECT_EQ(make_raster_plan(set, voxels_of(0.1f)).invalid, 2u);
    const ParticleGrids grids = rasterize(set, voxels_of(0.1f));
    double kept = 0.0;
    for (size_t i = 3; i < 8; ++i) kept += static_cast<double>(set.mass[i]);
    EXPECT_NEAR(mass_in(*grids.density), kept, 1e-5 * kept);
}

TEST(Rasterize, NonFiniteValuesNeverReachTheGrid)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    ParticleSet set = random_cloud(8, 1.0f, 0.1f, 0.2f, 2);
    set.position[0].y = nan;
    set.mass[1] = infinity;
    set.radius[2] = nan;
    set.temperature[3] = nan;
    set.velocity[4].z = infinity;
    RasterizeParams params = voxels_of(0.1f);
    params.channels = {true, true, false};
    const ParticleGrids grids = rasterize(set, params);
    double kept = 0.0;
    for (size_t i = 5; i < 8; ++i) kept += static_cast<double>(set.mass[i]);
    EXPECT_NEAR(mass_in(*grids.density), kept, 1e-5 * kept);
    for (auto v = grids.velocity->cbeginValueOn(); v; ++v) ASSERT_TRUE(v->isFinite());
    for (auto t = grids.temperature->cbeginValueOn(); t; ++t) ASSERT_TRUE(std::isfinite(*t));
}

TEST(Rasterize, HugeEmptyDomainsCostNothing)
{
    // Two clusters 100,000 voxels apart, and one at the far end of float's whole numbers.
    ParticleSet set = random_cloud(2000, 1.0f, 0.1f, 0.2f, 8);
    for (size_t i = 0; i < 1000; ++i) set.position[i] += Vec3(1e4f, -1e4f, 1e4f);
    set.position[0] = Vec3(1.6e6f, 0.0f, 0.0f);
    const ParticleGrids grids = rasterize(set, voxels_of(0.1f));
    EXPECT_NEAR(mass_in(*grids.density) / total_mass(set), 1.0, 1e-5);
    EXPECT_LT(grids.density->tree().leafCount(), 200u);
}

/// Message of the error that rasterize() throws; "" if it does not.
std::string error_of(const ParticleSet& set, const RasterizeParams& params, ExitCode code)
{
    try {
        (void)rasterize(set, params);
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), code);
        return e.what();
    }
    return "";
}

TEST(Rasterize, BudgetIsCheckedAndTheMessageNamesTheRemedy)
{
    const ParticleSet set = random_cloud(1000, 1.0f, 0.1f, 0.1f, 1);
    RasterizeParams params = voxels_of(0.01f);
    params.max_voxels = 100'000;
    const std::string message = error_of(set, params, ExitCode::Memory);
    EXPECT_NE(message.find("raise voxel_size"), std::string::npos) << message;
    EXPECT_NE(message.find("radius"), std::string::npos) << message;

    const std::string wide =
        error_of(one_particle(Vec3(0.0f), 100.0f), voxels_of(0.01f), ExitCode::Memory);
    EXPECT_NE(wide.find("particle 0: radius 100 m is 10000 voxels"), std::string::npos) << wide;
}

TEST(Rasterize, BadInputIsAnError)
{
    const std::string far =
        error_of(one_particle(Vec3(3e8f), 0.1f), voxels_of(0.1f), ExitCode::Input);
    EXPECT_NE(far.find("32-bit"), std::string::npos) << far;
    EXPECT_NE(error_of({}, voxels_of(0.0f), ExitCode::Input), "");
    EXPECT_NE(error_of({}, voxels_of(-infinity), ExitCode::Input), "");
    EXPECT_NE(error_of({}, voxels_of(1e-20f), ExitCode::Input), "");
    ParticleSet torn = one_particle(Vec3(0.0f), 1.0f);
    torn.mass = {1.0f, 2.0f};
    EXPECT_NE(error_of(torn, {}, ExitCode::Input), "");
}

}  // namespace
}  // namespace mote
