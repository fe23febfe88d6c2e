#include "particles/cache.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "particles/cache_samples.h"
#include "particles/emitter.h"
#include "particles/write_points.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

constexpr double fps = 24.0;

void expect_sample(const ParticleSet& set)
{
    const ParticleSet expected = sample_particles();
    ASSERT_EQ(set.size(), expected.size());
    EXPECT_EQ(set.position, expected.position);
    EXPECT_EQ(set.velocity, expected.velocity);
    EXPECT_EQ(set.radius, expected.radius);
    EXPECT_EQ(set.mass, expected.mass);
    EXPECT_EQ(set.temperature, expected.temperature);
    EXPECT_EQ(set.color, expected.color);
    EXPECT_EQ(set.id, expected.id);
    EXPECT_EQ(set.age, expected.age);
}

ParticleSet read(const TemporaryFolder& folder, const std::string& name, const std::string& bytes,
                 const CacheParams& params = {}, const AttributeMask& mask = {})
{
    return read_particle_file(folder.write(name, bytes), params, fps, mask);
}

TEST(Cache, PlyOfAllKindsGivesTheSameParticles)
{
    const TemporaryFolder folder;
    expect_sample(read(folder, "a.ply", sample_ply(SamplePly::Ascii)));
    expect_sample(read(folder, "l.ply", sample_ply(SamplePly::Little)));
    expect_sample(read(folder, "b.ply", sample_ply(SamplePly::Big)));
}

TEST(Cache, PlyWithWindowsLineEndsAndColoursOfBytes)
{
    const TemporaryFolder folder;
    const ParticleSet set = read(
        folder, "c.ply",
        "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\n"
        "property float z\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\n"
        "end_header\r\n1 2 3 0 188 255\r\n");
    ASSERT_EQ(set.size(), 1u);
    // sRGB 188 is linear 0.50289 (IEC 61966-2-1).
    EXPECT_NEAR(set.color[0].y, 0.50289, 1e-5);
    EXPECT_EQ(set.color[0].x, 0.0f);
    EXPECT_EQ(set.color[0].z, 1.0f);
    EXPECT_EQ(set.radius[0], 0.03f);  // not in the file: the default
    EXPECT_EQ(set.mass[0], 1.0f);     // the total mass, shared by one
}

TEST(Cache, CsvInItsDialects)
{
    const TemporaryFolder folder;
    expect_sample(read(folder, "a.csv", sample_csv()));
    for (const char* text :
         {"x;y;z\n1;2;3\n", "x y  z\n 1\t2 3\n", "x\ty\tz\n1\t2\t3", "# x y z\n1 2 3\n",
          "\xef\xbb\xbfpx,py,pz\n1,2,3\n", "pos[0],pos[1],pos[2]\n1,2,3\n",
          "Position_X,Position_Y,Position_Z\n1,2,3\n",
          "positions:0,positions:1,positions:2\n1,2,3"}) {
        const ParticleSet set = read(folder, "d.csv", text);
        ASSERT_EQ(set.size(), 1u) << text;
        EXPECT_EQ(set.position[0], Vec3(1.0f, 2.0f, 3.0f)) << text;
    }
    std::string many = "x,y,z\n";
    for (int i = 0; i < 5000; ++i) many += std::to_string(i) + ",0,0\n";
    EXPECT_EQ(read(folder, "m.csv", many).size(), 5000u);
    EXPECT_EQ(read(folder, "n.csv", "x,y,z\n").size(), 0u);
}

TEST(Cache, NpyStructuredAndPlain)
{
    const TemporaryFolder folder;
    expect_sample(read(folder, "l.npy", sample_npy(false)));
    expect_sample(read(folder, "b.npy", sample_npy(true)));
    std::string rows;
    std::string columns;
    for (const float x : {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f}) append_bytes(rows, x);
    for (const float x : {1.0f, 4.0f, 2.0f, 5.0f, 3.0f, 6.0f}) append_bytes(columns, x);
    const std::vector<Vec3> expected = {{1.0f, 2.0f, 3.0f}, {4.0f, 5.0f, 6.0f}};
    const auto dictionary = [](bool fortran) {
        return std::string("{'descr': '<f4', 'fortran_order': ") + (fortran ? "True" : "False") +
               ", 'shape': (2, 3)}";
    };
    EXPECT_EQ(read(folder, "c.npy", npy_file(dictionary(false), rows)).position, expected);
    EXPECT_EQ(read(folder, "f.npy", npy_file(dictionary(true), columns, 3)).position, expected);
}

