#include <fstream>
#include <regex>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/verify_options.h"
#include "image/png.h"
#include "plots/svg.h"
#include "study/pictures.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

using Names = std::vector<std::string>;

const char* const lamp_scene = R"(
name = "A <lamp>"
[render]
width = 24
height = 16
bounces = 1

[[volumes]]
procedural = { type = "puff", voxel_size = 0.1 }
density_scale = 8

[[lights]]
type = "distant"
direction = [0, 1, 0]

[[lights]]
type = "environment"
strength = 0.3
)";

VerifyOptions parse(Names arguments)
{
    arguments.insert(arguments.begin(), "verify");
    return std::get<VerifyOptions>(parse_command_line(arguments));
}

/// What goes to stdout.
std::string verify(const Names& arguments)
{
    testing::internal::CaptureStdout();
    try {
        run_verify(parse(arguments));
    } catch (...) {
        std::fflush(stdout);
        (void)testing::internal::GetCapturedStdout();
        throw;
    }
    std::fflush(stdout);
    return testing::internal::GetCapturedStdout();
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

nlohmann::json read_json(const std::string& path)
{
    std::ifstream in(path);
    return nlohmann::json::parse(in);
}

/// The bytes behind every data URI of a page.
std::vector<std::string> pictures_in(const std::string& html)
{
    std::vector<std::string> pictures;
    const std::string begin = "src=\"data:image/png;base64,";
    for (size_t at = html.find(begin); at != std::string::npos; at = html.find(begin, at + 1)) {
        const size_t first = at + begin.size();
        const std::string text = html.substr(first, html.find('"', first) - first);
        std::string bytes;
        uint32_t bits = 0;
        int count = 0;
        for (const char c : text) {
            const std::string digits =
                "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
            if (c == '=') break;
            bits = bits << 6 | static_cast<uint32_t>(digits.find(c));
            count += 6;
            if (count < 8) continue;
            count -= 8;
            bytes += static_cast<char>(bits >> count & 255u);
        }
        pictures.push_back(bytes);
    }
    return pictures;
}

class VerifyCommand : public testing::Test {
  protected:
    VerifyCommand() { scene = folder.write("a.toml", lamp_scene); }

    TemporaryFolder folder;
    std::string scene;
};

TEST_F(VerifyCommand, NoBiasIs0WithFiguresAndPictures)
{
    const std::string json = folder.file("new/a.json");
    const std::string page = folder.file("new/a.html");
    const std::string text = verify({scene, "--budget", "2%", "--tile-budget", "0.3", "--warm-up",
                                     "2", "--time", "600", "--json", json, "--html", page});
    EXPECT_TRUE(contains(text, "no bias found")) << text;
    EXPECT_TRUE(contains(text, "24 x 16 pixels, frame 3 of a scene at rest")) << text;

    const nlohmann::json j = read_json(json);
    EXPECT_EQ(j.at("verdict"), "no bias found");
    EXPECT_EQ(j.at("question").at("budget"), 0.02);
    EXPECT_EQ(j.at("tested").at("runs"), j.at("reference").at("runs"));
    EXPECT_EQ(j.at("tested").at("frames"), 3);
    EXPECT_EQ(j.at("channels").at(0).at("name"), "R");
    EXPECT_LT(j.at("channels").at(0).at("detectable"), 0.02);
    EXPECT_GT(j.at("errors").at("absolute").at("variance"), 0.0);
    EXPECT_EQ(j.at("temporal").at("steps").size(), 2u);
    // Accumulated frames have most of their error in common.
    EXPECT_GT(j.at("temporal").at("autocorrelation"), 0.5);

    const std::string html = read_bytes(page);
    EXPECT_TRUE(contains(html, "A &lt;lamp&gt;"));
    EXPECT_TRUE(contains(html, "<svg"));
    EXPECT_FALSE(std::regex_search(html, std::regex("(src|href)=\"(?!data:)")));
    const std::vector<std::string> pictures = pictures_in(html);
    ASSERT_EQ(pictures.size(), 6u);
    for (const std::string& bytes : pictures) {
        const Buffer2D<Spectrum> picture = read_png(folder.write("picture.png", bytes));
        EXPECT_TRUE(picture.width() == 24 || picture.width() == 3) << picture.width();
    }
}

TEST_F(VerifyCommand, PartsOfSurfacesAreJudgedWhereThereAreAny)
{
    const std::string json = folder.file("room.json");
    const Names arguments{MOTE_SOURCE_DIR "/scenes/room_smoke.toml",
                          "--method",
                          "path-exact",
                          "--reference",
                          "path",
                          "--resolution",
                          "12x12",
                          "--passes",
                          "1",
                          "--set",
                          "volumes.smoke.procedural.voxel_size=0.1",
                          "--runs",
                          "6",
                          "--json",
                          json};
    // Six runs are too few to say; what was looked at is written all the same.
    expect_error([&] { (void)verify(arguments); }, ExitCode::NotEnoughRuns, {"room_smoke"});
    std::string names;
    const nlohmann::json figures = read_json(json);
    EXPECT_EQ(figures.at("counters").at("majorant_violations"), 0);
    for (const auto& channel : figures.at("channels")) {
        names += channel.at("name").get<std::string>() + " ";
    }
    for (const char* part : {"volume_direct.R", "direct.G", "indirect.B", "emission.R"}) {
        EXPECT_TRUE(contains(" " + names, std::string(" ") + part + " ")) << names;
    }
}

TEST_F(VerifyCommand, BiasIs10AndWritesItsFigures)
{
    const std::string json = folder.file("a.json");
    const Names arguments{scene,      "--set", "render.restir.preset=preview",
                          "--budget", "0.1%",  "--no-sequences",
                          "--json",   json};
    expect_error([&] { (void)verify(arguments); }, ExitCode::BiasFound,
                 {"a.toml: bias found: the bias is over 0.1 %"});
    EXPECT_EQ(read_json(json).at("question").at("equivalence"), true);
    EXPECT_EQ(read_json(json).at("verdict"), "bias found");
    EXPECT_TRUE(read_json(json).at("temporal").is_null());
    // The same settings are within a budget that is wide enough.
    Names wide = arguments;
    wide[4] = "20%";
    EXPECT_TRUE(contains(verify(wide), "the bias is under 20 %"));
}

TEST_F(VerifyCommand, TooFewRunsAre11)
{
    expect_error(
        [&] {
            (void)verify({scene, "--runs", "20", "--budget", "0.001%", "--no-sequences"});
        },
        ExitCode::NotEnoughRuns, {"not enough runs", "give it more --time"});
    expect_error(
        [&] {
            (void)verify({scene, "--runs", "3", "--budget", "90%", "--no-sequences"});
        },
        ExitCode::NotEnoughRuns, {"3 runs are too few to judge"});
}

TEST_F(VerifyCommand, BadInputIs2Or3)
{
    expect_error([&] { (void)verify({folder.file("none.toml")}); }, ExitCode::Input, {"none.toml"});
    expect_error(
        [&] {
            (void)verify({scene, "--method", "restr-off"});
        },
        ExitCode::Usage, {"no method \"restr-off\"", "restir-off"});
    expect_error(
        [&] {
            (void)verify({scene, "--reference", "truth"});
        },
        ExitCode::Usage, {"no method \"truth\""});
    expect_error(
        [&] {
            (void)verify({scene, "--power", "1%", "--alpha", "2%"});
        },
        ExitCode::Usage, {"--power must be over --alpha"});
    for (const Names& wrong :
         {Names{"--budget", "0"}, Names{"--budget", "100%"}, Names{"--budget", "1x"},
          Names{"--time", "0"}, Names{"--runs", "1"}, Names{"--passes", "0"}}) {
        Names arguments{scene};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        EXPECT_THROW((void)parse(arguments), Error) << wrong[0] << " " << wrong[1];
    }
    const std::string dark = folder.write("dark.toml", "[[volumes]]\nprocedural = \"puff\"\n");
    expect_error([&] { (void)verify({dark, "--no-sequences"}); }, ExitCode::Input, {"black"});
}

TEST_F(VerifyCommand, LowersTheSizeUnlessAskedNotTo)
{
    const Names arguments{scene,
                          "--runs",
                          "2",
                          "--set",
                          "render.samples=1",
                          "--no-sequences",
                          "--json",
                          folder.file("a.json")};
    const auto width_with = [&](const Names& more) {
        Names all = arguments;
        all.insert(all.end(), more.begin(), more.end());
        EXPECT_THROW((void)verify(all), Error);
        return read_json(folder.file("a.json")).at("width").get<int>();
    };
    EXPECT_EQ(width_with({}), 24);
    EXPECT_EQ(width_with({"--resolution", "30x20"}), 30);
    EXPECT_EQ(width_with({"--set", "render.width=96", "--set", "render.height=55"}), 96);
    folder.write("a.toml",
                 std::string(lamp_scene).replace(std::string(lamp_scene).find("24"), 2, "2400"));
    EXPECT_EQ(width_with({}), 882);  // 2400 x 16, scaled to 5184 pixels
}

TEST(Pictures, Base64IsThatOfRfc4648)
{
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST(Pictures, PlotsLeaveOutWhatIsNotFinite)
{
    const Plot plot{"a & b", {"0", "1"}, 0.0, 2.0};
    const std::vector<double> values{1.0, std::numeric_limits<double>::quiet_NaN(), 3.0};
    const std::string svg = bar_plot(plot, values, 1.0);
    EXPECT_TRUE(contains(svg, "a &amp; b"));
    EXPECT_FALSE(contains(svg, "nan"));
    EXPECT_FALSE(contains(line_plot(plot, {"x"}, {values}, 1.0), "nan"));
}

}  // namespace
}  // namespace mote
