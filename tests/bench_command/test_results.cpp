#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/report.h"
#include "bench/result_changes.h"
#include "core/rng.h"
#include "support/expect_error.h"

namespace mote {

namespace {

/// A report of one row whose runs scatter by `noise` (relative, half width) around these figures.
BenchReport report_of(double mse, double cpu_us, int samples, double noise, uint32_t seed)
{
    MethodResult row;
    row.name = "path";
    row.is_reference = true;
    row.samples = samples;
    Rng rng(seed, 0, Stream::Test, 0, 0);
    const auto factor = [&] { return 1.0 + noise * (2.0 * double{rng.uniform()} - 1.0); };
    for (int k = 0; k < 8; ++k) {
        RunFigures run;
        run.error.mse = mse * factor();
        run.cpu_us = cpu_us * factor();
        row.runs.push_back(run);
    }
    row.figures.ratio = std::numeric_limits<double>::quiet_NaN();
    SceneResult scene;
    scene.path = "a \"b\".toml";
    scene.hash = 0xfedcba9876543210u;
    scene.width = 4;
    scene.height = 3;
    scene.modes.push_back({BenchMode::Static, {row}});
    return {"1.0", "any", 1, {scene}};
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST(BenchResults, SurviveTheFile)
{
    const BenchReport report = report_of(0.1, 2.0, 3, 0.1, 1);
    const std::string text = bench_json(report);
    const BenchReport read = parse_bench_json(text, "a.json");
    ASSERT_EQ(read.scenes.size(), 1u);
    const SceneResult& scene = read.scenes.front();
    EXPECT_EQ(scene.path, report.scenes.front().path);
    EXPECT_EQ(scene.hash, report.scenes.front().hash);
    ASSERT_EQ(scene.modes.size(), 1u);
    EXPECT_EQ(scene.modes.front().mode, BenchMode::Static);
    const MethodResult& row = scene.modes.front().rows.front();
    EXPECT_EQ(row.samples, 3);
    ASSERT_EQ(row.runs.size(), 8u);
    const RunFigures& first = report.scenes.front().modes.front().rows.front().runs.front();
    EXPECT_DOUBLE_EQ(row.runs.front().error.mse, first.error.mse);
    EXPECT_TRUE(
        nlohmann::json::parse(text)["scenes"][0]["modes"][0]["methods"][0]["figures"]["ratio"]
            .is_null());
}

TEST(BenchResults, OtherFilesAreRefused)
{
    for (const char* text : {"", "{", "[]", "{}", R"({"format": 3})", R"({"format": "other"})",
                             R"({"format": "mote bench 1", "version": "", "build": "",)"
                             R"( "threads": 1, "scenes": [{}]})"}) {
        expect_error([&] { (void)parse_bench_json(text, "a.json"); }, ExitCode::Input, {"a.json"});
    }
    std::string text = bench_json(report_of(0.1, 2.0, 3, 0.1, 1));
    text.replace(text.find("fedcba"), 6, "xxxxxx");
    expect_error([&] { (void)parse_bench_json(text, "a.json"); }, ExitCode::Input, {"a.json"});
}

TEST(BenchResults, TableAndCsvShowEveryRow)
{
    const BenchReport report = report_of(0.1, 2.0, 3, 0.1, 1);
    const std::string csv = bench_csv(report);
    EXPECT_TRUE(contains(csv, "\"a \"\"b\"\".toml\",static,path,4,3,")) << csv;
    const std::string table = bench_table(report.scenes.front());
    EXPECT_TRUE(contains(table, "static, 8 runs")) << table;
    EXPECT_FALSE(contains(table, "nan")) << table;
}

TEST(BenchResults, TheSameFileDiffersInNothing)
{
    const BenchReport report = report_of(0.1, 2.0, 3, 0.1, 1);
    const std::vector<RowChange> changes = find_changes(report, report);
    ASSERT_EQ(changes.size(), 1u);
    for (const Change* c : {&changes[0].mse, &changes[0].cpu, &changes[0].efficiency}) {
        EXPECT_DOUBLE_EQ(c->ratio, 1.0);
        EXPECT_FALSE(c->exceeds_noise);
    }
}

TEST(BenchResults, OtherSamplesAreNoChange)
{
    // Twice the samples: half the error in twice the time.
    const std::vector<RowChange> changes =
        find_changes(report_of(0.1, 2.0, 3, 0.0, 1), report_of(0.05, 4.0, 6, 0.0, 1));
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_NEAR(changes[0].mse.ratio, 1.0, 1e-9);
    EXPECT_NEAR(changes[0].cpu.ratio, 1.0, 1e-9);
    EXPECT_FALSE(changes[0].efficiency.exceeds_noise);
}

TEST(BenchResultsStat, ARealChangeIsTakenOutOfTheNoise)
{
    // Noise of +-10 %, so 6 % standard deviation: over 8 pairs the mean's standard error is 3 %.
    // A third more error is ten of these; equal files are marked for 1 % of seeds.
    const BenchReport before = report_of(0.1, 2.0, 3, 0.1, 1);
    const std::vector<RowChange> worse = find_changes(before, report_of(0.133, 2.0, 3, 0.1, 2));
    ASSERT_EQ(worse.size(), 1u);
    EXPECT_TRUE(worse[0].mse.exceeds_noise);
    EXPECT_TRUE(worse[0].mse.range.contains(1.33)) << worse[0].mse.ratio;
    EXPECT_FALSE(worse[0].cpu.exceeds_noise);
    const std::vector<RowChange> same = find_changes(before, report_of(0.1, 2.0, 3, 0.1, 3));
    for (const Change* c : {&same[0].mse, &same[0].cpu, &same[0].efficiency}) {
        EXPECT_FALSE(c->exceeds_noise) << c->p;
    }
    EXPECT_TRUE(contains(changes_table(worse), "*"));
}

TEST(BenchResults, OnlyRowsOfBothFilesAreCompared)
{
    const BenchReport a = report_of(0.1, 2.0, 3, 0.1, 1);
    BenchReport b = a;
    b.scenes.front().width = 8;
    EXPECT_TRUE(find_changes(a, b).empty());
    b = a;
    b.scenes.front().modes.front().mode = BenchMode::Still;
    EXPECT_TRUE(find_changes(a, b).empty());
}

}  // namespace mote
