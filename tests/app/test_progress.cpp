#include <algorithm>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/progress.h"

namespace mote {

namespace {

/// A terminal that keeps its text and whose clock is set by hand.
struct Recorder {
    std::string text;
    double time = 100.0;

    Progress::Terminal terminal()
    {
        return {[this](std::string_view t) { text += t; }, [this] { return time; }, 80};
    }
};

}  // namespace

TEST(Progress, Durations)
{
    EXPECT_EQ(format_duration(-1.0), "?");
    EXPECT_EQ(format_duration(4.4), "4 s");
    EXPECT_EQ(format_duration(123.0), "2:03");
    EXPECT_EQ(format_duration(3723.0), "1:02:03");
}

TEST(Progress, JsonLinesParseAndCarryTheEta)
{
    Recorder recorder;
    Progress progress(ProgressStyle::Json, 5, recorder.terminal());
    progress.skip_frame(1, "a \"quoted\" \xff name.exr");
    progress.begin_frame(2, 10);
    recorder.time += 5.0;
    for (int i = 0; i < 5; ++i) progress.step();
    progress.end_frame("b.exr");
    progress.begin_frame(3, progress.steps_of_last_frame());
    progress.finish(true);

    std::vector<nlohmann::json> lines;
    std::istringstream stream(recorder.text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(nlohmann::json::parse(line));
    ASSERT_EQ(lines.size(), 6u);  // skip begin progress frame begin stopped
    for (const auto& line : lines) {
        for (const char* key : {"event", "frame", "fraction", "eta_s"}) {
            EXPECT_TRUE(line.contains(key)) << line;
        }
    }
    EXPECT_EQ(lines[0]["event"], "skip");
    EXPECT_TRUE(lines[0]["eta_s"].is_null());
    EXPECT_EQ(lines[2]["event"], "progress");
    EXPECT_EQ(lines[3]["event"], "frame");
    EXPECT_EQ(lines[3]["frame"], 2);
    // Two of five frames are done, one of them skipped; the rendered one took 5 s, 3 are left.
    EXPECT_DOUBLE_EQ(lines[3]["fraction"], 0.4);
    EXPECT_NEAR(lines[3]["eta_s"], 15.0, 0.01);
    EXPECT_EQ(lines[5]["event"], "stopped");
}

TEST(Progress, LogLinesAreRareAndTheLastFrameIsShown)
{
    Recorder recorder;
    Progress progress(ProgressStyle::Lines, 100, recorder.terminal());
    for (int frame = 1; frame <= 100; ++frame) {
        progress.begin_frame(frame, 1);
        recorder.time += 0.5;
        progress.step();
        progress.end_frame("f.exr");
    }
    progress.finish(false);
    const auto lines = std::count(recorder.text.begin(), recorder.text.end(), '\n');
    EXPECT_GE(lines, 9);  // 50 s, one each 5 s
    EXPECT_LE(lines, 13);
    EXPECT_NE(recorder.text.find("(100/100) 100%"), std::string::npos);
    EXPECT_NE(recorder.text.find("100 of 100 frames done in 50 s"), std::string::npos);
}

TEST(Progress, TheBarStaysOnOneLineOfTheTerminal)
{
    Recorder recorder;
    auto terminal = recorder.terminal();
    for (const int columns : {20, 80, 300}) {
        recorder.text.clear();
        terminal.columns = columns;
        Progress progress(ProgressStyle::Bar, 2, terminal);
        progress.begin_frame(1, 1000);
        for (int i = 0; i < 1500; ++i) {  // more steps than announced
            recorder.time += 0.01;
            progress.step();
        }
        EXPECT_EQ(recorder.text.find('\n'), std::string::npos);
        std::istringstream redraws(recorder.text.substr(1));
        for (std::string line; std::getline(redraws, line, '\r');) {
            EXPECT_LT(line.size() - std::string("\x1b[K").size(), static_cast<size_t>(columns));
        }
        EXPECT_EQ(recorder.text.find("100%"), std::string::npos);
    }
}

TEST(Progress, QuietWritesNothing)
{
    Recorder recorder;
    Progress progress(ProgressStyle::None, 2, recorder.terminal());
    progress.begin_frame(1, 10);
    recorder.time += 100.0;
    progress.step();
    progress.end_frame("a.exr");
    progress.finish(false);
    EXPECT_EQ(recorder.text, "");
}

}  // namespace mote
