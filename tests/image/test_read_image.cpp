#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/rng.h"
#include "image/color.h"
#include "image/exr.h"
#include "image/png.h"
#include "image/read_image.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

LayeredImage rgb_exr(const std::vector<std::string>& names)
{
    LayeredImage image{5, 4, {}, {}};
    float value = 0.0f;
    for (const std::string& name : names) {
        Channel channel{name, PixelType::Float, Buffer2D<float>(5, 4)};
        for (float& v : channel.data) v = value += 0.25f;
        image.channels.push_back(channel);
    }
    return image;
}

TEST(ReadImage, ExrAsStored)
{
    const TemporaryFolder folder;
    const LayeredImage exr = rgb_exr({"R", "G", "B", "A", "volume_direct.R"});
    write_exr(folder.file("a.EXR"), exr, ExrCompression::Zip);
    const Buffer2D<Spectrum> read = read_image(folder.file("a.EXR"));
    ASSERT_EQ(read.width(), 5);
    ASSERT_EQ(read.height(), 4);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 5; ++x) {
            for (int c = 0; c < 3; ++c) {
                EXPECT_EQ(read.at(x, y)[c], exr.channels[static_cast<size_t>(c)].data.at(x, y));
            }
        }
    }
}

TEST(ReadImage, GreyExrFillsAllChannels)
{
    const TemporaryFolder folder;
    write_exr(folder.file("a.exr"), rgb_exr({"Y"}), ExrCompression::Zip);
    EXPECT_EQ(read_image(folder.file("a.exr")).at(1, 0), Spectrum(0.5f));
    write_exr(folder.file("b.exr"), rgb_exr({"P.X", "P.Y", "P.Z"}), ExrCompression::Zip);
    expect_error([&] { (void)read_image(folder.file("b.exr")); }, ExitCode::Input,
                 {"no R, G and B"});
}

TEST(ReadImage, PngIsDecodedFromSrgb)
{
    const TemporaryFolder folder;
    Buffer2D<Spectrum> image(9, 7);
    Rng rng(1, 0, Stream::Test, 0, 0);
    for (Spectrum& s : image) s = rng.uniform3();
    write_png(folder.file("a.png"), image, {0.0f, ViewTransform::Srgb});
    const Buffer2D<Spectrum> ours = read_png(folder.file("a.png"));
    const Buffer2D<Spectrum> read = read_image(folder.file("a.png"));
    ASSERT_EQ(read.size(), ours.size());
    for (int y = 0; y < 7; ++y) {
        for (int x = 0; x < 9; ++x) {
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(read.at(x, y)[c], ours.at(x, y)[c], 1e-6f);
        }
    }
}

TEST(ReadImage, RadianceHdrKnownValues)
{
    // RGBE: value = (mantissa + 0.5 or + 0, by reader) / 256 * 2^(exponent - 128). Flat pixels.
    const TemporaryFolder folder;
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    const std::string pixels("\x80\x40\x20\x81\x00\x00\x00\x00", 8);
    write_bytes(folder.file("a.hdr"), header + pixels);
    const Buffer2D<Spectrum> read = read_image(folder.file("a.hdr"));
    ASSERT_EQ(read.width(), 2);
    EXPECT_NEAR(read.at(0, 0).x, 1.0f, 0.005f);
    EXPECT_NEAR(read.at(0, 0).y, 0.5f, 0.005f);
    EXPECT_NEAR(read.at(0, 0).z, 0.25f, 0.005f);
    EXPECT_EQ(read.at(1, 0), Spectrum(0.0f));
}

TEST(ReadImage, ImpossibleRadianceIsCountedAndZero)
{
    const TemporaryFolder folder;
    LayeredImage image = rgb_exr({"R", "G", "B"});
    image.channels[0].data.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
    image.channels[1].data.at(1, 0) = std::numeric_limits<float>::infinity();
    image.channels[2].data.at(2, 0) = -1.0f;
    write_exr(folder.file("a.exr"), image, ExrCompression::None);
    ImageReadReport report;
    const Buffer2D<Spectrum> read = read_image(folder.file("a.exr"), &report);
    EXPECT_EQ(report.non_finite, 2);
    EXPECT_EQ(report.negative, 1);
    EXPECT_EQ(read.at(0, 0).x, 0.0f);
    EXPECT_EQ(read.at(2, 0).z, 0.0f);
}

TEST(ReadImage, OnlyListedFormatsByNameAndContent)
{
    const TemporaryFolder folder;
    write_png(folder.file("a.png"), Buffer2D<Spectrum>(2, 2), {});
    const std::string png = read_bytes(folder.file("a.png"));
    for (const char* name : {"a.exr", "a.hdr"}) {
        write_bytes(folder.file(name), png);
        expect_error([&] { (void)read_image(folder.file(name)); }, ExitCode::Input,
                     {name, "in spite of its name"});
    }
    for (const char* name : {"a.tga", "a.psd", "a.vdb", "a", "a.png.mp4"}) {
        write_bytes(folder.file(name), png);
        expect_error([&] { (void)read_image(folder.file(name)); }, ExitCode::Input,
                     {name, "only .exr, .hdr, .png and .jpg"});
    }
    expect_error([&] { (void)read_image(folder.file("none.hdr")); }, ExitCode::Input,
                 {"none.hdr", "No such file"});
}

TEST(ReadImage, MutatedFilesNeverCrash)
{
    const TemporaryFolder folder;
    write_exr(folder.file("a.exr"), rgb_exr({"R", "G", "B"}), ExrCompression::Zip);
    write_png(folder.file("a.png"), Buffer2D<Spectrum>(20, 10, Spectrum(0.2f)), {});
    write_bytes(folder.file("a.hdr"),
                "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + std::string(128, '\x81'));
    int refused = 0;
    for (uint32_t i = 0; i < 150; ++i) {
        const std::string name = i % 3 == 0 ? "a.exr" : i % 3 == 1 ? "a.png" : "a.hdr";
        Rng rng(23, 0, Stream::Test, i, 0);
        std::string bytes = read_bytes(folder.file(name));
        if (i % 2 == 0) bytes.resize(rng.next() % bytes.size());
        for (int k = 0; k < 3 && !bytes.empty(); ++k) {
            bytes[rng.next() % bytes.size()] = static_cast<char>(rng.next());
        }
        const std::string path = folder.file("b" + name);
        write_bytes(path, bytes);
        try {
            (void)read_image(path);
        } catch (const Error& error) {
            ++refused;
            EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(ExitCode::Input));
        }
    }
    EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace mote
