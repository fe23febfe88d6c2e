#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include <png.h>

#include "core/rng.h"
#include "image/color.h"
#include "image/contact_sheet.h"
#include "image/png.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

TEST(Color, SrgbKnownValues)
{
    // IEC 61966-2-1: linear 0.0031308 is the end of the straight part; 0.5 is code 187.5 of 255.
    EXPECT_EQ(encode_srgb(0.0f), 0.0f);
    EXPECT_EQ(encode_srgb(1.0f), 1.0f);
    EXPECT_NEAR(encode_srgb(0.0031308f), 0.0404499f, 1e-6f);
    EXPECT_NEAR(encode_srgb(0.5f), 0.735357f, 1e-6f);
    EXPECT_NEAR(encode_srgb(0.18f), 0.461356f, 1e-6f);
    EXPECT_EQ(encode_srgb(-1.0f), 0.0f);
    EXPECT_EQ(encode_srgb(7.0f), 1.0f);
    EXPECT_EQ(encode_srgb(std::nanf("")), 0.0f);
    for (int code = 0; code < 256; ++code) {
        const float encoded = static_cast<float>(code) / 255.0f;
        EXPECT_NEAR(encode_srgb(decode_srgb(encoded)), encoded, 1e-6f);
    }
}

TEST(Color, FilmicCurveRisesAndKeepsMiddleGrey)
{
    EXPECT_NEAR(filmic_curve(0.18f), 0.18f, 1e-4f);
    EXPECT_EQ(filmic_curve(0.0f), 0.0f);
    EXPECT_EQ(filmic_curve(std::nanf("")), 0.0f);
    EXPECT_NEAR(filmic_curve(1e30f), 1.0f, 1e-6f);
    float last = 0.0f;
    for (float x = 1e-3f; x < 9.0f; x *= 1.1f) {
        EXPECT_GT(filmic_curve(x), last);
        last = filmic_curve(x);
    }
}

TEST(Png, ExposureIsInStops)
{
    const Spectrum display = apply_view(Spectrum(0.1f), {2.0f, ViewTransform::Srgb});
    EXPECT_NEAR(display.x, 0.4f, 1e-6f);
    EXPECT_EQ(apply_view(Spectrum(9.0f), {0.0f, ViewTransform::Srgb}).x, 1.0f);
}

TEST(Png, RoundTripIsWithinHalfACodeValue)
{
    const TemporaryFolder folder;
    Buffer2D<Spectrum> image(31, 17);
    Rng rng(1, 0, Stream::Test, 0, 0);
    for (Spectrum& s : image) s = rng.uniform3();
    image.at(0, 0) = {0.5f, 0.0f, 1.0f};
    write_png(folder.file("a.png"), image, {0.0f, ViewTransform::Srgb});
    const Buffer2D<Spectrum> read = read_png(folder.file("a.png"));
    ASSERT_EQ(read.width(), 31);
    ASSERT_EQ(read.height(), 17);
    for (int y = 0; y < 17; ++y) {
        for (int x = 0; x < 31; ++x) {
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(encode_srgb(read.at(x, y)[c]), encode_srgb(image.at(x, y)[c]),
                            0.5f / 255.0f + 1e-5f);
            }
        }
    }
    // 0.5 is 187.516 of 255, so code 188.
    EXPECT_NEAR(encode_srgb(read.at(0, 0).x) * 255.0f, 188.0f, 1e-3f);
}

