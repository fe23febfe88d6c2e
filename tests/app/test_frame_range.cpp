#include <gtest/gtest.h>

#include "app/frame_range.h"
#include "core/error.h"

namespace mote {

namespace {

using Frames = std::vector<int>;

std::string refusal(const std::string& text)
{
    try {
        (void)parse_frames(text);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Usage);
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST(FrameRange, ReadsEveryForm)
{
    EXPECT_EQ(parse_frames("7"), (Frames{7}));
    EXPECT_EQ(parse_frames("1-4"), (Frames{1, 2, 3, 4}));
    EXPECT_EQ(parse_frames("1-10x3"), (Frames{1, 4, 7, 10}));
    EXPECT_EQ(parse_frames("1-9x3"), (Frames{1, 4, 7}));
    EXPECT_EQ(parse_frames("1,3 5-6,, 9"), (Frames{1, 3, 5, 6, 9}));
    EXPECT_EQ(parse_frames("1001-1003"), (Frames{1001, 1002, 1003}));
}

TEST(FrameRange, ReadsNegativeFrames)
{
    EXPECT_EQ(parse_frames("-3"), (Frames{-3}));
    EXPECT_EQ(parse_frames("-3-1"), (Frames{-3, -2, -1, 0, 1}));
    EXPECT_EQ(parse_frames("-8--5"), (Frames{-8, -7, -6, -5}));
    EXPECT_EQ(parse_frames("-8--5x2"), (Frames{-8, -6}));
}

TEST(FrameRange, KeepsTheOrderAndDropsRepeats)
{
    EXPECT_EQ(parse_frames("5,1-3,2,5"), (Frames{5, 1, 2, 3}));
    EXPECT_EQ(parse_frames("3-1"), (Frames{3, 2, 1}));
    EXPECT_EQ(parse_frames("9-1x4"), (Frames{9, 5, 1}));
}

TEST(FrameRange, RefusesWithTheReason)
{
    EXPECT_NE(refusal("1-10y2").find("stagger"), std::string::npos);
    EXPECT_NE(refusal("1-10:3").find("stagger"), std::string::npos);
    EXPECT_NE(refusal("1-10x0").find("step"), std::string::npos);
    EXPECT_NE(refusal("1-10x-2").find("step"), std::string::npos);
    EXPECT_NE(refusal("").find("empty"), std::string::npos);
    EXPECT_NE(refusal("1-").find("missing"), std::string::npos);
    EXPECT_NE(refusal("1-3,a").find("\"a\""), std::string::npos);
    EXPECT_NE(refusal("1.5").find("unexpected"), std::string::npos);
    EXPECT_NE(refusal("0-99999999").find("more than 1000000"), std::string::npos);
    EXPECT_NE(refusal("1-99999999999999999999").find("go up to"), std::string::npos);
    EXPECT_NE(refusal("-9223372036854775808").find("go up to"), std::string::npos);
    EXPECT_EQ(parse_frames("0-99999999x1000").size(), 100000u);
}

TEST(FrameRange, FormatsTheInverse)
{
    EXPECT_EQ(format_frames({1, 2, 3, 7}), "1-3,7");
    EXPECT_EQ(format_frames({-2, -1, 0, 5, 6}), "-2-0,5,6");
    for (const char* text : {"1-3,7", "-8--5", "4", "9,1-3"}) {
        EXPECT_EQ(format_frames(parse_frames(text)), text);
    }
}

}  // namespace mote
