#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include <sys/resource.h>

#include "core/parallel.h"
#include "core/rng.h"
#include "image/exr.h"
#include "image/exr_check.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

/// 37 x 23 pixels, two half and two float channels of random values.
LayeredImage test_image()
{
    LayeredImage image{37, 23, {}, {}};
    for (const char* name : {"R", "G", "Z", "volume_direct.R"}) {
        Channel channel{name, name[0] == 'R' || name[0] == 'G' ? PixelType::Half : PixelType::Float,
                        Buffer2D<float>(37, 23)};
        Rng rng(3, 0, Stream::Test, static_cast<uint32_t>(name[0]), 0);
        for (float& v : channel.data) v = 100.0f * rng.uniform();
        image.channels.push_back(channel);
    }
    image.channels[2].data.at(5, 7) = 1e10f;  // background depth
    std::vector<float> matrix(16);
    for (size_t i = 0; i < 16; ++i) matrix[i] = static_cast<float>(i);
    image.attributes = {{"software", std::string("mote")},
                        {"mote:spp", 64},
                        {"mote:renderTime", 1.5f},
                        {"framesPerSecond", Attribute::Rational{24000, 1001}},
                        {"worldToCamera", matrix},
                        {"chromaticities", std::vector<float>{0.64f, 0.33f, 0.3f, 0.6f, 0.15f,
                                                              0.06f, 0.3127f, 0.329f}},
                        {"mote:three", std::vector<float>{1.0f, 2.0f, 3.0f}},
                        {"mote:five", std::vector<float>{1.0f, 2.0f, 3.0f, 4.0f, 5.0f}}};
    return image;
}

class ExrCompressions : public testing::TestWithParam<ExrCompression> {};