TEST(Cache, AttributeNamesCanBeGivenOrTurnedOff)
{
    const TemporaryFolder folder;
    const std::string text = "x,y,z,a,b,c,size,Cd.r,Cd.g,Cd.b\n1,2,3,4,5,6,7,0,0,0\n";
    CacheParams params;
    params.attributes = {{"velocity", "a, b,c"}, {"radius", "size"}, {"color", ""}};
    const ParticleSet set = read(folder, "a.csv", text, params);
    EXPECT_EQ(set.velocity[0], Vec3(4.0f, 5.0f, 6.0f));
    EXPECT_EQ(set.radius[0], 7.0f);
    EXPECT_TRUE(set.color.empty());
    params.attributes = {{"radius", "siez"}};
    EXPECT_EQ(error_message([&] { (void)read(folder, "a.csv", text, params); }),
              folder.file("a.csv") +
                  ": no attribute \"siez\" of one number to read as radius (did you mean "
                  "\"size\"?); the file has x, y, z, a, b, c, size, Cd.r, Cd.g, Cd.b");
    params.attributes = {{"radus", "size"}};
    EXPECT_EQ(error_message([&] { (void)read(folder, "a.csv", text, params); }),
              "attributes: unknown attribute \"radus\" (did you mean \"radius\"?); known are "
              "position, velocity, radius, mass, density, temperature, color, id, age");
}

TEST(Cache, UnitsAndDefaults)
{
    const TemporaryFolder folder;
    CacheParams params;
    params.velocity_unit = VelocityUnit::PerFrame;
    params.scale = 0.01f;  // centimetres
    params.radius_scale = 2.0f;
    params.mass = 6.0f;
    const ParticleSet set =
        read(folder, "a.csv", "x,y,z,vx,vy,vz,pscale\n100,0,0,1,0,0,5\n1,1,1,0,0,0,1\n", params);
    EXPECT_FLOAT_EQ(set.position[0].x, 1.0f);
    EXPECT_FLOAT_EQ(set.velocity[0].x, 0.24f);  // 1 cm per frame at 24 frames per second
    EXPECT_FLOAT_EQ(set.radius[0], 0.1f);
    EXPECT_FLOAT_EQ(set.mass[0], 3.0f);
    // Density becomes mass with the volume of the support ball.
    const ParticleSet dense = read(folder, "b.csv", "x,y,z,radius,density\n0,0,0,0.5,3\n");
    EXPECT_NEAR(dense.mass[0], 3.0 * 4.0 / 3.0 * 3.14159265 * 0.125, 1e-6);
}

TEST(Cache, BadParticlesAreDropped)
{
    const TemporaryFolder folder;
    const ParticleSet set = read(folder, "a.csv",
                                 "x,y,z,radius,mass,id\nnan,0,0,1,1,0\n0,0,0,1,1,1\n0,inf,0,1,1,2\n"
                                 "0,0,0,-1,1,3\n0,0,0,0,1,4\n0,0,0,1,-1,5\n0,0,1e999,1,1,6\n"
                                 "0,0,0,1,0,7\n0,0,1e300,1,1,8\n0,0,0,1,1,1e300\n");
    EXPECT_EQ(set.id, (std::vector<int64_t>{1, 7}));
}

TEST(Cache, OnlyWantedAttributesAreRead)
{
    const TemporaryFolder folder;
    const AttributeMask none{false, false, false, false, false};
    const ParticleSet set = read(folder, "a.ply", sample_ply(SamplePly::Big), {}, none);
    EXPECT_EQ(set.position, sample_particles().position);
    EXPECT_TRUE(set.velocity.empty() && set.temperature.empty() && set.color.empty() &&
                set.id.empty() && set.age.empty());
}

/// Message without the file's path and the ": " behind it.
std::string failure(const TemporaryFolder& folder, const std::string& name,
                    const std::string& bytes, ExitCode code = ExitCode::Input)
{
    CacheParams params;
    params.max_particles = 1e6f;
    const std::string path = folder.write(name, bytes);
    const std::string message =
        error_message([&] { (void)read_particle_file(path, params, fps); }, code);
    EXPECT_TRUE(message.starts_with(path + ":")) << message;
    return message.substr(std::min(message.size(), path.size() + 1));
}