/// PNG of one row with the given 16-bit RGB values (big-endian, as sRGB code values).
void write_png16(const std::string& path, const std::vector<uint16_t>& rgb)
{
    std::FILE* file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, static_cast<png_uint_32>(rgb.size() / 3), 1, 16, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    std::vector<png_byte> row;
    for (const uint16_t v : rgb) {
        row.push_back(static_cast<png_byte>(v >> 8));
        row.push_back(static_cast<png_byte>(v & 255));
    }
    png_write_row(png, row.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

TEST(Png, SixteenBitsAreRoundedToEight)
{
    const TemporaryFolder folder;
    write_png16(folder.file("a.png"), {0, 32768, 65535, 1000, 20000, 50000});
    const Buffer2D<Spectrum> read = read_png(folder.file("a.png"));
    ASSERT_EQ(read.width(), 2);
    const float expected[] = {0.0f, 32768.0f, 65535.0f, 1000.0f, 20000.0f, 50000.0f};
    for (int i = 0; i < 6; ++i) {
        EXPECT_NEAR(encode_srgb(read.at(i / 3, 0)[i % 3]), expected[i] / 65535.0f, 0.501f / 255.0f);
    }
}

TEST(Png, DamagedFilesAreRefusedByName)
{
    const TemporaryFolder folder;
    write_png(folder.file("a.png"), Buffer2D<Spectrum>(40, 30, Spectrum(0.3f)), {});
    const std::string good = read_bytes(folder.file("a.png"));
    write_bytes(folder.file("b.png"), good.substr(0, good.size() / 2));
    expect_error([&] { (void)read_png(folder.file("b.png")); }, ExitCode::Input,
                 {"b.png", "damaged"});
    expect_error([&] { (void)read_png(folder.file("none.png")); }, ExitCode::Input,
                 {"No such file"});
    write_bytes(folder.file("c.png"), "GIF89a");
    expect_error([&] { (void)read_png(folder.file("c.png")); }, ExitCode::Input, {"not a PNG"});
    std::string huge = good;  // width and height of the header chunk
    std::memcpy(huge.data() + 16, "\x00\x0f\x42\x40\x00\x0f\x42\x40", 8);
    write_bytes(folder.file("d.png"), huge);
    expect_error([&] { (void)read_png(folder.file("d.png")); }, ExitCode::Input, {"d.png"});
    for (uint32_t i = 0; i < 200; ++i) {
        Rng rng(5, 0, Stream::Test, i, 0);
        std::string bytes = good;
        for (int k = 0; k < 4; ++k)
            bytes[rng.next() % bytes.size()] = static_cast<char>(rng.next());
        write_bytes(folder.file("e.png"), bytes);
        try {
            (void)read_png(folder.file("e.png"));
        } catch (const Error& error) {
            EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(ExitCode::Input));
        }
    }
}

TEST(ContactSheet, PlacesImagesInRows)
{
    const TemporaryFolder folder;
    const Spectrum colors[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<std::string> paths;
    for (int i = 0; i < 3; ++i) {
        paths.push_back(folder.file(std::to_string(i) + ".png"));
        write_png(paths.back(), Buffer2D<Spectrum>(64, 32, colors[i]), {0.0f, ViewTransform::Srgb});
    }
    make_contact_sheet(paths, {2, 20, 3}, folder.file("sheet.png"));
    const Buffer2D<Spectrum> sheet = read_png(folder.file("sheet.png"));
    ASSERT_EQ(sheet.width(), 3 + 2 * 23);
    ASSERT_EQ(sheet.height(), 3 + 2 * 13);
    EXPECT_EQ(sheet.at(3, 3), colors[0]);
    EXPECT_EQ(sheet.at(45, 12), colors[1]);
    EXPECT_EQ(sheet.at(10, 20), colors[2]);
    EXPECT_LT(sheet.at(30, 20).x, 0.02f);  // empty cell
}

TEST(ContactSheet, ScalesByAreaMeanInLinearLight)
{
    const TemporaryFolder folder;
    Buffer2D<Spectrum> stripes(30, 30);
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 30; ++x) stripes.at(x, y) = Spectrum(x % 2 == 0 ? 1.0f : 0.0f);
    }
    write_png(folder.file("a.png"), stripes, {0.0f, ViewTransform::Srgb});
    make_contact_sheet({folder.file("a.png")}, {1, 15, 0}, folder.file("sheet.png"));
    // A pair of stripes averages to 0.5, stored as code 188.
    EXPECT_NEAR(read_png(folder.file("sheet.png")).at(7, 7).x, decode_srgb(188.0f / 255.0f), 1e-6f);
}

TEST(ContactSheet, NamesTheImageThatDiffers)
{
    const TemporaryFolder folder;
    write_png(folder.file("a.png"), Buffer2D<Spectrum>(8, 8), {});
    write_png(folder.file("b.png"), Buffer2D<Spectrum>(8, 9), {});
    expect_error(
        [&] {
            make_contact_sheet({folder.file("a.png"), folder.file("b.png")}, {},
                               folder.file("s.png"));
        },
        ExitCode::Input, {"b.png", "8 x 9"});
    expect_error([&] { make_contact_sheet({}, {}, folder.file("s.png")); }, ExitCode::Input,
                 {"no images"});
}

}  // namespace
}  // namespace mote
