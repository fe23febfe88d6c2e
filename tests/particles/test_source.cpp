#include "particles/source.h"

#include <gtest/gtest.h>

#include "particles/cache_samples.h"
#include "particles/source_info.h"
#include "particles/write_points.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

constexpr double fps = 24.0;

TEST(Source, FractionalFramesMoveAlongTheVelocity)
{
    const TemporaryFolder folder;
    folder.write("s.0001.csv", "x,y,z,vx,vy,vz,age\n0,0,0,24,0,0,1\n");
    folder.write("s.0002.csv", "x,y,z,vx,vy,vz,age\n1,0,0,24,0,0,2\n");
    CacheParams cache;
    cache.sequence.pattern = "s.####.csv";
    const auto at = [&](double frame) { return particles_at(cache, frame, fps, folder.path()); };
    EXPECT_EQ(at(1.0).position[0].x, 0.0f);
    EXPECT_FLOAT_EQ(at(1.25).position[0].x, 0.25f);
    EXPECT_FLOAT_EQ(at(1.25).age[0], 1.0f + 0.25f / 24.0f);
    EXPECT_EQ(at(2.5).position[0].x, 1.0f);  // held: standing still, not twitching
    EXPECT_EQ(at(0.5).position[0].x, 0.0f);
    const AttributeMask none{false, false, false, false, false};
    const ParticleSet moved = particles_at(cache, 1.5, fps, folder.path(), none);
    EXPECT_FLOAT_EQ(moved.position[0].x, 0.5f);
    EXPECT_TRUE(moved.velocity.empty());
    cache.sequence.outside = OutsideRange::Hide;
    EXPECT_EQ(at(3.0).size(), 0u);
    cache.sequence.outside = OutsideRange::Loop;
    EXPECT_EQ(at(3.0).position[0].x, 0.0f);
    EXPECT_EQ(error_message([&] { (void)at(1e300); }), "frame 1e+300 is out of range");
    EXPECT_EQ(error_message([&] { (void)particles_at(cache, 1.0, 0.0, ""); }),
              "fps must be above 0, not 0");
}

TEST(Source, VersionChangesExactlyWithTheParticles)
{
    const TemporaryFolder folder;
    folder.write("s.1.csv", "x,y,z\n0,0,0\n");
    folder.write("s.2.csv", "x,y,z\n1,0,0\n");
    CacheParams cache;
    cache.sequence.pattern = "s.#.csv";
    const auto version = [&](const SourceParams& source, double frame) {
        return source_version(source, frame, fps, folder.path());
    };
    EXPECT_NE(version(cache, 1), version(cache, 2));
    EXPECT_EQ(version(cache, 2), version(cache, 3));  // held
    EXPECT_EQ(version(cache, 2), version(cache, 3.5));
    const uint64_t before = version(cache, 1);
    folder.write("s.1.csv", "x,y,z\n0,0,0\n1,1,1\n");
    EXPECT_NE(version(cache, 1), before);
    CacheParams larger = cache;
    larger.radius_scale = 2.0f;
    EXPECT_NE(version(cache, 1), version(larger, 1));

    EmitterParams plume;
    EXPECT_EQ(version(plume, 5), version(plume, 5));
    EXPECT_NE(version(plume, 5), version(plume, 6));
    EmitterParams other = plume;
    other.seed = 2;
    EXPECT_NE(version(plume, 5), version(other, 5));
    other = plume;
    other.start_time = 100.0f;
    EXPECT_EQ(version(other, 5), version(other, 6));  // nothing there yet
}

TEST(SourceInfo, DescribesCountRangesAndSpeed)
{
    const TemporaryFolder folder;
    const ParticleInfo info = describe_particle_file(folder.write("a.csv", sample_csv()));
    EXPECT_EQ(info.count, 3);
    EXPECT_EQ(info.bounds.lo, Vec3(0.5f, -3.5f, -2.0f));
    EXPECT_EQ(info.bounds.hi, Vec3(8.0f, 1.0f, 4.0f));
    EXPECT_EQ(info.total_mass, 7.0);
    EXPECT_FLOAT_EQ(info.largest_speed, std::sqrt(4.25f));
    ASSERT_EQ(info.attributes.size(), 8u);
    EXPECT_EQ(info.attributes[4].name, "temperature");
    EXPECT_EQ(info.attributes[4].unit, "K");
    EXPECT_EQ(info.attributes[4].hi[0], 1200.5);
    EXPECT_EQ(info.memory_bytes, 3 * (3 * 12 + 4 * 4 + 8));
    EXPECT_TRUE(describe_particles({}).bounds.is_empty());
}

TEST(SourceInfo, AHeaderNamesTheAttributesWithoutReadingParticles)
{
    const TemporaryFolder folder;
    const std::string bad_row = folder.write("a.csv", "x,y,z,vx,vy,vz,T\nno number\n");
    const ParticleHeader csv = describe_particle_header(bad_row);
    ASSERT_TRUE(csv.attributes);
    EXPECT_EQ(*csv.attributes, (std::vector<std::string>{"position", "velocity", "temperature"}));
    EXPECT_THROW((void)describe_particle_file(bad_row), Error);

    const std::string ply = sample_ply(SamplePly::Little);
    const ParticleHeader header = describe_particle_header(folder.write("a.ply", ply));
    ASSERT_TRUE(header.attributes);
    EXPECT_EQ(header.attributes->size(), 8u);
    // A file cut short no longer holds what its header claims.
    const std::string cut = folder.write("cut.ply", ply.substr(0, ply.size() / 2));
    EXPECT_THROW((void)describe_particle_header(cut), Error);
    EXPECT_THROW((void)describe_particle_header(folder.file("none.ply")), Error);

    const std::string vdb = folder.file("a.vdb");
    write_points(vdb, sample_particles());
    EXPECT_FALSE(describe_particle_header(vdb).attributes);
    write_bytes(vdb, "no vdb");
    EXPECT_THROW((void)describe_particle_header(vdb), Error);
}

}  // namespace
}  // namespace mote
