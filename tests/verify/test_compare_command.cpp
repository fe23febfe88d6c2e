#include <fstream>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "app/commands.h"
#include "image/exr.h"
#include "image/png.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {

namespace {

using Names = std::vector<std::string>;

LayeredImage image_of(const Names& channels, float value, int width = 4, int height = 3)
{
    LayeredImage image;
    image.width = width;
    image.height = height;
    for (const std::string& name : channels) {
        image.channels.push_back({name, PixelType::Float, Buffer2D<float>(width, height, value)});
    }
    return image;
}

/// Runs `mote compare` on files of a folder of its own.
class CompareCommand : public testing::Test {
  protected:
    std::string save(const std::string& name, const LayeredImage& image) const
    {
        write_exr(folder.file(name), image, ExrCompression::Zip);
        return folder.file(name);
    }

    /// What goes to stdout.
    static std::string compare(Names arguments)
    {
        arguments.insert(arguments.begin(), "compare");
        const auto options = std::get<CompareOptions>(parse_command_line(arguments));
        testing::internal::CaptureStdout();
        try {
            run_compare(options);
        } catch (...) {
            std::fflush(stdout);
            (void)testing::internal::GetCapturedStdout();
            throw;
        }
        std::fflush(stdout);
        return testing::internal::GetCapturedStdout();
    }

    static nlohmann::json read_json(const std::string& path)
    {
        std::ifstream in(path);
        return nlohmann::json::parse(in);
    }

    static bool contains(const std::string& text, const std::string& part)
    {
        return text.find(part) != std::string::npos;
    }

    TemporaryFolder folder;
};

}  // namespace

TEST_F(CompareCommand, EqualImagesPassEveryThreshold)
{
    const std::string a = save("a.exr", image_of({"R", "G", "B", "A", "volume.R"}, 0.5f));
    const std::string table = compare({a, a, "--threshold", "relmse=0", "--threshold", "mse=0",
                                       "--threshold", "psnr=100", "--threshold", "mean-ratio=0"});
    EXPECT_TRUE(contains(table, "4 x 3 pixels")) << table;
    EXPECT_TRUE(contains(table, "volume.R")) << table;
    EXPECT_FALSE(contains(table, "Worst pixels")) << table;
}

TEST_F(CompareCommand, OverAThresholdIs10AndSaysWhichChannelByHowMuch)
{
    LayeredImage tested = image_of({"R", "G", "B"}, 1.0f);
    tested.channels[1].data.at(2, 1) = 4.0f;
    const std::string a = save("a.exr", tested);
    const std::string b = save("b.exr", image_of({"R", "G", "B"}, 1.0f));
    // One of twelve pixels of G errs by 3: 9 / 1.01 / 12.
    expect_error(
        [&] {
            compare({a, b, "--threshold", "relmse=0.5"});
        },
        ExitCode::BiasFound, {"relmse of G is 0.742574, over 0.5"});
    const std::string table = compare({a, b, "--threshold", "relmse=0.8"});
    EXPECT_TRUE(contains(table, "(2, 1)  A 4  B 1")) << table;
    EXPECT_NO_THROW(compare({a, b, "--threshold", "trimmed-relmse=0"}));
    expect_error(
        [&] {
            compare({a, b, "--threshold", "psnr=20"});
        },
        ExitCode::BiasFound, {"psnr of G is 1.24939, under 20"});
    expect_error(
        [&] {
            compare({a, b, "--threshold", "mean-ratio=0.01"});
        },
        ExitCode::BiasFound, {"mean-ratio of G is 0.25, over 0.01"});
    EXPECT_NO_THROW(compare({a, b}));  // without a threshold any difference is just reported
}

TEST_F(CompareCommand, ImagesThatDoNotMatchAre3)
{
    const std::string rgb = save("rgb.exr", image_of({"R", "G", "B"}, 1.0f));
    const std::string wide = save("wide.exr", image_of({"R", "G", "B"}, 1.0f, 5, 3));
    const std::string more = save("more.exr", image_of({"R", "G", "B", "Z"}, 1.0f));
    expect_error([&] { compare({rgb, wide}); }, ExitCode::Input, {"4 x 3", "5 x 3", "wide.exr"});
    expect_error([&] { compare({rgb, more}); }, ExitCode::Input, {"lacks layers", "--layers rgb"});
    expect_error([&] { compare({rgb, folder.file("none.exr")}); }, ExitCode::Input, {"none.exr"});
    expect_error(
        [&] {
            compare({rgb, folder.write("bad.exr", "no image")});
        },
        ExitCode::Input, {"bad.exr"});
    expect_error(
        [&] {
            compare({rgb, rgb, "--threshold", "z=3"});
        },
        ExitCode::Input, {"needs the variance of R"});
    EXPECT_NO_THROW(compare({more, rgb, "--layers", "rgb"}));
}

