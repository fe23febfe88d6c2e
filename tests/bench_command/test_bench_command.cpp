#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/bench_options.h"
#include "app/command_line.h"
#include "app/commands.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {

namespace {

using Names = std::vector<std::string>;

const char* const lamp_scene = R"(
[render]
bounces = 1

[[volumes]]
procedural = { type = "puff", voxel_size = 0.1 }
density_scale = 8

[[lights]]
type = "distant"
direction = [0, 1, 0]
)";

BenchOptions parse(Names arguments)
{
    arguments.insert(arguments.begin(), "bench");
    return std::get<BenchOptions>(parse_command_line(arguments));
}

/// What goes to stdout.
std::string bench(const Names& arguments)
{
    testing::internal::CaptureStdout();
    try {
        run_bench(parse(arguments));
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

}  // namespace

TEST(BenchCommand, QuickGivesWayToWhatIsSaid)
{
    const BenchParams quick = bench_params(parse({"a.toml", "--quick"}));
    EXPECT_EQ(quick.runs, 4);
    EXPECT_EQ(quick.frames.warm_up, 4);
    EXPECT_GT(quick.time_budget, 0.0);
    const BenchParams said = bench_params(
        parse({"a.toml", "--quick", "--runs", "3", "--frames", "0+2", "--time-budget", "5"}));
    EXPECT_EQ(said.runs, 3);
    EXPECT_EQ(said.frames.warm_up, 0);
    EXPECT_EQ(said.frames.still, 2);
    EXPECT_EQ(said.time_budget, 5.0);
    EXPECT_EQ(bench_params(parse({"a.toml"})).runs, 8);
}

TEST(BenchCommand, WrongOptionsAreRefusedBeforeAnythingRuns)
{
    const TemporaryFolder folder;
    const std::string scene = folder.write("a.toml", lamp_scene);
    for (const char* frames : {"8", "8+0", "-1+2", "1+2x", "8+99999"}) {
        expect_error(
            [&] {
                (void)bench({scene, "--frames=" + std::string(frames)});
            },
            ExitCode::Usage, {"--frames", "8+8"});
    }
    expect_error(
        [&] {
            (void)bench({scene, "--methods", "nothing"});
        },
        ExitCode::Usage, {"no method \"nothing\""});
    expect_error(
        [&] {
            (void)bench({scene, "--reference", "nothing"});
        },
        ExitCode::Usage, {"no method"});
    expect_error([&] { (void)bench({scene, "--modes", "nothing"}); }, ExitCode::Usage, {"no mode"});
    expect_error(
        [&] {
            (void)bench({scene, scene, "--against", "b.json"});
        },
        ExitCode::Usage, {"--against"});
    expect_error(
        [&] {
            (void)bench({folder.file("none.json"), "--against", "none.json"});
        },
        ExitCode::Input, {"none.json"});
    expect_error([&] { (void)bench({folder.file("none.toml")}); }, ExitCode::Input, {"none.toml"});
    EXPECT_THROW((void)bench({}), Error);
    EXPECT_THROW((void)parse({scene, "--runs", "1"}), Error);
    EXPECT_THROW((void)parse({scene, "--resolution", "3"}), Error);
}

TEST(BenchCommand, ABlackPictureCannotBeMeasured)
{
    const TemporaryFolder folder;
    const std::string scene = folder.write("dark.toml", "[[volumes]]\nprocedural = \"puff\"\n");
    const Names arguments{scene, "--resolution", "8x8", "--time-budget", "0.2"};
    expect_error([&] { (void)bench(arguments); }, ExitCode::Input, {"black"});
}

TEST(BenchCommand, ListsItsMethods)
{
    const std::string list = bench({"--list"});
    EXPECT_TRUE(contains(list, "path-tree-equi-exact")) << list;
}

TEST(BenchCommand, QuickMeasuresWritesAndCompares)
{
    const TemporaryFolder folder;
    const std::string scene = folder.write("a.toml", lamp_scene);
    const std::string json = folder.file("a.json");
    const std::string csv = folder.file("a.csv");
    const std::string table = bench({scene, "--quick", "--resolution", "32x18", "--runs", "2",
                                     "--time-budget", "0.5", "--json", json, "--csv", csv, "--html",
                                     folder.file("a.html"), "--svg", folder.file("plots")});
    EXPECT_TRUE(contains(table, "32 x 18 pixels, frame 5")) << table;
    EXPECT_TRUE(contains(table, "path-exact")) << table;

    std::ifstream in(json);
    const nlohmann::json results = nlohmann::json::parse(in);
    const auto& measured = results.at("scenes").at(0);
    EXPECT_EQ(measured.at("width"), 32);
    EXPECT_EQ(measured.at("modes").size(), 2u);
    EXPECT_GT(measured.at("reference").at("mean"), 0.0);
    for (const auto& mode : measured.at("modes")) {
        const bool is_still = mode.at("mode") == "still";
        double best = 0.0;
        for (const auto& row : mode.at("methods")) {
            EXPECT_EQ(row.at("runs").size(), 2u);
            EXPECT_EQ(row.at("non_finite"), 0);
            EXPECT_GT(row.at("figures").at("cpu_us"), 0.0);
            const bool has_noise = row.at("name") != "march";
            EXPECT_EQ(row.at("figures").at("n_var") > 0.0, has_noise);
            EXPECT_EQ(row.at("curve").size(), is_still ? 2u : 0u);  // 1 and 4 times the samples
            EXPECT_EQ(row.at("memory_bytes").at("film"), 32 * 18 * 4 * 4);
            const auto& work = row.at("work");  // the preview, too, walks its camera rays
            EXPECT_GT(work.at("lookups").get<double>() + work.at("cells").get<double>(), 0.0);
            const auto& ratio = row.at("figures").at("ratio");
            const bool judges = row.at("is_reference").get<bool>();
            if (judges && ratio.is_number()) best = std::max(best, ratio.get<double>());
        }
        EXPECT_DOUBLE_EQ(best, 1.0);
    }
    EXPECT_TRUE(contains(read_bytes(csv), "still,path-exact,32,18,5,"));

    const std::string html = read_bytes(folder.file("a.html"));
    EXPECT_TRUE(contains(html, "<svg"));
    EXPECT_TRUE(contains(html, "us to 1%"));
    EXPECT_FALSE(contains(html, "src="));
    EXPECT_FALSE(contains(html, "href="));
    EXPECT_TRUE(contains(read_bytes(folder.file("plots/a-still.svg")), "path-exact"));
    EXPECT_TRUE(contains(read_bytes(folder.file("plots/a-static.svg")), "xmlns"));

    const std::string changes = bench({json, "--against", json});
    EXPECT_TRUE(contains(changes, "path-exact")) << changes;
    EXPECT_FALSE(contains(changes, "] *")) << changes;
}

TEST(BenchCommand, TheSameSeedsGiveTheSameErrors)
{
    const TemporaryFolder folder;
    const std::string scene = folder.write("a.toml", lamp_scene);
    const auto errors = [&](const std::string& threads) {
        (void)bench({scene, "--resolution", "24x20", "--runs", "2", "--samples", "2", "--frames",
                     "1+2", "--methods", "path", "--reference", "path-exact", "--reference-time",
                     "1e-6", "--threads", threads, "--json", folder.file("a.json")});
        std::ifstream in(folder.file("a.json"));
        const nlohmann::json results = nlohmann::json::parse(in);
        std::vector<double> values;
        for (const auto& mode : results.at("scenes").at(0).at("modes")) {
            for (const auto& run : mode.at("methods").at(0).at("runs")) {
                values.push_back(run.at("mse"));
            }
        }
        return values;
    };
    EXPECT_EQ(errors("1"), errors("2"));
}

}  // namespace mote
