#include <gtest/gtest.h>

#include "app/output_pattern.h"
#include "core/error.h"

namespace mote {

TEST(OutputPattern, EveryTokenGivesTheSameFourDigits)
{
    for (const char* pattern :
         {"o/a.####.exr", "o/a.%04d.exr", "o/a.$F4.exr", "o/a.{frame:04}.exr", "o/a.@@@@.exr"}) {
        EXPECT_EQ(expand_pattern(pattern, 7), "o/a.0007.exr") << pattern;
        EXPECT_EQ(expand_pattern(pattern, 123456), "o/a.123456.exr") << pattern;
        EXPECT_EQ(expand_pattern(pattern, -3), "o/a.-003.exr") << pattern;
        EXPECT_TRUE(has_frame_token(pattern)) << pattern;
    }
}

TEST(OutputPattern, UnpaddedTokens)
{
    for (const char* pattern : {"a#.exr", "a@.exr", "a%d.exr", "a$F.exr", "a{frame}.exr"}) {
        EXPECT_EQ(expand_pattern(pattern, 12), "a12.exr") << pattern;
        EXPECT_EQ(expand_pattern(pattern, -12), "a-12.exr") << pattern;
    }
}

TEST(OutputPattern, OneKindIsInForceAndMayRepeat)
{
    EXPECT_EQ(expand_pattern("####/me@home.####.exr", 5), "0005/me@home.0005.exr");
    EXPECT_EQ(expand_pattern("100%/$F2/#1.exr", 5), "100%/05/#1.exr");
    EXPECT_EQ(expand_pattern("plain.exr", 5), "plain.exr");
    EXPECT_FALSE(has_frame_token("plain 100%.exr"));
}

TEST(OutputPattern, RefusesMalformedTokens)
{
    EXPECT_THROW((void)expand_pattern("a.{frame:x}.exr", 1), Error);
    EXPECT_THROW((void)expand_pattern("a.{frame", 1), Error);
    EXPECT_THROW((void)expand_pattern("a.%4d.exr", 1), Error);
    EXPECT_THROW((void)expand_pattern("a.%099d.exr", 1), Error);
}

TEST(OutputPattern, SeveralFramesNeedATokenAndTheMessageNamesTheOption)
{
    EXPECT_EQ(expand_pattern("a.exr", std::vector<int>{9}, "--output"),
              (std::vector<std::string>{"a.exr"}));
    try {
        (void)expand_pattern("a.exr", std::vector<int>{1, 2}, "--output");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Usage);
        EXPECT_NE(std::string(error.what()).find("--output \"a.exr\""), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("####"), std::string::npos);
    }
}

}  // namespace mote