TEST_F(CompareCommand, WrongOptionsAre2AndLeaveNoFiles)
{
    const std::string a = save("a.exr", image_of({"R"}, 1.0f));
    const std::string json = folder.file("figures.json");
    const auto refuse = [&](const Names& more, std::initializer_list<const char*> parts) {
        Names arguments{a, a, "--json", json};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_error([&] { compare(arguments); }, ExitCode::Usage, parts);
    };
    refuse({"--threshold", "relmes=1"}, {"no such figure", "did you mean \"relmse\""});
    refuse({"--threshold", "relmse"}, {"relmse=0.01"});
    refuse({"--threshold", "relmse=1x"}, {"\"1x\" is not a number"});
    refuse({"--threshold", "relmse=nan"}, {"not a number"});
    refuse({"--diff", "diff.jpg"}, {".exr or .png"});
    EXPECT_FALSE(std::filesystem::exists(json));
}

TEST_F(CompareCommand, ANanPixelIsReportedAndOverAnyThreshold)
{
    LayeredImage tested = image_of({"R", "G"}, 1.0f);
    tested.channels[0].data.at(1, 2) = std::numeric_limits<float>::quiet_NaN();
    const std::string a = save("a.exr", tested);
    const std::string b = save("b.exr", image_of({"R", "G"}, 1.0f));
    const std::string table = compare({a, b});
    EXPECT_TRUE(contains(table, "1 pixels of A, 0 of B")) << table;
    expect_error(
        [&] {
            compare({a, b, "--threshold", "relmse=1"});
        },
        ExitCode::BiasFound, {"1 pixels of R are NaN or infinite in one image only"});
    EXPECT_NO_THROW(compare({a, a, "--threshold", "relmse=0"}));
}

TEST_F(CompareCommand, WritesFiguresEvenWhenOverTheThreshold)
{
    const std::string a = save("a.exr", image_of({"R", "G", "B"}, 3.0f));
    const std::string b = save("b.exr", image_of({"R", "G", "B"}, 1.0f));
    const std::string path = folder.file("figures.json");
    expect_error(
        [&] {
            compare({a, b, "--threshold", "mse=1", "--json", path});
        },
        ExitCode::BiasFound, {"mse of R is 4, over 1"});
    const nlohmann::json json = read_json(path);
    EXPECT_EQ(json["layers"][0]["name"], "rgb");
    EXPECT_EQ(json["layers"][0]["channels"][2]["name"], "B");
    EXPECT_EQ(json["layers"][0]["channels"][2]["mse"], 4.0);
    EXPECT_EQ(json["layers"][0]["channels"][2]["mean_ratio"], 3.0);
    EXPECT_EQ(json["violations"].size(), 3u);
    compare({b, b, "--json", path});
    EXPECT_TRUE(read_json(path)["layers"][0]["channels"][0]["psnr"].is_null());  // infinite
}

TEST_F(CompareCommand, UsesTheVarianceOfTheReference)
{
    const std::string a = save("a.exr", image_of({"R"}, 1.25f));
    LayeredImage reference = image_of({"R", "variance.R"}, 1.0f);
    for (float& value : reference.channels[1].data) value = 0.0625f;
    const std::string b = save("b.exr", reference);
    // The squared difference is the variance: nothing is left. All 12 differences have one sign,
    // so their mean is sqrt(12) standard errors from 0.
    const std::string table = compare({a, b, "--threshold", "corrected-mse=0"});
    EXPECT_TRUE(contains(table, "Without the noise of B")) << table;
    EXPECT_TRUE(contains(table, "z = 3.46")) << table;
    expect_error(
        [&] {
            compare({a, b, "--threshold", "z=3"});
        },
        ExitCode::BiasFound, {"z of R is 3.4641"});
}

TEST_F(CompareCommand, WritesDifferencesAsExrAndPng)
{
    LayeredImage tested = image_of({"R", "G", "B"}, 1.0f);
    for (Channel& channel : tested.channels) channel.data.at(0, 0) = 2.0f;
    for (Channel& channel : tested.channels) channel.data.at(1, 0) = 0.5f;
    const std::string a = save("a.exr", tested);
    const std::string b = save("b.exr", image_of({"R", "G", "B"}, 1.0f));
    const std::string exr = folder.file("new/diff.exr");
    const std::string png = folder.file("new/diff.png");
    compare({a, b, "--diff", exr});
    EXPECT_EQ(read_exr(exr).find("G")->data.at(0, 0), 1.0f);
    EXPECT_EQ(read_exr(exr).find("G")->data.at(1, 0), -0.5f);
    EXPECT_EQ(read_exr(exr).find("G")->data.at(3, 2), 0.0f);
    EXPECT_TRUE(contains(compare({a, b, "--diff", png}), "red where A is brighter"));
    const Buffer2D<Spectrum> picture = read_png(png);
    EXPECT_GT(picture.at(0, 0).x, picture.at(0, 0).z);
    EXPECT_GT(picture.at(1, 0).z, picture.at(1, 0).x);
    EXPECT_EQ(picture.at(3, 2), Spectrum(1.0f));
    // A PNG is compared like any image of R, G and B.
    EXPECT_NO_THROW(compare({png, png, "--threshold", "mse=0"}));
    expect_error(
        [&] {
            compare({a, b, "--diff", folder.file("a.exr/diff.png")});
        },
        ExitCode::Output, {"diff.png"});
}

}  // namespace mote
