#include <sys/resource.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/sanitizers.h"
#include "support/damage.h"
#include "support/temporary_folder.h"
#include "surfaces/load_mesh.h"
#include "surfaces/meshes.h"

// Damaged files end in a mesh that is safe to render or in one Error that names the file; nothing
// crashes, hangs or asks for memory out of proportion to the file.
namespace mote {
namespace {

long peak_kilobytes()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

void expect_safe(const Mesh& mesh)
{
    for (const glm::uvec3& t : mesh.triangles) {
        for (int c = 0; c < 3; ++c) {
            ASSERT_LT(t[c], mesh.positions.size());
            ASSERT_TRUE(is_finite(mesh.positions[t[c]]));
        }
    }
    ASSERT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
}

/// 500 damages of one file, 5000 in the long form.
void read_damaged(const char* name, const std::string& whole)
{
    const long before = peak_kilobytes();
    const uint32_t trials = std::getenv("MOTE_LONG_TESTS") ? 5000 : 500;
    const TemporaryFolder folder;
    uint32_t refused = 0;
    for (uint32_t trial = 0; trial < trials; ++trial) {
        const std::string path = folder.write(name, test::damage(whole, trial));
        try {
            Mesh mesh = std::string(name).ends_with("obj") ? read_obj(path) : read_ply_mesh(path);
            (void)finish_mesh(mesh, path);
            expect_safe(mesh);
        } catch (const Error& e) {
            ++refused;
            EXPECT_TRUE(std::string_view(e.what()).starts_with(path)) << e.what();
            EXPECT_EQ(std::string_view(e.what()).find('\n'), std::string::npos);
        }
    }
    EXPECT_GT(refused, trials / 10) << name;
    // The address sanitizer holds 256 MiB of freed memory back.
    const long held_back = is_instrumented ? 256 * 1024 : 0;
    EXPECT_LT(peak_kilobytes() - before, 100'000 + held_back);
}

const Mesh flat = test::box_mesh(Vec3(-1.0f), Vec3(1.0f), false, 3);
const Mesh smooth = test::sphere_mesh(1.0f, 6);

TEST(MutatedMeshes, Obj)
{
    read_damaged("f.obj", test::obj_text(flat));
}

TEST(MutatedMeshes, ObjWithNormals)
{
    read_damaged("s.obj", test::obj_text(smooth));
}

TEST(MutatedMeshes, AsciiPly)
{
    read_damaged("a.ply", test::ply_bytes(flat, false));
}

TEST(MutatedMeshes, BinaryPly)
{
    read_damaged("b.ply", test::ply_bytes(smooth, true));
}

}  // namespace
}  // namespace mote
