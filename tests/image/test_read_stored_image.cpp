#include <gtest/gtest.h>

#include "image/exr.h"
#include "image/read_image.h"
#include "support/expect_error.h"
#include "support/png_bytes.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

TEST(ReadStoredImage, PngKeepsItsBytesAndAlpha)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("a.png", test::text_of(test::rgba_png));
    const std::vector<uint8_t> pixels = {255, 0, 0,   255, 0,  255, 0,  0,
                                         0,   0, 255, 128, 10, 20,  30, 40};
    for (const ImageSource& source :
         {ImageSource{path, {}}, ImageSource{"inside", test::rgba_png}}) {
        const StoredImage image = read_stored_image(source);
        EXPECT_EQ(image.width, 2);
        EXPECT_EQ(image.height, 2);
        EXPECT_EQ(image.channels, 4);
        EXPECT_EQ(image.bytes, pixels) << "colour must not be multiplied by alpha";
        EXPECT_TRUE(image.floats.empty());
        EXPECT_TRUE(stores_srgb(source));
    }
}

TEST(ReadStoredImage, SixteenBitsAndExrComeAsFloats)
{
    const StoredImage grey = read_stored_image({"grey", test::grey16_png});
    ASSERT_EQ(grey.floats.size(), 4u);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(grey.floats[static_cast<size_t>(c)], 32768.0f / 65535.0f, 1e-6f);
    EXPECT_EQ(grey.floats[3], 1.0f);

    const TemporaryFolder folder;
    LayeredImage exr{2, 1, {}, {}};
    float value = 0.0f;
    for (const char* name : {"A", "B", "G", "R"}) {
        exr.channels.push_back({name, PixelType::Float, Buffer2D<float>(2, 1, value += 0.5f)});
    }
    write_exr(folder.file("a.exr"), exr, ExrCompression::Zip);
    const StoredImage image = read_stored_image({folder.file("a.exr"), {}});
    EXPECT_EQ(image.floats, (std::vector<float>{2.0f, 1.5f, 1.0f, 0.5f, 2.0f, 1.5f, 1.0f, 0.5f}));
    EXPECT_FALSE(stores_srgb({folder.file("a.exr"), {}}));
}

TEST(ReadStoredImage, InsideOfOtherFilesThereArePngAndJpegAlone)
{
    const std::vector<uint8_t> webp = {'R', 'I', 'F', 'F', 0, 0, 0, 0, 'W', 'E', 'B', 'P'};
    expect_error(
        [&] {
            (void)read_stored_image({"a.glb: image 1", webp});
        },
        ExitCode::Input, {"a.glb: image 1", "only PNG and JPEG"});
    std::vector<uint8_t> damaged = test::rgba_png;
    damaged.resize(damaged.size() / 2);
    expect_error(
        [&] {
            (void)read_stored_image({"a.glb: image 1", damaged});
        },
        ExitCode::Input, {"a.glb: image 1", "damaged"});
}

}  // namespace
}  // namespace mote
