#include <fstream>
#include <sstream>

#include <sys/resource.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/sanitizers.h"
#include "particles/cache.h"
#include "particles/cache_samples.h"
#include "particles/emitter.h"
#include "particles/write_points.h"
#include "support/damage.h"
#include "support/temporary_folder.h"

// Damaged files end in particles or in one Error that names the file; nothing crashes, hangs (the
// test's own time limit) or asks for memory out of proportion to the file.
namespace mote {
namespace {

struct Outcome {
    int read = 0;
    int refused = 0;
};

Outcome read_damaged(const std::string& name, const std::string& whole, uint32_t trials)
{
    const TemporaryFolder folder;
    Outcome outcome;
    for (uint32_t trial = 0; trial < trials; ++trial) {
        const std::string path = folder.write(name, test::damage(whole, trial));
        try {
            const ParticleSet set = read_particle_file(path, {}, 24.0);
            ++outcome.read;
            EXPECT_LE(set.size(), 4096 + 2 * whole.size());
            for (size_t i = 0; i < set.size(); ++i) {
                EXPECT_TRUE(is_finite(set.position[i]) && set.radius[i] > 0.0f);
            }
        } catch (const Error& e) {
            ++outcome.refused;
            EXPECT_TRUE(std::string_view(e.what()).starts_with(path)) << e.what();
            EXPECT_EQ(std::string_view(e.what()).find('\n'), std::string_view::npos);
        }
    }
    return outcome;
}

long peak_kilobytes()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

std::string points_file(const ParticleSet& set)
{
    const TemporaryFolder folder;
    write_points(folder.file("p.vdb"), set);
    std::ifstream in(folder.file("p.vdb"), std::ios::binary);
    std::stringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
}

ParticleSet many_particles()
{
    EmitterParams params;
    params.count = 200;
    return emit_particles(params, 5.0);
}

TEST(Mutated, TextAndBinaryFiles)
{
    const long before = peak_kilobytes();
    const std::pair<const char*, std::string> files[] = {
        {"a.ply", sample_ply(SamplePly::Ascii)},
        {"l.ply", sample_ply(SamplePly::Little)},
        {"b.ply", sample_ply(SamplePly::Big)},
        {"c.csv", sample_csv()},
        {"l.npy", sample_npy(false)},
        {"b.npy", sample_npy(true)},
    };
    for (const auto& [name, whole] : files) {
        const Outcome outcome = read_damaged(name, whole, 150);
        EXPECT_GT(outcome.read, 0) << name;      // some damage only changes numbers
        EXPECT_GT(outcome.refused, 30) << name;  // most of it is noticed
    }
    // The address sanitizer holds 256 MiB of freed memory back.
    const long held_back = is_instrumented ? 256 * 1024 : 0;
    EXPECT_LT(peak_kilobytes() - before, 100'000 + held_back);
}

TEST(Mutated, VdbPoints)
{
    const std::string whole = points_file(many_particles());
    const long before = peak_kilobytes();
    const uint32_t trials = std::getenv("MOTE_LONG_TESTS") ? 2000 : 150;
    const Outcome outcome = read_damaged("p.vdb", whole, trials);
    EXPECT_GT(outcome.read, 0);
    EXPECT_GT(outcome.refused, 30);
    EXPECT_LT(peak_kilobytes() - before, 100'000);
}

}  // namespace
}  // namespace mote
