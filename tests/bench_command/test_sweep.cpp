#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/bench_options.h"
#include "app/command_line.h"
#include "app/commands.h"
#include "bench/sweep_report.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {

namespace {

using Sweeps = std::vector<SweepKind>;

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

SweepResult sweep_of(SweepKind kind, double seconds)
{
    SweepParams params;
    params.seconds = seconds;
    params.most_threads = 2;
    return run_sweep(kind, std::nullopt, params, {});
}

/// What a method counted per pixel at one size.
double count_of(const SweepPoint& point, size_t row, double WorkCounts::*value)
{
    return point.rows[row].work.*value / (double(point.width) * point.height);
}

/// A sweep whose times follow x to a power.
SweepResult made_up(double power)
{
    SweepResult sweep;
    sweep.kind = SweepKind::Lights;
    sweep.scene = "built-in";
    for (const double x : {1.0, 10.0, 100.0}) {
        SweepPoint point;
        point.x = x;
        point.width = point.height = 10;
        point.rows = {{"path", 0.0, 0.01 * std::pow(x, power), 0.02, {}}};
        sweep.points.push_back(point);
    }
    sweep.left_out = {1000.0};
    return sweep;
}

}  // namespace

TEST(Sweep, AreChosenByName)
{
    EXPECT_EQ(choose_sweeps("lights,threads,lights"),
              (Sweeps{SweepKind::Lights, SweepKind::Threads}));
    EXPECT_EQ(choose_sweeps("all").size(), sweep_table().size());
    expect_error([] { (void)choose_sweeps("light"); }, ExitCode::Usage,
                 {"no sweep \"light\"", "did you mean \"lights\""});
    for (const SweepInfo& info : sweep_table()) EXPECT_EQ(&sweep_info(info.kind), &info);
}

TEST(Sweep, SizesGrow)
{
    for (const SweepInfo& info : sweep_table()) {
        const std::vector<SweepSize> sizes = sweep_sizes(info.kind, 6, std::nullopt);
        ASSERT_GE(sizes.size(), 4u) << info.name;
        for (size_t i = 1; i < sizes.size(); ++i) {
            EXPECT_GT(sizes[i].x, sizes[i - 1].x) << info.name;
            EXPECT_GE(sizes[i].threads, sizes[i - 1].threads) << info.name;
        }
    }
    EXPECT_EQ(sweep_sizes(SweepKind::Threads, 6, std::nullopt).back().threads, 6);
    EXPECT_EQ(sweep_sizes(SweepKind::Threads, 1, std::nullopt).size(), 1u);
    SceneDescription own;
    own.render.width = 77;
    EXPECT_EQ(sweep_sizes(SweepKind::Empty, 2, own).back().scene.render.width, 77);
}

TEST(Sweep, WorkFollowsTheSmokeInView)
{
    // The view widens about its middle: margins bring no work, so that cells follow the share.
    const SweepResult sweep = sweep_of(SweepKind::Empty, 1e6);
    ASSERT_TRUE(sweep.left_out.empty());
    const double all = count_of(sweep.points.back(), 1, &WorkCounts::cells);
    EXPECT_GT(all, 10.0);
    for (const SweepPoint& point : sweep.points) {
        const double cells = count_of(point, 1, &WorkCounts::cells);
        EXPECT_NEAR(cells / all / point.x, 1.0, 0.25) << point.x;
    }
}

TEST(Sweep, WorkPerSampleDoesNotFollowTheNumberOfLamps)
{
    const std::vector<SweepSize> sizes = sweep_sizes(SweepKind::Lights, 1, std::nullopt);
    const std::vector<Method> methods = choose_methods("restir-off", {});
    const SweepPoint one = measure_size(sizes[0], methods, nullptr);
    const SweepPoint thousand = measure_size(sizes[3], methods, nullptr);
    EXPECT_EQ(thousand.x, 1000.0);
    for (const auto value : {&WorkCounts::cells, &WorkCounts::shadow_rays}) {
        EXPECT_GT(count_of(one, 0, value), 0.0);
        EXPECT_LT(count_of(thousand, 0, value), 1.3 * count_of(one, 0, value));
    }
}

TEST(Sweep, SizesThatDoNotFitAreLeftOut)
{
    const SweepResult sweep = sweep_of(SweepKind::Particles, 0.01);
    ASSERT_GE(sweep.points.size(), 1u);
    EXPECT_EQ(sweep.points.size() + sweep.left_out.size(), 5u);
    EXPECT_FALSE(sweep.left_out.empty());
}

TEST(Sweep, SlopeIsThePowerAndReportsShowIt)
{
    const SweepResult sweep = made_up(0.5);
    EXPECT_NEAR(sweep_slope(sweep, 0), 0.5, 1e-12);
    const std::string text = sweep_text(sweep);
    EXPECT_TRUE(contains(text, "path: render time as the 0.50th power")) << text;
    EXPECT_TRUE(contains(text, "1000 left out")) << text;
    EXPECT_TRUE(contains(sweep_plot(sweep), ">path<"));
    const std::string html = sweeps_html({sweep});
    EXPECT_TRUE(contains(html, "<svg"));
    EXPECT_FALSE(contains(html, "src="));
    EXPECT_TRUE(contains(sweeps_csv({sweep}), "lights,100,10,10,0,path,0,0.1,0.02,0,0"));
    const nlohmann::json json = nlohmann::json::parse(sweeps_json({sweep}));
    EXPECT_EQ(json.at("sweeps").at(0).at("points").size(), 3u);
}

TEST(SweepCommand, WritesItsFilesAndRefusesWhatMakesNoSense)
{
    const TemporaryFolder folder;
    const auto run = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "bench");
        testing::internal::CaptureStdout();
        try {
            run_bench(std::get<BenchOptions>(parse_command_line(arguments)));
        } catch (...) {
            (void)testing::internal::GetCapturedStdout();
            throw;
        }
        std::fflush(stdout);
        return testing::internal::GetCapturedStdout();
    };
    const std::string text = run({"--sweep", "lights", "--max-seconds", "0.1", "--methods", "path",
                                  "--svg", folder.file("plots"), "--json", folder.file("a.json")});
    EXPECT_TRUE(contains(text, "sweep lights")) << text;
    EXPECT_TRUE(contains(read_bytes(folder.file("plots/sweep-lights.svg")), "xmlns"));
    EXPECT_TRUE(contains(read_bytes(folder.file("a.json")), "mote sweep 1"));
    const std::string scene = folder.write("a.toml", "[[volumes]]\nprocedural = \"puff\"\n");
    expect_error(
        [&] {
            (void)run({scene, "--sweep", "lights"});
        },
        ExitCode::Usage, {"--sweep lights has a scene of its own"});
    expect_error(
        [&] {
            (void)run({scene, scene, "--sweep", "empty"});
        },
        ExitCode::Usage, {"one scene"});
    expect_error([&] { (void)run({"--sweep", "nothing"}); }, ExitCode::Usage, {"no sweep"});
}

}  // namespace mote
