#include <sys/resource.h>

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/error.h"
#include "core/sanitizers.h"
#include "image/bare_jpeg.h"
#include "image/read_image.h"
#include "support/damage.h"
#include "support/expect_error.h"
#include "support/jpeg_bytes.h"
#include "support/png_bytes.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

std::string refusal(std::vector<uint8_t> file)
{
    std::string error;
    EXPECT_TRUE(bare_jpeg(file, error).empty());
    return error;
}

/// The place of a segment by its marker.
size_t find(const std::vector<uint8_t>& file, uint8_t marker)
{
    for (size_t i = 0; i + 1 < file.size(); ++i) {
        if (file[i] == 0xff && file[i + 1] == marker) return i;
    }
    return file.size();
}

TEST(BareJpeg, LeavesOutMetadataAlone)
{
    std::string error;
    const std::vector<uint8_t> bare = bare_jpeg(test::rgb_jpeg, error);
    ASSERT_FALSE(bare.empty()) << error;
    // Comment of 5 bytes, EXIF of 34, IPTC of 35, and their markers.
    EXPECT_EQ(bare.size(), test::rgb_jpeg.size() - (7 + 36 + 37));
    for (const uint8_t marker : {uint8_t{0xfe}, uint8_t{0xe1}, uint8_t{0xed}}) {
        EXPECT_LT(find(test::rgb_jpeg, marker), test::rgb_jpeg.size());
        EXPECT_EQ(find(bare, marker), bare.size());
    }
    EXPECT_EQ(bare_jpeg(bare, error), bare);
    std::vector<uint8_t> longer = test::rgb_jpeg;
    longer.insert(longer.end(), 1000, 0x55);  // what follows the end is nobody's business
    EXPECT_EQ(bare_jpeg(longer, error), bare);
}

TEST(BareJpeg, RefusesWhatItDoesNotKnow)
{
    std::vector<uint8_t> file = test::rgb_jpeg;
    const size_t frame = find(file, 0xc0);
    file[frame + 1] = 0xc9;  // arithmetic coding
    EXPECT_EQ(refusal(file), "only baseline and progressive JPEG are read");
    file = test::rgb_jpeg;
    file[frame + 4] = 12;
    EXPECT_EQ(refusal(file), "only JPEG of 8 bits is read");
    file = test::rgb_jpeg;
    file[frame + 5] = file[frame + 7] = 0xff;  // 65,288 x 65,296 pixels
    EXPECT_EQ(refusal(file), "its size is not supported (limit: 2^28 pixels)");
    file = test::rgb_jpeg;
    file[frame + 9] = 4;
    EXPECT_EQ(refusal(file), "it is neither grey nor RGB; convert it to RGB");
    file = test::rgb_jpeg;
    file.resize(file.size() - 2);
    EXPECT_EQ(refusal(file), "it ends too early");
    file = test::rgb_jpeg;
    const std::vector<uint8_t> again(file.begin() + static_cast<std::ptrdiff_t>(find(file, 0xda)),
                                     file.end() - 2);
    for (int i = 0; i < 64; ++i) file.insert(file.end() - 2, again.begin(), again.end());
    EXPECT_EQ(refusal(file), "it has more than 64 scans; save it anew");
    EXPECT_EQ(refusal({0xff, 0xd8, 0xff, 0xd9}), "it holds no picture");
}

TEST(ReadJpeg, PixelsFromFilesAndFromMemory)
{
    const TemporaryFolder folder;
    const std::string jpg = folder.write("a.jpg", test::text_of(test::rgb_jpeg));
    const std::string jpeg = folder.write("a.JPEG", test::text_of(test::rgb_jpeg));
    for (const ImageSource& source :
         {ImageSource{jpg, {}}, ImageSource{jpeg, {}}, ImageSource{"inside", test::rgb_jpeg}}) {
        const StoredImage image = read_stored_image(source);
        ASSERT_EQ(image.width, 16);
        ASSERT_EQ(image.height, 8);
        ASSERT_EQ(image.bytes.size(), size_t{16 * 8 * 4});
        EXPECT_TRUE(stores_srgb(source));
        for (int i = 0; i < 16 * 8; ++i) {
            const uint8_t* pixel = image.bytes.data() + static_cast<size_t>(4 * i);
            EXPECT_NEAR(pixel[0], 40 + 10 * (i % 16), 3);
            EXPECT_NEAR(pixel[1], 30 + 20 * (i / 16), 3);
            EXPECT_NEAR(pixel[2], 100, 3);
            EXPECT_EQ(pixel[3], 255);
        }
    }
    const StoredImage grey = read_stored_image({"grey", test::grey_jpeg});
    for (size_t i = 0; i < 16; ++i) {
        for (size_t c = 0; c < 3; ++c) EXPECT_EQ(grey.bytes[4 * i + c], 40 + 10 * i);
    }
    const Buffer2D<Spectrum> sky = read_image(jpg);  // as linear light: (90/255)^2.2 or so
    EXPECT_NEAR(sky.at(5, 0).x, 0.102f, 0.01f);
    expect_error([&] { (void)read_image(folder.write("b.jpg", "\x89PNG")); }, ExitCode::Input,
                 {"b.jpg", "no JPEG file"});
    std::vector<uint8_t> half = test::rgb_jpeg;
    half.resize(half.size() - 20);
    expect_error(
        [&] {
            (void)read_stored_image({"a.glb: image 1", half});
        },
        ExitCode::Input, {"a.glb: image 1", "ends too early"});
}

/// 500 damages of each file (5000 in the long form) end in a picture of the size its header tells
/// or in one Error that names the file.
TEST(ReadJpeg, DamagedFilesAreReadOrRefused)
{
    rusage before{};
    getrusage(RUSAGE_SELF, &before);
    const uint32_t trials = std::getenv("MOTE_LONG_TESTS") ? 5000 : 500;
    for (const std::vector<uint8_t>& whole : {test::rgb_jpeg, test::grey_jpeg}) {
        uint32_t refused = 0;
        for (uint32_t trial = 0; trial < trials; ++trial) {
            const std::string text = test::damage(test::text_of(whole), trial);
            const std::vector<uint8_t> file(text.begin(), text.end());
            if (file.empty()) continue;
            try {
                const StoredImage image = read_stored_image({"damaged picture", file});
                EXPECT_EQ(image.bytes.size(),
                          4 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
            } catch (const Error& e) {
                ++refused;
                EXPECT_NE(std::string_view(e.what()).find("damaged picture"),
                          std::string_view::npos);
                EXPECT_EQ(std::string_view(e.what()).find('\n'), std::string_view::npos);
            }
        }
        EXPECT_GT(refused, trials / 10);
    }
    rusage after{};
    getrusage(RUSAGE_SELF, &after);
    const long held_back = is_instrumented ? 256 * 1024 : 0;
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 400'000 + held_back);
}

}  // namespace
}  // namespace mote