std::string ply(const std::string& header, const std::string& body = "")
{
    return "ply\nformat ascii 1.0\n" + header + "end_header\n" + body;
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";

TEST(CacheErrors, Ply)
{
    const TemporaryFolder f;
    EXPECT_EQ(failure(f, "a.ply", "plx\n"), "1:1: not a PLY file: the first line must be \"ply\"");
    EXPECT_EQ(failure(f, "a.ply", "ply\nformat asci 1.0\n"), "2:8: unknown format \"asci\"");
    EXPECT_EQ(failure(f, "a.ply", "ply\nformat ascii 2.0\n"), "2:14: unknown version \"2.0\"");
    EXPECT_EQ(failure(f, "a.ply", "ply\nend_header\n"), "2:1: the header has no \"format\" line");
    EXPECT_EQ(failure(f, "a.ply", "ply\nformat ascii 1.0\n"),
              " truncated: the header has no \"end_header\"");
    EXPECT_EQ(failure(f, "a.ply", ply("element vertex -1\n")), "3:16: \"-1\" is not a count");
    EXPECT_EQ(failure(f, "a.ply", ply("element vertex\n")), "3:15: the element's count is missing");
    EXPECT_EQ(failure(f, "a.ply", ply("property float x\n")),
              "3:1: a property before the first element");
    EXPECT_EQ(failure(f, "a.ply", ply("elemnt vertex 1\n")), "3:1: unknown keyword \"elemnt\"");
    EXPECT_EQ(failure(f, "a.ply", ply("element vertex 1\nproperty flot x\n")),
              "4:10: unknown property type \"flot\"; PLY has char, uchar, short, ushort, int, "
              "uint, float and double");
    EXPECT_EQ(failure(f, "a.ply", ply("element face 0\nproperty list uchar int i\n")),
              " no element \"vertex\"");
    EXPECT_EQ(failure(f, "a.ply", ply("element vertex 0\nproperty float a\n")),
              " no positions; name them with attributes.position (three numbers); the file has a");
    EXPECT_EQ(failure(f, "a.ply", ply("element vertex 2\n" + xyz, "0 0 0\n1 2 x3\n")),
              "9:5: \"x3\" is not a number");
    EXPECT_EQ(failure(f, "a.ply", ply("element vertex 2\n" + xyz, "0 0 0\n1 2       \n")),
              "9:11: the row ends before property \"z\"");
    EXPECT_EQ(failure(f, "a.ply", ply("element vertex 2\n" + xyz, "0 0 0 9\n1 2 3\n")),
              "8:7: more numbers than the header names");
    EXPECT_EQ(failure(f, "a.ply", ply("element vertex 2\n" + xyz, "0 0 0          \n")),
              " truncated: it ends after 1 of 2 vertices");
    EXPECT_EQ(failure(f, "a.ply", ply("element vertex 1000000000000\n" + xyz, "0 0 0\n")),
              " the header claims 1000000000000 of element \"vertex\", at least 6 bytes each, but "
              "only 6 bytes follow");
    std::string cut = sample_ply(SamplePly::Little);
    cut.resize(cut.size() - 8);
    EXPECT_EQ(failure(f, "a.ply", cut),
              " truncated: it ends at byte " + std::to_string(cut.size()));
    const std::string list =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty list uint int l\n" + xyz +
        "end_header\n";
    EXPECT_EQ(failure(f, "a.ply", list + std::string(16, '\xff')),
              " list \"l\" of element \"vertex\" claims 4294967295 entries, but only 12 bytes "
              "follow");
    EXPECT_EQ(failure(f, "a.ply", std::string(3'000'000, 'x')),
              "1:1: a line of more than 1048576 bytes");
    EXPECT_EQ(failure(f, "a.ply",
                      "ply\nformat binary_little_endian 1.0\nelement vertex 1000001\n" + xyz +
                          "end_header\n" +
                          std::string(12'000'012, '\0'),  // NOLINT(bugprone-string-constructor)
                      ExitCode::Memory),
              " 1000001 particles, but max_particles is 1000000; raise it if the machine has the "
              "memory (about 60 bytes each)");
}

TEST(CacheErrors, Csv)
{
    const TemporaryFolder f;
    EXPECT_EQ(failure(f, "a.csv", ""), " no row of column names");
    EXPECT_EQ(failure(f, "a.csv", "\n1,2,3\n"),
              "2:1: numbers without names; the first row must name the columns, e.g. "
              "x,y,z,vx,vy,vz");
    EXPECT_EQ(failure(f, "a.csv", "x,y,z\n1,2,3\n1,2,\n"), "3:5: \"\" is not a number");
    EXPECT_EQ(failure(f, "a.csv", "x;y;z\n1,5;2;3\n"), "2:1: \"1,5\" is not a number");
    EXPECT_EQ(failure(f, "a.csv", "x,y,z\n1,2\n"), "2:3: the row has fewer than 3 columns");
    EXPECT_EQ(failure(f, "a.csv", "x,y,z\n1,2,3,4\n"), "2:7: more than 3 columns");
    EXPECT_EQ(failure(f, "a.txt", "a,y,z\n1,2,3\n"),
              " no positions; name them with attributes.position (three numbers); the file has a, "
              "y, z");
}

TEST(CacheErrors, Npy)
{
    const TemporaryFolder f;
    const auto plain = [](const std::string& descr, const std::string& shape) {
        return npy_file(
            "{'descr': " + descr + ", 'fortran_order': False, 'shape': " + shape + ", }",
            std::string(24, '\0'));
    };
    EXPECT_EQ(failure(f, "a.npy", "not numpy at all"), " not a NumPy .npy file");
    EXPECT_EQ(failure(f, "a.npy", npy_file("{}", "", 9)),
              " NumPy format version 9 is unknown; versions 1 to 3 are read");
    EXPECT_EQ(failure(f, "a.npy", std::string("\x93NUMPY\1\0\xff\xff{}", 12)),
              " the header claims 65535 bytes, but only 2 follow");
    EXPECT_EQ(failure(f, "a.npy", plain("'<f4'", "(1000000000000, 3)")),
              " the header claims 1000000000000 rows of 12 bytes, but only 24 bytes follow");
    EXPECT_EQ(failure(f, "a.npy", plain("'<f4'", "(3, 2)")),
              " shape (3, 2) is not a list of particles; it must be (N, 3) for positions alone, or "
              "(N,) with named fields, e.g. dtype [('P', '<f4', (3,)), ('v', '<f4', (3,)), "
              "('pscale', '<f4')]");
    EXPECT_EQ(failure(f, "a.npy", plain("'|O'", "(2, 3)")),
              " dtype \"|O\" cannot be read; save numbers as float32, float64 or integers, e.g. "
              "array.astype(numpy.float32)");
    EXPECT_EQ(failure(f, "a.npy", plain("'<f2'", "(2, 3)")),
              " dtype \"<f2\" cannot be read; save numbers as float32, float64 or integers, e.g. "
              "array.astype(numpy.float32)");
    EXPECT_EQ(failure(f, "a.npy", plain("[('P', [('x', '<f4')])]", "(2,)")),
              " field \"P\" is itself a structure; save flat fields");
    EXPECT_EQ(failure(f, "a.npy", plain("[('a', '<f4')]", "(2,)")),
              " no positions; name them with attributes.position (three numbers); the file has a");
    EXPECT_EQ(failure(f, "a.npy", npy_file("{'descr' '<f4'}", "")),
              " damaged NumPy header: ':' expected at character 9");
    EXPECT_EQ(failure(f, "a.npy", npy_file("{'descr': '<f4'}", "")),
              " damaged NumPy header: \"descr\", \"fortran_order\" or \"shape\" is missing");
    EXPECT_EQ(failure(f, "a.npy", npy_file("{'descr': '<f4', 'evil': 1}", "")),
              " damaged NumPy header: unexpected key \"evil\" at character 24");
    EXPECT_EQ(failure(f, "a.npy", plain("[('P', '<f4', (65000, 65000, 65000))]", "(2,)")),
              " an element of the array has more than 65536 bytes");
}

TEST(CacheErrors, Files)
{
    const TemporaryFolder f;
    const auto message = [](const std::string& path) {
        return error_message([&] { (void)read_particle_file(path, {}, fps); });
    };
    EXPECT_EQ(message(f.file("no.ply")), f.file("no.ply") + ": No such file or directory");
    EXPECT_EQ(message(f.file("no.vdb")), f.file("no.vdb") + ": No such file or directory");
    EXPECT_EQ(message("sim.bgeo.sc"),
              "sim.bgeo.sc: unknown kind of particle file; .vdb points, .ply, .csv and .npy are "
              "read. Houdini writes .vdb points with \"Convert VDB Points\"");
    std::filesystem::create_directory(f.file("folder.ply"));
    EXPECT_EQ(message(f.file("folder.ply")), f.file("folder.ply") + ": not a regular file");
}

}  // namespace
}  // namespace mote