TEST_P(ExrCompressions, RoundTripKeepsNamesTypesAndValues)
{
    const TemporaryFolder folder;
    const LayeredImage written = test_image();
    write_exr(folder.file("a.exr"), written, GetParam());
    const LayeredImage read = read_exr(folder.file("a.exr"));
    ASSERT_EQ(read.width, 37);
    ASSERT_EQ(read.height, 23);
    ASSERT_EQ(read.channels.size(), written.channels.size());
    for (const Channel& channel : written.channels) {
        const Channel* found = read.find(channel.name);
        ASSERT_NE(found, nullptr) << channel.name;
        EXPECT_EQ(found->type, channel.type);
        for (int y = 0; y < 23; ++y) {
            for (int x = 0; x < 37; ++x) {
                const float value = channel.data.at(x, y);
                // Half has 11 significant bits: rounding moves a value by at most 2^-11 of it.
                const float tolerance = channel.type == PixelType::Half ? value * 0x1p-11f : 0.0f;
                ASSERT_NEAR(found->data.at(x, y), value, tolerance) << channel.name;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Exr, ExrCompressions,
                         testing::Values(ExrCompression::None, ExrCompression::Zip,
                                         ExrCompression::Zips, ExrCompression::Piz));

TEST(Exr, RoundTripKeepsAttributes)
{
    const TemporaryFolder folder;
    const LayeredImage written = test_image();
    write_exr(folder.file("a.exr"), written, ExrCompression::Zip);
    for (const LayeredImage& read :
         {read_exr(folder.file("a.exr")), read_exr_header(folder.file("a.exr"))}) {
        EXPECT_EQ(read.width, 37);
        EXPECT_EQ(read.channels.size(), 4u);
        for (const Attribute& attribute : written.attributes) {
            const Attribute* found = read.find_attribute(attribute.name);
            ASSERT_NE(found, nullptr) << attribute.name;
            ASSERT_EQ(found->value.index(), attribute.value.index()) << attribute.name;
            if (const auto* rational = std::get_if<Attribute::Rational>(&attribute.value)) {
                const auto& value = std::get<Attribute::Rational>(found->value);
                EXPECT_EQ(value.numerator, rational->numerator);
                EXPECT_EQ(value.denominator, rational->denominator);
            } else if (const auto* text = std::get_if<std::string>(&attribute.value)) {
                EXPECT_EQ(std::get<std::string>(found->value), *text);
            } else if (const auto* floats = std::get_if<std::vector<float>>(&attribute.value)) {
                EXPECT_EQ(std::get<std::vector<float>>(found->value), *floats);
            } else if (const auto* number = std::get_if<int>(&attribute.value)) {
                EXPECT_EQ(std::get<int>(found->value), *number);
            } else {
                EXPECT_EQ(std::get<float>(found->value), std::get<float>(attribute.value));
            }
        }
    }
}

TEST(Exr, FiniteValuesStayFiniteInHalf)
{
    const TemporaryFolder folder;
    LayeredImage image{2, 1, {{"R", PixelType::Half, Buffer2D<float>(2, 1)}}, {}};
    image.channels[0].data.at(0, 0) = 1e10f;
    image.channels[0].data.at(1, 0) = std::numeric_limits<float>::infinity();
    write_exr(folder.file("a.exr"), image, ExrCompression::None);
    const LayeredImage read = read_exr(folder.file("a.exr"));
    EXPECT_EQ(read.channels[0].data.at(0, 0), 65504.0f);
    EXPECT_TRUE(std::isinf(read.channels[0].data.at(1, 0)));
}

TEST(Exr, BytesDoNotDependOnThreads)
{
    const TemporaryFolder folder;
    std::string bytes[3];
    const int threads[3] = {1, 2, 3};
    for (int i = 0; i < 3; ++i) {
        run_with_threads(threads[i], [&] {
            write_exr(folder.file("a.exr"), test_image(), ExrCompression::Zip);
        });
        bytes[i] = read_bytes(folder.file("a.exr"));
    }
    EXPECT_EQ(bytes[0], bytes[1]);
    EXPECT_EQ(bytes[0], bytes[2]);
}

TEST(Exr, WrongFilesAreNamed)
{
    const TemporaryFolder folder;
    write_bytes(folder.file("text.exr"), "this is no image at all");
    write_bytes(folder.file("empty.exr"), "");
    expect_error([&] { (void)read_exr(folder.file("none.exr")); }, ExitCode::Input,
                 {"none.exr", "No such file"});
    expect_error([&] { (void)read_exr(folder.file("text.exr")); }, ExitCode::Input,
                 {"text.exr", "not an OpenEXR file"});
    expect_error([&] { (void)read_exr(folder.file("empty.exr")); }, ExitCode::Input,
                 {"empty.exr", "not an OpenEXR file"});
    expect_error([&] { (void)read_exr(folder.path()); }, ExitCode::Input, {"is a folder"});
    EXPECT_FALSE(is_complete_exr(folder.file("none.exr")));
    EXPECT_FALSE(is_complete_exr(folder.file("text.exr")));
}

/// The file's bytes with the named header attribute's value replaced.
std::string patch(std::string bytes, const std::string& name, const void* value, size_t size)
{
    const size_t start = bytes.find(name + '\0');
    EXPECT_NE(start, std::string::npos);
    const size_t type = start + name.size() + 1;
    const size_t data = bytes.find('\0', type) + 1 + 4;
    std::memcpy(bytes.data() + data, value, size);
    return bytes;
}

TEST(Exr, HugeDataWindowsAreRefusedBeforeTheyAreAllocated)
{
    const TemporaryFolder folder;
    write_exr(folder.file("a.exr"), test_image(), ExrCompression::Zip);
    const std::string good = read_bytes(folder.file("a.exr"));
    const int32_t windows[][4] = {
        {0, 0, 0x7ffffffe, 0x7ffffffe},  {0, 0, 99999, 99999},  {0, 0, 8191, 8191},
        {-0x7fffffff, 0, 0x7ffffffe, 0}, {0, 0, 0, 0x0fffffff}, {5, 5, 4, 4}};
    for (const auto& window : windows) {
        write_bytes(folder.file("b.exr"), patch(good, "dataWindow", window, sizeof window));
        expect_error([&] { (void)read_exr(folder.file("b.exr")); }, ExitCode::Input, {"b.exr"});
        expect_error([&] { (void)read_exr_header(folder.file("b.exr")); }, ExitCode::Input,
                     {"b.exr"});
    }
}

TEST(Exr, CutFilesAreIncomplete)
{
    const TemporaryFolder folder;
    write_exr(folder.file("a.exr"), test_image(), ExrCompression::Zip);
    EXPECT_TRUE(is_complete_exr(folder.file("a.exr")));
    const std::string good = read_bytes(folder.file("a.exr"));
    for (const size_t size : {good.size() - 1, good.size() / 2, good.size() / 8, size_t{100}}) {
        write_bytes(folder.file("b.exr"), good.substr(0, size));
        EXPECT_FALSE(is_complete_exr(folder.file("b.exr"))) << size;
    }
}

TEST(Exr, MutatedFilesNeverCrashNorTakeMuchMemory)
{
    const TemporaryFolder folder;
    rusage before{};
    ::getrusage(RUSAGE_SELF, &before);
    int refused = 0;
    constexpr uint32_t mutations = 400;
    const ExrCompression kinds[] = {ExrCompression::None, ExrCompression::Zip, ExrCompression::Piz,
                                    ExrCompression::Zips};
    std::string good[4];
    for (size_t k = 0; k < 4; ++k) {
        write_exr(folder.file("a.exr"), test_image(), kinds[k]);
        good[k] = read_bytes(folder.file("a.exr"));
    }
    for (uint32_t i = 0; i < mutations; ++i) {
        Rng rng(17, 0, Stream::Test, i, 0);
        std::string bytes = good[i % 4];
        const auto position = [&](size_t end) { return rng.next() % std::min(end, bytes.size()); };
        switch (i / 4 % 4) {
            case 0:
                bytes.resize(position(bytes.size()));
                break;
            case 1:  // three bytes of the header
                for (int k = 0; k < 3; ++k) bytes[position(900)] = static_cast<char>(rng.next());
                break;
            case 2: {  // an extreme number in the header or the offset table
                const uint32_t extremes[] = {0xffffffffu, 0x7fffffffu, 0x80000000u, 0x40000000u,
                                             0u};
                const uint32_t value = extremes[rng.next() % 5];
                std::memcpy(bytes.data() + position(1000), &value, 4);
                break;
            }
            default:  // twenty bytes anywhere
                for (int k = 0; k < 20; ++k) {
                    bytes[position(bytes.size())] = static_cast<char>(rng.next());
                }
        }
        write_bytes(folder.file("b.exr"), bytes);
        try {
            (void)read_exr(folder.file("b.exr"));
        } catch (const Error& error) {
            ++refused;
            EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(ExitCode::Input))
                << error.what();
            EXPECT_LT(std::string(error.what()).size(), 600u) << error.what();
        }
    }
    EXPECT_GT(refused, static_cast<int>(mutations) / 4);  // every cut file at least
    rusage after{};
    ::getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 200 * 1024);  // kB
}

}  // namespace
}  // namespace mote
