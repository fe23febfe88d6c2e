#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/image_metadata.h"
#include "image/exr.h"
#include "run_mote.h"
#include "support/temporary_folder.h"
#include "test_scene.h"

namespace mote {

namespace {

using Names = std::vector<std::string>;

class RenderCommand : public testing::Test {
  protected:
    RenderCommand() { folder.write("scene.toml", puff_scene); }

    [[nodiscard]] Finished render(Names arguments) const
    {
        arguments.insert(arguments.begin(), {"render", "scene.toml", "--reproducible"});
        return run_mote(folder.path(), arguments);
    }

    /// Replaces a file by other bytes, to see later whether it was rendered again.
    void mark(const std::string& name) const { folder.write(name, "mark"); }
    [[nodiscard]] bool is_marked(const std::string& name) const
    {
        return read_bytes(folder.file(name)) == "mark";
    }

    TemporaryFolder folder;
};

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_F(RenderCommand, WritesImagesPreviewsAndStats)
{
    const Finished run =
        render({"--frames", "-1-1x2", "--output", "a/%04d.exr", "--preview", "b/$F2.png", "--stats",
                "stats.json", "--resolution", "20x10", "--samples", "3", "--seed", "7"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(files_below(folder.path()), (Names{"a/-001.exr", "a/0001.exr", "b/-1.png", "b/01.png",
                                                 "scene.toml", "stats.json"}));

    const LayeredImage image = read_exr(folder.file("a/-001.exr"));
    EXPECT_EQ(image.width, 20);
    EXPECT_EQ(image.height, 10);
    EXPECT_NE(image.find("A"), nullptr);
    EXPECT_NE(image.find("Z"), nullptr);
    EXPECT_EQ(std::get<int>(image.find_attribute("mote:frame")->value), -1);
    EXPECT_EQ(std::get<int>(image.find_attribute("mote:spp")->value), 3);
    EXPECT_EQ(std::get<std::string>(image.find_attribute("mote:seed")->value), "7");
    for (const char* name :
         {"mote:sceneHash", "mote:version", "framesPerSecond", "worldToCamera"}) {
        EXPECT_NE(image.find_attribute(name), nullptr) << name;
    }

    const auto stats = nlohmann::json::parse(read_bytes(folder.file("stats.json")));
    EXPECT_TRUE(stats["finished"]);
    ASSERT_EQ(stats["frames"].size(), 2u);
    EXPECT_EQ(stats["frames"][0]["paths"], 20 * 10 * 3);
    EXPECT_EQ(stats["frames"][0]["dropped_non_finite"], 0);
    EXPECT_GT(stats["frames"][0]["peak_memory_bytes"], 1'000'000);
}

/// What a scene lacks shows as 0 work.
TEST_F(RenderCommand, StatsTellTheWorkOfTheRestirEstimator)
{
    const Finished run = render({"--frames", "1", "--set", "render.estimator=restir", "--stats",
                                 "s.json", "--resolution", "20x10", "--samples", "3"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto stats = nlohmann::json::parse(read_bytes(folder.file("s.json")));
    const auto& work = stats["frames"][0]["restir"];
    EXPECT_EQ(work["camera_rays"].get<int>() + work["missed_rays"].get<int>(), 20 * 10 * 3);
    EXPECT_EQ(work["caches_built"], 1);
    EXPECT_EQ(work["emission_integrals"], 0);
    for (const char* key : {"caches_reused", "transmittance_maps", "direction_sets", "local_lights",
                            "light_cells", "light_rays", "light_ray_cells", "coarse_rays",
                            "coarse_ray_cells", "cells", "uniform_bricks", "candidates"}) {
        EXPECT_TRUE(work.contains(key)) << key;
    }
}

TEST_F(RenderCommand, AovsCanBeReplacedAndWrongOnesAreRefused)
{
    ASSERT_EQ(render({"--frames", "1", "--aovs", "none"}).exit_code, 0);
    EXPECT_EQ(read_exr_header(folder.file("out/0001.exr")).channels.size(), 4u);
    const Finished wrong = render({"--frames", "1", "--aovs", "Z,transmitance"});
    EXPECT_EQ(wrong.exit_code, 3);
    EXPECT_TRUE(contains(wrong.err, "transmittance")) << wrong.err;
}

TEST_F(RenderCommand, SkipKeepsCompleteFilesOnly)
{
    ASSERT_EQ(render({}).exit_code, 0);
    const std::string first = read_bytes(folder.file("out/0001.exr"));
    const std::string second = read_bytes(folder.file("out/0002.exr"));
    folder.write("out/0002.exr", second.substr(0, second.size() - 20));  // a copy cut short
    std::filesystem::remove(folder.file("out/0003.exr"));

    // Another seed shows which files are new.
    const Finished run = render({"--existing", "skip", "--seed", "5", "--stats", "s.json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(read_bytes(folder.file("out/0001.exr")), first);
    EXPECT_TRUE(is_complete_exr(folder.file("out/0002.exr")));
    EXPECT_NE(read_bytes(folder.file("out/0002.exr")), second);
    EXPECT_TRUE(is_complete_exr(folder.file("out/0003.exr")));
    const auto stats = nlohmann::json::parse(read_bytes(folder.file("s.json")));
    EXPECT_EQ(stats["frames"][0]["skipped"], true);
    EXPECT_EQ(stats["frames"][1]["reason"], "damaged");
    EXPECT_EQ(stats["frames"][2]["reason"], "new");
}

TEST_F(RenderCommand, VerifyRendersAgainWhatAnotherSceneMade)
{
    ASSERT_EQ(render({"--frames", "1-2"}).exit_code, 0);
    const std::string first = read_bytes(folder.file("out/0001.exr"));
    ASSERT_EQ(render({"--frames", "2", "--samples", "3"}).exit_code, 0);
    ASSERT_EQ(render({"--frames", "3", "--resolution", "8x8"}).exit_code, 0);

    const Finished run = render({"--existing", "verify", "--stats", "s.json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto frames = nlohmann::json::parse(read_bytes(folder.file("s.json")))["frames"];
    EXPECT_EQ(frames[0]["reason"], "complete, same scene and inputs");
    EXPECT_EQ(frames[1]["reason"], "other scene");
    EXPECT_EQ(frames[2]["reason"], "other size");
    EXPECT_EQ(read_bytes(folder.file("out/0001.exr")), first);
    EXPECT_EQ(read_exr_header(folder.file("out/0003.exr")).width, 40);
}

TEST_F(RenderCommand, VerifyRendersAgainWhenAnInputFileChanged)
{
    const std::string cache = folder.write("points.csv", "x,y,z\n0,0,0\n0.2,0,0\n");
    folder.write("scene.toml", puff_scene + R"(
[[particles]]
name = "points"
file = "points.csv"
[[volumes]]
name = "sparks"
particles = "points"
)");
    const auto reason = [&] {
        const Finished run = render({"--frames", "1", "--existing", "verify", "--stats", "s.json"});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return nlohmann::json::parse(read_bytes(folder.file("s.json")))["frames"][0]["reason"];
    };
    const std::string kept = "complete, same scene and inputs";
    EXPECT_EQ(reason(), "new");
    EXPECT_EQ(reason(), kept);
    std::filesystem::last_write_time(
        cache, std::filesystem::last_write_time(cache) + std::chrono::seconds(2));
    EXPECT_EQ(reason(), "input files changed");
    EXPECT_EQ(reason(), kept);
    // The same files from another folder.
    const TemporaryFolder other;
    const Finished elsewhere =
        run_mote(other.path(), {"render", folder.file("scene.toml"), "--frames", "1", "--existing",
                                "verify", "--output", folder.file("out/####.exr"), "--dry-run"});
    EXPECT_TRUE(contains(elsewhere.out, kept)) << elsewhere.out << elsewhere.err;
}

TEST_F(RenderCommand, AKeptFrameStillGetsItsPreview)
{
    ASSERT_EQ(render({"--frames", "1"}).exit_code, 0);
    ASSERT_EQ(render({"--frames", "1", "--existing", "skip", "--preview", "p.png"}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder.file("p.png")));
    mark("p.png");
    ASSERT_EQ(render({"--frames", "1", "--existing", "skip", "--preview", "p.png"}).exit_code, 0);
    EXPECT_TRUE(is_marked("p.png"));
}

TEST_F(RenderCommand, DryRunListsAndWritesNothing)
{
    ASSERT_EQ(render({"--frames", "2"}).exit_code, 0);
    const Names before = files_below(folder.path());
    const Finished run = render({"--dry-run", "--existing", "skip", "--preview", "p/####.png"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(files_below(folder.path()), before);
    EXPECT_TRUE(contains(run.out, "out/0003.exr + p/0003.png")) << run.out;
    EXPECT_TRUE(contains(run.out, "2 of 3 frames to render: 1,3")) << run.out;
    EXPECT_TRUE(contains(run.out, "memory at frame 1")) << run.out;
}

TEST_F(RenderCommand, PixelsDoNotDependOnThreadsOrOnEarlierFrames)
{
    ASSERT_EQ(render({"--threads", "1"}).exit_code, 0);
    const std::string reference = read_bytes(folder.file("out/0003.exr"));
    ASSERT_FALSE(reference.empty());
    for (const char* threads : {"2", "3", "8"}) {
        ASSERT_EQ(render({"--frames", "3", "--threads", threads, "--output", "o.exr"}).exit_code,
                  0);
        EXPECT_EQ(read_bytes(folder.file("o.exr")), reference) << threads << " threads";
    }
    ASSERT_EQ(render({"--frames", "3", "--seed", "1", "--output", "o.exr"}).exit_code, 0);
    EXPECT_NE(read_bytes(folder.file("o.exr")), reference);
}

/// A warmed-up frame is the frame that a run of the frames before it would have made.
TEST_F(RenderCommand, WarmUpGivesTheFirstFrameItsHistory)
{
    const Names restir = {"--set",     "render.estimator=restir",
                          "--set",     "render.restir.reuse=temporal",
                          "--set",     "render.restir.control_variate=false",
                          "--samples", "1"};
    const auto render_to = [&](const std::string& pattern, Names arguments) {
        arguments.insert(arguments.end(), {"--output", pattern});
        arguments.insert(arguments.end(), restir.begin(), restir.end());
        const Finished run = render(arguments);
        ASSERT_EQ(run.exit_code, 0) << run.err;
    };
    render_to("all.####.exr", {});
    render_to("cold.exr", {"--frames", "3"});
    render_to("one.exr", {"--frames", "3", "--warmup", "1"});
    render_to("many.exr", {"--frames", "3", "--warmup", "99"});
    const auto bytes = [&](const char* name) { return read_bytes(folder.file(name)); };
    EXPECT_EQ(bytes("many.exr"), bytes("all.0003.exr"));
    EXPECT_NE(bytes("cold.exr"), bytes("many.exr"));
    EXPECT_NE(bytes("one.exr"), bytes("cold.exr"));
    EXPECT_EQ(files_below(folder.path()), (Names{"all.0001.exr", "all.0002.exr", "all.0003.exr",
                                                 "cold.exr", "many.exr", "one.exr", "scene.toml"}));
    EXPECT_NE(render({"--warmup", "-1"}).exit_code, 0);
}

TEST_F(RenderCommand, OnlyReproducibleFilesLeaveTheTimesOut)
{
    ASSERT_EQ(render({"--frames", "1"}).exit_code, 0);
    EXPECT_EQ(read_exr_header(folder.file("out/0001.exr")).find_attribute("capDate"), nullptr);
    ASSERT_EQ(run_mote(folder.path(), {"render", "scene.toml", "--frames", "1"}).exit_code, 0);
    const LayeredImage header = read_exr_header(folder.file("out/0001.exr"));
    EXPECT_NE(header.find_attribute("capDate"), nullptr);
    EXPECT_NE(header.find_attribute("mote:renderTime"), nullptr);
}

TEST_F(RenderCommand, JsonProgressIsOneObjectPerLine)
{
    const Finished run = render({"--progress", "json", "-vv"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::istringstream lines(run.err);
    Names events;
    for (std::string line; std::getline(lines, line);) {
        const auto object = nlohmann::json::parse(line);
        if (object["event"] == "log") continue;
        events.push_back(object["event"]);
        EXPECT_TRUE(object.contains("frame") && object.contains("fraction") &&
                    object.contains("eta_s"));
    }
    EXPECT_EQ(std::count(events.begin(), events.end(), "frame"), 3);
    EXPECT_EQ(events.back(), "done");

    const Finished failed = run_mote(folder.path(), {"render", "none.toml", "--progress", "json"});
    EXPECT_EQ(failed.exit_code, 3);
    EXPECT_EQ(nlohmann::json::parse(failed.err)["event"], "error");
}

TEST_F(RenderCommand, QuietSaysNothing)
{
    const Finished run = render({"-q"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(run.out, "");
}

TEST_F(RenderCommand, TheLogFileGetsEveryFrame)
{
    ASSERT_EQ(render({"-q", "--log-file", "mote.log"}).exit_code, 0);
    EXPECT_TRUE(contains(read_bytes(folder.file("mote.log")), "out/0003.exr written"));
}

TEST(ImageMetadata, BroadcastRatesAreExactFractions)
{
    const auto same = [](double fps, int numerator, unsigned denominator) {
        const Attribute::Rational rate = frame_rate(fps);
        return rate.numerator == numerator && rate.denominator == denominator;
    };
    EXPECT_TRUE(same(24.0, 24, 1));
    EXPECT_TRUE(same(23.976, 24000, 1001));
    EXPECT_TRUE(same(29.97, 30000, 1001));
    EXPECT_TRUE(same(59.94, 60000, 1001));
    EXPECT_TRUE(same(12.5, 12500, 1000));
}

}  // namespace mote
